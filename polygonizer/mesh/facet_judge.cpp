#include "polygonizer/mesh/facet_judge.hpp"

#include <algorithm>
#include <limits>

#include "polygonizer/mesh/facet_orientation.hpp"

namespace deburr {

double facet_margin(const Mesh& mesh, const SolidTree& solid) {
    // Rounding moves a surface by less than the radius; facets of free forms are near their surface compared to their
    // size.
    double margin = 0;
    for (const SolidLeaf& leaf : solid.leaves) {
        for (const HalfSpace& h : leaf.density.half_spaces) margin = std::max(margin, h.radius);
        if (leaf.field) margin = std::max(margin, mean_edge(mesh));
    }
    return margin;
}

DistanceField field_around(const Mesh& mesh, const SolidTree& solid) {
    return DistanceField(solid, field_box(mesh), facet_margin(mesh, solid));
}

FacetJudge::FacetJudge(const SolidTree& solid, const Mesh& mesh)
    : FacetJudge(solid, field_box(mesh), facet_margin(mesh, solid)) {}

const FacetJudge* FacetJudge::take() const {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) {
        copies_.push_back(std::unique_ptr<FacetJudge>(new FacetJudge(tree_, box_, margin_)));
        return copies_.back().get();
    }
    const FacetJudge* judge = free_.back();
    free_.pop_back();
    return judge;
}

void FacetJudge::give_back(const FacetJudge* judge) const {
    const std::lock_guard lock(mutex_);
    free_.push_back(judge);
}

FacetJudge::FacetJudge(const SolidTree& solid, const Box& box, double margin)
    : tree_(solid),
      box_(box),
      margin_(margin),
      solid_(solid, box, margin),
      one_leaf_(solid.leaves.size() == 1 && solid.nodes.size() == 1),
      surfaces_(solid, box, one_leaf_ ? &solid_ : nullptr) {
    size_ = glm::length(box.hi - box.lo);
    // Where single precision cannot distinguish a rounded edge from a sharp one, no file in it can be right.
    constexpr double of_radius = 0.01, of_size = 1e-4;
    const double radius = solid.min_radius();
    const double farthest = std::max(largest(glm::abs(box.lo)), largest(glm::abs(box.hi)));
    in_single_ = farthest * std::numeric_limits<float>::epsilon() < (radius > 0 ? of_radius * radius : of_size * size_);
}

FacetShape FacetJudge::shape(const Facets& facets, const Facet& f, double least) const {
    // A facet whose ratio of height to longest side is below this has no area.
    constexpr double no_area = 1e-6;
    if (f.origin.leaf == Origin::wall) return {};
    const Triangle& t = f.triangle;
    Vec3 x[3], middle(0.0), normals(0.0);
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        x[k] = facets.position(t.vertex[k]);
        middle += x[k] / 3.0;
        normals += facets.normal(t.normal[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, glm::length(x[k] - x[(k + 1) % 3]));
    const Vec3 area = glm::cross(x[1] - x[0], x[2] - x[0]);
    const double twice = glm::length(area);
    if (twice <= no_area * longest * longest) return {-1, -1, 0};
    // The facet as a file of single precision has it.
    const auto rounded = [&](Vec3 v) { return in_single_ ? Vec3(glm::vec3(v)) : v; };
    const Vec3 single = glm::cross(rounded(x[1]) - rounded(x[0]), rounded(x[2]) - rounded(x[0]));
    const double single_twice = glm::length(single);
    if (single_twice == 0) return {-1, -1, 0};
    const auto cosine = [&](Vec3 n) { return std::min(glm::dot(area, n) / twice, glm::dot(single, n) / single_twice); };
    const SurfaceSample o = solid_.at(middle);
    FacetShape s;
    s.saturated = !std::isfinite(o.distance);
    s.distance = s.saturated ? 0 : std::abs(o.distance);
    if (f.origin.leaf < 0) {
        s.own = cosine(facets.normal(t.normal[0]));
    } else {
        const SurfaceSample leaf = one_leaf_ ? o : surfaces_.at({f.origin.leaf}, middle);
        Vec3 own = leaf.normal;
        if (own == Vec3(0.0)) own = glm::length(normals) > 0 ? glm::normalize(normals) : normals;
        if (glm::dot(own, normals) < 0) own = -own;  // the leaf is subtracted
        s.own = cosine(own);
    }
    s.cosine = s.own;
    if (s.own < least) return s;
    const bool beside = s.distance > surfaces_.slack();
    const double nearest = o.normal != Vec3(0.0) && beside ? cosine(o.normal) : s.own;
    if (nearest > 0 && beside)
        s.cosine = std::min(s.own, nearest);
    else if (!faces_outward(solid_, middle, o, area / twice, normals, longest))
        s.cosine = std::min(nearest, -1e-3);
    return s;
}

bool FacetJudge::is_point_near(Vec3 x, double tolerance) const { return std::abs(solid_.at(x).distance) <= tolerance; }

bool FacetJudge::is_near_between(Vec3 a, Vec3 b, double tolerance) const {
    return is_point_near(0.5 * (a + b), tolerance) && is_point_near(0.75 * a + 0.25 * b, tolerance) &&
           is_point_near(0.25 * a + 0.75 * b, tolerance);
}

bool FacetJudge::is_near_within(const std::array<Vec3, 3>& corners, double tolerance) const {
    const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    return std::all_of(corners.begin(), corners.end(),
                       [&](Vec3 x) { return is_point_near(0.5 * (x + middle), tolerance); });
}

bool FacetJudge::is_near_inside(const std::array<Vec3, 3>& corners, double tolerance) const {
    return is_point_near((corners[0] + corners[1] + corners[2]) / 3.0, tolerance) && is_near_within(corners, tolerance);
}

bool FacetJudge::is_near(const std::array<Vec3, 3>& corners, double tolerance) const {
    if (!is_near_inside(corners, tolerance)) return false;
    for (std::size_t k = 0; k < 3; ++k)
        if (!is_near_between(corners[k], corners[(k + 1) % 3], tolerance)) return false;
    return true;
}

}  // namespace deburr
