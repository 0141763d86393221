// How the facets of a mesh lie to the solid that they stand for.
#pragma once
#include <array>
#include <memory>
#include <mutex>

#include "bounds/in_parallel.hpp"
#include "polygonizer/mesh/facets.hpp"
#include "polygonizer/mesh/leaf_surfaces.hpp"

namespace deburr {

struct FacetShape {
    double own = 1;       // cosine to its own surface at its middle; −1 without area
    double cosine = 1;    // the same, or to the solid's surface that is nearest to the middle if that is less
    double distance = 0;  // of the middle from the solid's surface; 0 where the density is saturated
    bool saturated = false;
};

/// How far around a facet surfaces matter: from its middle the one that it stands for is nearer.
double facet_margin(const Mesh& mesh, const SolidTree& solid);

/// The solid as it is seen from the facets of a mesh: from the middle of each the surface that it stands
/// for, and all that are nearer.
DistanceField field_around(const Mesh& mesh, const SolidTree& solid);

/// Judges facets of any mesh of one solid. One thread at a time may use it.
class FacetJudge {
public:
    /// `mesh` tells where the surfaces are.
    FacetJudge(const SolidTree& solid, const Mesh& mesh);
    /// Calls work(judge) with a judge of the same that no other thread has: this one or a copy of it, which is kept.
    /// What it says does not depend on which of them it is.
    template <class Work>
    void lend(Work work) const {
        const auto back = [this](const FacetJudge* judge) { give_back(judge); };
        const std::unique_ptr<const FacetJudge, decltype(back)> judge(take(), back);
        work(*judge);
    }
    FacetJudge(const FacetJudge&) = delete;
    FacetJudge& operator=(const FacetJudge&) = delete;

    /// Shape of facet f; walls are as they should be. Once its own cosine is found to be below `least`, the rest is not
    /// looked at.
    FacetShape shape(const Facets& facets, const Facet& f, double least = -infinity) const;
    /// Whether points all over the triangle are within the tolerance of the solid's surface: its middle, those of
    /// is_near_within, and those of is_near_between on each edge.
    bool is_near(const std::array<Vec3, 3>& corners, double tolerance) const;
    /// The same for the three points half-way between the triangle's middle and its corners.
    bool is_near_within(const std::array<Vec3, 3>& corners, double tolerance) const;
    /// The same for the three points that divide the edge from a to b in four.
    bool is_near_between(Vec3 a, Vec3 b, double tolerance) const;
    bool on_surface(Vec3 x) const { return std::abs(solid_.at(x).distance) <= 10 * surfaces_.slack(); }
    const DistanceField& solid() const { return solid_; }
    const LeafSurfaces& surfaces() const { return surfaces_; }
    /// Length of the diagonal of the box around the mesh.
    double size() const { return size_; }

private:
    // Surfaces farther than `margin` from a facet are none of its business.
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
    mutable std::vector<const FacetJudge*> free_{this};  // that no thread has
    bool in_single_;                                     // facets are judged as single precision rounds them, too
};

/// Calls work(judge, first, last) for ranges of `count` facets that make up all of them, side by side. A judge is a
/// thread's own for as long as its range takes.
template <class Work>
void judge_in_parallel(const FacetJudge& judge, std::size_t count, Work work) {
    constexpr std::size_t most = 4096;  // of a range
    in_parallel_ranges(count, most, [&](std::size_t first, std::size_t last) {
        judge.lend([&](const FacetJudge& own) { work(own, first, last); });
    });
}

}  // namespace deburr
