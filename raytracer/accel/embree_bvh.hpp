// Boxes as user geometry under a BVH of Embree's: what bvh.hpp does, by another hierarchy.
//
// Every box that the exact ray touches is found, and some more; which, and in what order, is Embree's affair
// and may differ from one processor to another.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "bounds/vec.hpp"

namespace deburr {

struct NumberedBox {
    std::uint32_t number;
    Box box;  // finite, not empty
};

class EmbreeBvh {
public:
    explicit EmbreeBvh(const std::vector<NumberedBox>& boxes);
    EmbreeBvh(EmbreeBvh&&) noexcept;
    EmbreeBvh& operator=(EmbreeBvh&&) noexcept;
    ~EmbreeBvh();

    enum class Order { nearest_first, any };
    /// Visits boxes as Bvh8::visit does. visit() returns the distance up to which the ray goes on; a negative
    /// one ends it.
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
