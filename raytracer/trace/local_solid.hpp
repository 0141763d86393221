// The part of a solid that is left in a cell (local CSG), and a ray's crossings of its surface there.
//
// A leaf whose local density is one half-space is intersected as a plane; a product of half-spaces needs no search
// either (convex_density.hpp), and a sum of few products needs little (product_sum.hpp). For other densities the ray is
// first clipped between the outer and inner bound [Lobb §3.2, figure 7]; where a single half-space varies the crossing
// is a plane's too, and only the rest needs the root finder. A field goes to the root finder at once, unless it is a
// round part or a product of convex ones (round_product.hpp).
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

/// Tolerances that follow from double precision, for a scene whose coordinates are at most `scale`. All are scene
/// lengths.
struct Tolerances {
    double scale = 1;

    /// Bound planes keep this far away from the density's level, so that its sign on them is reliable.
    double clearance() const { return scale * 0x1p-40; }
    /// Stretches of a ray at its parameter t that are no longer than this count as empty.
    double along(double t) const { return 8 * epsilon * (scale + std::abs(t)); }
    /// A cell's local solids are valid this far beyond its walls.
    double margin() const { return scale * 0x1p-38; }
    /// How much larger the error of a point on a round part's surface is than that of a point on a plane.
    double of_round() const { return 4 * epsilon * scale; }
    /// A filter radius below this lies between neighbouring points: α would jump, and overflow.
    double min_radius() const { return scale * 0x1p-44; }
};

/// A ray's crossing of a solid's surface.
struct SurfaceCrossing {
    double t = infinity;  // ray parameter; infinity: none
    Vec3 normal{0.0};     // unit, out of the solid
    int material = 0;     // index in the scene; −1: none
    double error = 0;     // of the position (a scene length), beyond the rounding of coordinates
};

/// Work done by queries of local solids.
struct CrossingCounters {
    RootCounters roots;
    std::uint64_t flat = 0;  // crossings that were computed as a plane's
};

/// Settings of a query, and memory that queries reuse; one per thread.
struct CrossingScratch {
    /// A crossing of one leaf's surface.
    struct Event {
        double t;
        int leaf;
        bool entering;
        Vec3 normal;   // unit, up to its sign
        double error;  // SurfaceCrossing::error
    };
    Criterion criterion = Criterion::exact;
    CrossingCounters counters;
    RayDensity density;
    ProductSumRay sum;
    FieldRay field;
    SearchSpans spans;
    std::vector<double> sharp;  // parameters at which sharp planes are crossed
    std::vector<Event> events;
    std::vector<char> inside, state;  // inside: of each leaf; state: of each CSG node
    double error = 0;                 // SurfaceCrossing::error of the crossing that is being visited
};

/// A solid's CSG restricted to a cell.
class LocalSolid {
public:
    /// `tree` is the solid, pruned to `box`; queries are valid inside `box` only. `solid` is its number in the BSP.
    /// Throws TooEntangled, with the leaf's line, if a leaf's diagram is too large.
    LocalSolid(int solid, const SolidTree& tree, const Box& box, const Tolerances& tolerances,
               RootMethod root_method = RootMethod::where_needed);

    int solid() const { return solid_; }
    /// False if no ray can cross a surface here.
    bool has_surface() const { return !nodes_.empty() && has_surface_; }
    /// Whether it is a single plane.
    bool is_flat() const { return leaves_.size() == 1 && leaves_[0].soft < 0; }
    /// Number of half-spaces (of a field: Field::size()) in all leaves.
    std::size_t half_spaces() const;

    /// A product of half-spaces, and the material of its surface.
    struct Convex {
        ConvexDensity density;
        int material;
    };
    /// The whole local solid as one product, if it is one and has one material. Planes become its sharp
    /// factors, even those of rounded half-spaces, whose filter no longer matters. Empty after RootMethod::always,
    /// except for planes.
    std::optional<Convex> convex() const;

    /// The whole local solid as a sum of products, or as the surface of a round part; null if it is not a single such
    /// leaf.
    const ProductSum* sum() const { return is_one_soft() ? std::get_if<ProductSum>(&softs_[0].form) : nullptr; }
    const RoundSurface* surface() const { return is_one_soft() ? std::get_if<RoundSurface>(&softs_[0].form) : nullptr; }
    /// The tolerances of the BSP that it was made for.
    Tolerances tolerances() const { return {scale_}; }
    /// The first leaf's material, as an index in the scene; −1: none.
    int material() const { return leaves_[0].material; }

    /// First crossing of the solid's surface in [t0, t1]; t is infinity if there is none. With `any`, t and the normal
    /// may be meaningless: only whether t is finite counts.
    SurfaceCrossing first_crossing(const Vec3& origin, const Vec3& direction, double t0, double t1, bool any,
                                   CrossingScratch& scratch) const;

private:
    // A leaf of the CSG: a plane, or a density or field in softs_.
    struct Leaf {
        Vec3 normal{0.0};  // of a flat leaf, which is inside where n·x ≤ offset
        double offset = 0;
        int soft = -1;  // index in softs_; −1: flat
        int material = 0;
    };
    // A density without a simpler form: its roots are searched for between its bounds.
    struct SearchedDensity {
        LocalDensity density;
        BoundCsg outer, inner;
        bool bounded;    // whether the bounds are valid here (bounds_hold)
        bool all_sharp;  // whether no half-space has a filter
    };
    // A field whose roots are searched for.
    struct SearchedField {
        FieldPtr field;
        double max_noise_scale;  // upper bound of FieldRay::noise_scale over rays in the box; 0: unknown
    };
    // A leaf that is not flat, in the simplest form that it has in this cell.
    using Form = std::variant<ConvexDensity, ProductSum, RoundSurface, RoundProduct, SearchedDensity, SearchedField>;
    struct Soft {
        Form form;
        std::size_t half_spaces;  // number that the form was made of
    };

    bool is_one_soft() const { return nodes_.size() == 1 && softs_.size() == 1 && leaves_[0].soft == 0; }
    // Appends the leaf, or sets `constant` if the whole box is inside or outside of it.
    void add_leaf(const SolidLeaf& leaf, const Box& box, const Tolerances& tolerances, RootMethod root_method,
                  std::optional<bool>& constant);
    static Form form_of_field(const FieldPtr& field, const Box& box, const Tolerances& tolerances,
                              RootMethod root_method);
    static Form form_of_density(LocalDensity density, const DensityTree& tree, const Box& box,
                                const Tolerances& tolerances, RootMethod root_method);
    /// The intersection of the leaves whose bit in `positive` is set with the complements of the others; empty if it is
    /// not one product.
    std::optional<ConvexDensity> intersection_of_leaves(unsigned positive) const;
    // Evaluates the CSG for given sides of its leaves; `state` is scratch for the nodes' values.
    bool evaluate(std::vector<char>& state, const std::vector<char>& inside) const;
    SurfaceCrossing first_leaf_crossing(const Vec3& origin, const Vec3& direction, double t0, double t1, bool any,
                                        CrossingScratch& scratch) const;
    // Fills scratch.events with the crossings of all leaves, sorted, and scratch.inside with the leaves that hold at
    // t0.
    void find_events(const Vec3& origin, const Vec3& direction, double t0, double t1, CrossingScratch& scratch) const;
    // The first of the events that changes whether the ray is inside the solid.
    SurfaceCrossing first_change(const Vec3& direction, CrossingScratch& scratch) const;
    // The functions below call visit(t, entering, normal) for the crossings in order, until it returns false; a normal
    // of 0 means that the caller has to compute it. If `start_inside` is not null, it is set to whether t0 is inside.
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
    // With `coarse`, each t may be later than the crossing, and the normal is 0.
    template <class Visit>
    void sum_crossings(const ProductSum& sum, const Vec3& origin, const Vec3& direction, double t0, double t1,
                       bool coarse, CrossingScratch& scratch, bool* start_inside, Visit visit) const;
    // For a RoundSurface or a RoundProduct (`round`), whose crossings are `all`.
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
