// The part of a solid that is left in a cell, and a ray's crossings of its surface there.
//
// A leaf whose local density is one half-space is a plane: it is intersected and done; a product of
// half-spaces needs no search either (convex_density.hpp), and a sum of few products little
// (product_sum.hpp). For the others the ray is first cut by inner and outer bound [Lobb §3.2,
// figure 7]; in a stretch where a single half-space varies the crossing is a plane's too, and only what
// remains needs the root finder. A field goes straight to it, unless it is a round part, or a product of convex ones
// (round_product.hpp).
#pragma once
#include <optional>
#include <variant>
#include <vector>

#include "bounds/convex_density.hpp"
#include "bounds/csg_bounds.hpp"
#include "bounds/local_density.hpp"
#include "bounds/product_sum.hpp"
#include "bounds/root_finder.hpp"
#include "bounds/round_product.hpp"
#include "bounds/solid_range.hpp"
#include "raytracer/trace/trace_settings.hpp"

namespace deburr {

/// Distances that floating point sets, for a scene whose coordinates reach `scale`.
struct Tolerances {
    double scale = 1;

    /// Bound planes keep clear by this, so that a density's sign on them can be relied upon.
    double clearance() const { return scale * 0x1p-40; }
    /// Stretches of a ray that are no longer than this count as nothing at its parameter t.
    double along(double t) const { return 8 * epsilon * (scale + std::abs(t)); }
    /// Cells know their solids this far beyond their walls.
    double margin() const { return scale * 0x1p-38; }
    /// The place of a round part's surface is rounded by this much more than a plane's.
    double of_round() const { return 4 * epsilon * scale; }
    /// A smaller filter lies between neighbouring points: α would jump, and overflow.
    double min_radius() const { return scale * 0x1p-44; }
};

struct SurfaceCrossing {
    double t = infinity;
    Vec3 normal{0.0};  // unit, out of the solid
    int material = 0;
    double error = 0;  // of its place, besides what coordinates are rounded by
};

struct CrossingCounters {
    RootCounters roots;
    std::uint64_t flat = 0;
};

/// Memory that rays use again and again, and their settings.
struct CrossingScratch {
    struct Event {
        double t;
        int leaf;
        bool entering;
        Vec3 normal;
        double error;
    };
    Criterion criterion = Criterion::exact;
    CrossingCounters counters;
    RayDensity density;
    ProductSumRay sum;
    FieldRay field;
    SearchSpans spans;
    std::vector<double> sharp;
    std::vector<Event> events;
    std::vector<char> inside, state;
    double error = 0;  // of the crossing that is being visited
};

class LocalSolid {
public:
    /// `tree` is a solid pruned to the box. Queries must stay inside the box.
    LocalSolid(int solid, const SolidTree& tree, const Box& box, const Tolerances& tolerances,
               RootMethod root_method = RootMethod::where_needed);

    int solid() const { return solid_; }
    /// False if no ray can cross a surface here.
    bool has_surface() const { return !nodes_.empty() && has_surface_; }
    bool is_flat() const { return leaves_.size() == 1 && leaves_[0].soft < 0; }
    std::size_t half_spaces() const;

    struct Convex {
        ConvexDensity density;
        int material;
    };
    /// The whole of it as one product, if it is one and of one material. Planes are sharp factors of
    /// it: what they were rounded by no longer matters. Empty after RootMethod::always, but for planes.
    std::optional<Convex> convex() const;

    /// The whole of it as a sum of products, or as a round part's surface, if it is one leaf's; else null.
    const ProductSum* sum() const { return is_one_soft() ? std::get_if<ProductSum>(&softs_[0].form) : nullptr; }
    const RoundSurface* surface() const { return is_one_soft() ? std::get_if<RoundSurface>(&softs_[0].form) : nullptr; }
    /// Tolerances of the BSP that it was made for.
    Tolerances tolerances() const { return {scale_}; }
    /// The first leaf's material, by its index in the scene.
    int material() const { return leaves_[0].material; }

    /// First crossing of the solid's surface in [t0, t1]; `any`: that there is one will do, t and normal
    /// mean nothing.
    SurfaceCrossing first_crossing(const Vec3& origin, const Vec3& direction, double t0, double t1, bool any,
                                   CrossingScratch& scratch) const;

private:
    struct Leaf {
        Vec3 normal{0.0};  // flat: inside where n·x ≤ offset
        double offset = 0;
        int soft = -1;  // index of its density or field; −1: flat
        int material = 0;
    };
    // A density of which no simpler form is known: its roots are searched between its bounds.
    struct SearchedDensity {
        LocalDensity density;
        BoundCsg outer, inner;
        bool bounded;  // the bounds hold
        bool all_sharp;
    };
    struct SearchedField {
        FieldPtr field;
        double max_noise_scale;  // upper bound of FieldRay::noise_scale over the rays here; 0: not known
    };
    // What is not flat, in the simplest form that it has here.
    using Form = std::variant<ConvexDensity, ProductSum, RoundSurface, RoundProduct, SearchedDensity, SearchedField>;
    struct Soft {
        Form form;
        std::size_t half_spaces;  // that it was made of
    };

    bool is_one_soft() const { return nodes_.size() == 1 && softs_.size() == 1 && leaves_[0].soft == 0; }
    void add_leaf(const SolidLeaf& leaf, const Box& box, const Tolerances& tolerances, RootMethod root_method,
                  std::optional<bool>& constant);
    static Form form_of_field(const FieldPtr& field, const Box& box, const Tolerances& tolerances,
                              RootMethod root_method);
    static Form form_of_density(LocalDensity density, const DensityTree& tree, const Box& box,
                                const Tolerances& tolerances, RootMethod root_method);
    /// The intersection of those leaves whose bit is set and of the others' complements.
    std::optional<ConvexDensity> intersection_of_leaves(unsigned positive) const;
    bool evaluate(std::vector<char>& state, const std::vector<char>& inside) const;
    SurfaceCrossing first_leaf_crossing(const Vec3& origin, const Vec3& direction, double t0, double t1, bool any,
                                        CrossingScratch& scratch) const;
    // Fills scratch.events with the crossings of all leaves, in order, and scratch.inside with what holds at t0.
    void find_events(const Vec3& origin, const Vec3& direction, double t0, double t1, CrossingScratch& scratch) const;
    // Of the events, the first that changes whether the ray is in the solid.
    SurfaceCrossing first_change(const Vec3& direction, CrossingScratch& scratch) const;
    // What follows calls visit(t, entering, normal or 0: not known yet) → go on?
    template <class Visit>
    void crossings_of(const SearchedField& searched, const Vec3& origin, const Vec3& direction, double t0, double t1,
                      CrossingScratch& scratch, bool* start_inside, Visit visit) const;
    template <class Visit>
    void crossings_of(const RoundSurface& surface, const Vec3& origin, const Vec3& direction, double t0, double t1,
                      CrossingScratch& scratch, bool* start_inside, Visit visit) const;
    template <class Visit>
    void crossings_of(const RoundProduct& product, const Vec3& origin, const Vec3& direction, double t0, double t1,
                      CrossingScratch& scratch, bool* start_inside, Visit visit) const;
    template <class Visit>
    void crossings_of(const ProductSum& sum, const Vec3& origin, const Vec3& direction, double t0, double t1,
                      CrossingScratch& scratch, bool* start_inside, Visit visit) const {
        sum_crossings(sum, origin, direction, t0, t1, false, scratch, start_inside, visit);
    }
    template <class Visit>
    void crossings_of(const ConvexDensity& convex, const Vec3& origin, const Vec3& direction, double t0, double t1,
                      CrossingScratch& scratch, bool* start_inside, Visit visit) const;
    template <class Visit>
    void crossings_of(const SearchedDensity& searched, const Vec3& origin, const Vec3& direction, double t0, double t1,
                      CrossingScratch& scratch, bool* start_inside, Visit visit) const;
    // `coarse`: t is after the crossing, and the normal 0.
    template <class Visit>
    void sum_crossings(const ProductSum& sum, const Vec3& origin, const Vec3& direction, double t0, double t1,
                       bool coarse, CrossingScratch& scratch, bool* start_inside, Visit visit) const;
    // Of a round surface or product, which it names `round`.
    template <class Round, class Crossings, class Visit>
    void visit_round(const Round& round, const Crossings& all, const Vec3& origin, const Vec3& direction,
                     CrossingScratch& scratch, bool* start_inside, Visit visit) const;
    template <class Visit>
    void soft_crossings(const Soft& soft, const Vec3& origin, const Vec3& direction, double t0, double t1,
                        CrossingScratch& scratch, bool* start_inside, Visit visit) const {
        std::visit(
            [&](const auto& form) { crossings_of(form, origin, direction, t0, t1, scratch, start_inside, visit); },
            soft.form);
    }

    int solid_;
    bool has_surface_ = true;
    std::vector<Leaf> leaves_;
    std::vector<Soft> softs_;
    std::vector<SolidTreeNode> nodes_;
    double scale_;
};

}  // namespace deburr
