#include "polygonizer/octree/octree_leaning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace deburr {
namespace {

// The least cosine between a triangle and the surface; below it, 75°, the cells around it are cut further.
constexpr double min_cosine = 0.25;
// The greatest distance from the surface relative to the longest side: a triangle beyond it closes a surface that goes
// on.
constexpr double off = 0.45;
// Slivers leave leaning to repair.hpp, because cutting cells does not help them.
constexpr double sliver = 0.005;  // height over longest side
// Triangles that face as their points do, to this cosine, are good enough not to be compared.
constexpr double alike = 0.95;

}  // namespace

bool LeaningTriangles::leans(const TriangleVertices& t) const {
    if (!std::isfinite(tolerance_) && cosine_to_points(t) > alike) return false;
    const Standing s = standing(t);
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest, glm::length(mesh_.position(t[k]) - mesh_.position(t[(k + 1) % 3])));
    if (s.cosine < min_cosine && glm::length(mesh_.area_vector(t)) > sliver * longest * longest) return true;
    return !(s.distance <= std::min(tolerance_, has_forms_ ? off * longest : infinity));
}

Standing LeaningTriangles::standing(const TriangleVertices& t) const {
    const Vec3 middle = mesh_.middle(t), area = mesh_.area_vector(t);
    const SurfaceSample o = tree_.solid(middle).at(middle);
    Standing s;
    const double size = glm::length(area);
    if (size > 0 && o.normal != Vec3(0.0)) s.cosine = glm::dot(area, o.normal) / size;
    s.distance = std::abs(o.distance);
    if (std::isfinite(o.distance)) return s;
    if (passes_near(middle, area))
        s.distance = tolerance_;
    else
        s.cosine = 0;  // so far off that the density is saturated
    return s;
}

// Whether the surface passes within the tolerance of the triangle along its normal. It serves where a density of a
// smaller radius is saturated.
bool LeaningTriangles::passes_near(Vec3 middle, Vec3 area) const {
    const double size = glm::length(area);
    if (!std::isfinite(tolerance_) || !(size > 0)) return false;
    const bool in = tree_.solid(middle).inside(middle);
    const Vec3 beyond = middle + area * ((in ? tolerance_ : -tolerance_) / size);
    return tree_.solid(beyond).inside(beyond) != in;
}

// The least cosine between the triangle and the normals at its points, which says enough if all are smooth; −1 if one
// is hard.
double LeaningTriangles::cosine_to_points(const TriangleVertices& t) const {
    const Vec3 area = mesh_.area_vector(t);
    double least = 1;
    for (const int v : t) {
        const SurfacePoint& p = mesh_.points[v];
        if (p.hard()) return -1;
        least = std::min(least, glm::dot(area, p.faces[0].normal));
    }
    return least / std::max(glm::length(area), std::numeric_limits<double>::min());
}

bool LeaningTriangles::first_diagonal(const std::vector<int>& q) const {
    const TriangleVertices t[4] = {{q[0], q[1], q[2]}, {q[0], q[2], q[3]}, {q[1], q[2], q[3]}, {q[1], q[3], q[0]}};
    double cosine[4];
    for (int k = 0; k < 4; ++k) cosine[k] = cosine_to_points(t[k]);
    if (*std::min_element(cosine, cosine + 4) > alike)
        return glm::length(mesh_.position(q[0]) - mesh_.position(q[2])) <=
               glm::length(mesh_.position(q[1]) - mesh_.position(q[3]));
    Standing s[4];
    for (int k = 0; k < 4; ++k) s[k] = standing(t[k]);
    const double first = std::min(s[0].cosine, s[1].cosine), second = std::min(s[2].cosine, s[3].cosine);
    if (first < min_cosine || second < min_cosine) return first >= second;
    const double one = std::max(s[0].distance, s[1].distance), other = std::max(s[2].distance, s[3].distance);
    if (std::abs(one - other) > 1e-6 * tree_.edge()) return one < other;
    return glm::length(mesh_.position(q[0]) - mesh_.position(q[2])) <=
           glm::length(mesh_.position(q[1]) - mesh_.position(q[3]));
}

}  // namespace deburr
