// Judges how the facets of a mesh lie to the solid that they stand for.
#pragma once
#include <array>
#include <memory>
#include <mutex>

#include "bounds/in_parallel.hpp"
#include "polygonizer/mesh/facets.hpp"
#include "polygonizer/mesh/leaf_surfaces.hpp"

namespace deburr {

/// The least cosine between a facet and its surface that a collapse may leave.
constexpr double upright_after_collapse = 0.8;

/// How a facet lies to the surface.
struct FacetShape {
    double own = 1;       // cosine of the angle to its own surface at its middle; −1 if it has no area
    double cosine = 1;    // the lesser of that and the cosine to the surface of the solid nearest to the middle
    double distance = 0;  // of the middle from the solid's surface; 0 where the density is saturated
    /// Whether the density is saturated at the middle, so that there is no first-order distance.
    bool saturated = false;
};

/// The distance from a facet's middle within which surfaces matter: the one that the facet stands for is nearer.
double facet_margin(const Mesh& mesh, const SolidTree& solid);

/// A DistanceField of the solid for points on the facets of a mesh: it knows the surface that a facet stands for, and
/// all that are nearer.
DistanceField field_around(const Mesh& mesh, const SolidTree& solid);

/// Judges the facets of any mesh of one solid. Only one thread at a time may use a judge; lend() gives others copies.
class FacetJudge {
public:
    /// `mesh` shows where the surfaces are. Keeps a reference to `solid`.
    FacetJudge(const SolidTree& solid, const Mesh& mesh);
    /// Calls work(judge) with this judge or a copy of it that no other thread is using; copies are kept for reuse. The
    /// verdicts of all copies are the same. Safe to call from several threads.
    template <class Work>
    void lend(Work work) const {
        const auto back = [this](const FacetJudge* judge) { give_back(judge); };
        const std::unique_ptr<const FacetJudge, decltype(back)> judge(take(), back);
        work(*judge);
    }
    FacetJudge(const FacetJudge&) = delete;
    FacetJudge& operator=(const FacetJudge&) = delete;

    /// The shape of a facet. Walls (Origin::wall) are always good. If the facet's own cosine is below `least`, the
    /// other members are not computed.
    FacetShape shape(const Facets& facets, const Facet& f, double least = -infinity) const;
    /// Whether thirteen points all over the triangle are within `tolerance` of the solid's surface: its middle, and the
    /// points of is_near_within() and of is_near_between() on each edge.
    bool is_near(const std::array<Vec3, 3>& corners, double tolerance) const;
    /// Whether the triangle's middle and the points of is_near_within() are within `tolerance` of the surface.
    bool is_near_inside(const std::array<Vec3, 3>& corners, double tolerance) const;
    /// Whether the three points half-way between the triangle's middle and its corners are within `tolerance` of the
    /// surface.
    bool is_near_within(const std::array<Vec3, 3>& corners, double tolerance) const;
    /// Whether the three points that divide the edge from a to b into four are within `tolerance` of the surface.
    bool is_near_between(Vec3 a, Vec3 b, double tolerance) const;
    /// Whether x is on the solid's surface up to rounding.
    bool on_surface(Vec3 x) const { return std::abs(solid_.at(x).distance) <= 10 * surfaces_.slack(); }
    const DistanceField& solid() const { return solid_; }
    const LeafSurfaces& surfaces() const { return surfaces_; }
    /// Length of the diagonal of the box around the mesh.
    double size() const { return size_; }

private:
    // Surfaces farther than `margin` from a facet are ignored.
    FacetJudge(const SolidTree& solid, const Box& box, double margin);

    const FacetJudge* take() const;
    void give_back(const FacetJudge* judge) const;

    bool is_point_near(Vec3 x, double tolerance) const;

    const SolidTree& tree_;
    Box box_;  // around the mesh
    double margin_;
    DistanceField solid_;
    bool one_leaf_;
    LeafSurfaces surfaces_;
    double size_;
    mutable std::mutex mutex_;
    mutable std::vector<std::unique_ptr<FacetJudge>> copies_;
    mutable std::vector<const FacetJudge*> free_{this};  // judges that no thread is using
    bool in_single_;  // whether facets are also judged as single precision rounds them
};

/// Calls work(judge, first, last) for ranges that together make up [0, count), concurrently. The judge belongs to the
/// call for as long as it runs.
template <class Work>
void judge_in_parallel(const FacetJudge& judge, std::size_t count, Work work) {
    constexpr std::size_t most = 4096;  // facets in a range
    in_parallel_ranges(count, most, [&](std::size_t first, std::size_t last) {
        judge.lend([&](const FacetJudge& own) { work(own, first, last); });
    });
}

}  // namespace deburr
