// Boxes as user geometry in a BVH of Embree's: an alternative to Bvh8 (bvh.hpp), used as a cross-check.
//
// Every box that the exact ray touches is found, and a few more. Which ones, and in what order, depends on Embree and
// may differ between processors.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

/// A box and the number by which visits report it.
struct NumberedBox {
    std::uint32_t number;
    Box box;  // finite, not empty
};

/// A BVH over numbered boxes. Queries are thread-safe.
class EmbreeBvh {
public:
    /// Throws UnsupportedError if Embree cannot be loaded, WorkError if it does not start or runs out of memory.
    explicit EmbreeBvh(const std::vector<NumberedBox>& boxes);
    EmbreeBvh(EmbreeBvh&&) noexcept;
    EmbreeBvh& operator=(EmbreeBvh&&) noexcept;
    ~EmbreeBvh();

    /// The order of visits: roughly by distance, or any, for any-hit queries.
    enum class Order { nearest_first, any };
    /// Calls visit(number) for the boxes that the ray may meet in [t0, t1], as Bvh8::visit does. visit() returns the
    /// distance up to which the search goes on; a negative one ends it.
    template <class Visit>
    void visit(const Vec3& origin, const Vec3& direction, double t0, double t1, Order order, Visit visit) const {
        run(
            origin, direction, t0, t1, order, [](void* v, std::uint32_t i) { return (*static_cast<Visit*>(v))(i); },
            &visit);
    }

private:
    struct Embree;
    using Call = double (*)(void* visit, std::uint32_t number);
    void run(const Vec3& origin, const Vec3& direction, double t0, double t1, Order order, Call call,
             void* visit) const;

    std::unique_ptr<Embree> embree_;
};

}  // namespace deburr
