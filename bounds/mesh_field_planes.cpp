// The density of a mesh near a box where only one or two of its planes reach: a half-space or a wedge.
#include <algorithm>

#include "bounds/mesh_field.hpp"

namespace deburr {
namespace {

// The least angle between two planes that make a wedge: an error of ε in one moves their edge by ε over the angle.
constexpr double least_angle = 1e-6;

/// Whether both are one plane up to rounding, facing the same way.
bool same_plane(const ClosedMesh::Plane& a, const ClosedMesh::Plane& b, double scale) {
    if (a.id == b.id) return true;
    return glm::dot(a.normal, b.normal) > 0 && largest(a.normal - b.normal) <= 4 * epsilon &&
           std::abs(a.offset - b.offset) <= 8 * epsilon * scale;
}

// An upper bound of the distance between the box and a convex set, whose point nearest to x is nearest(x), by a few
// alternating projections from `start`.
template <class Nearest>
double distance_bound(const Box& box, Vec3 start, Nearest nearest) {
    double distance = infinity;
    Vec3 on = start;
    for (int k = 0; k < 8; ++k) {
        const Vec3 in = glm::clamp(on, box.lo, box.hi);
        distance = std::min(distance, glm::distance(in, on));
        on = nearest(in);
    }
    return std::min(distance, glm::distance(on, glm::clamp(on, box.lo, box.hi)));
}

/// An upper bound of the distance between the box and the segment ab.
double distance_bound(Vec3 a, Vec3 b, const Box& box) {
    return distance_bound(box, 0.5 * (a + b), [&](Vec3 x) {
        const Vec3 d = b - a;
        return a + std::clamp(glm::dot(x - a, d) / glm::dot(d, d), 0.0, 1.0) * d;
    });
}

}  // namespace

// The planes of some triangles, if they are no more than two.
struct MeshField::NearPlanes {
    const ClosedMesh::Plane *a = nullptr, *b = nullptr;
    double scale;  // largest coordinate of the mesh

    // Adds a plane; false for a third one, which is left out.
    bool add(const ClosedMesh::Plane& plane) {
        if (is_a(plane) || (b && same_plane(plane, *b, scale))) return true;
        if (b) return false;
        (a ? b : a) = &plane;
        return true;
    }
    bool is_a(const ClosedMesh::Plane& plane) const { return a && same_plane(plane, *a, scale); }
};

std::optional<DensityTree> MeshField::as_density(const Box& cell) const {
    const Box box = reached(cell);
    if (box.empty()) return std::nullopt;
    thread_local std::vector<int> found;
    const std::optional<NearPlanes> planes = near_planes(box, found);
    if (!planes) return std::nullopt;
    return planes->b ? wedge(box, found, *planes) : one_plane(box, found, *planes->a);
}

// The planes of all triangles that reach the box, which are stored in `found` in increasing order; none if they are
// more than two, or if no triangle reaches.
std::optional<MeshField::NearPlanes> MeshField::near_planes(const Box& box, std::vector<int>& found) const {
    found.clear();
    const double scale = std::max(largest(box_.lo), largest(box_.hi));
    NearPlanes planes{.scale = scale};
    bool many = false;
    const auto add = [&](int t) {
        found.push_back(t);
        many = !planes.add(mesh_->plane(t));
        return !many;
    };
    if (whole_) {
        mesh_->visit_near(box, radius_, add);
    } else {
        for (const int t : triangles_)
            if (mesh_->reaches(t, box, radius_) && !add(t)) break;
    }
    if (found.empty() || many) return std::nullopt;
    // Of several planes that are equal up to rounding the first is taken; sorting makes that the same in every call.
    std::sort(found.begin(), found.end());
    planes = {.scale = scale};
    for (const int t : found)
        if (!planes.add(mesh_->plane(t))) return std::nullopt;
    return planes;
}

HalfSpace MeshField::half_space(const ClosedMesh::Plane& p) const { return {p.normal, p.offset, sharp_ ? 0 : radius_}; }

// The half-space of the only plane; none if no triangle provably reaches the box, where there may be nothing.
std::optional<DensityTree> MeshField::one_plane(const Box& box, const std::vector<int>& triangles,
                                                const ClosedMesh::Plane& plane) const {
    const bool is_reached = std::any_of(triangles.begin(), triangles.end(), [&](int t) {
        return distance_bound(box, mesh_->ball(t).center, [&](Vec3 x) { return mesh_->nearest(t, x); }) < radius_;
    });
    if (!is_reached) return std::nullopt;
    return DensityTree{{half_space(plane)}, {{Op::half_space, 0}}, {}};
}

std::optional<DensityTree> MeshField::wedge(const Box& box, const std::vector<int>& triangles,
                                            const NearPlanes& planes) const {
    const ClosedMesh::Plane &a = *planes.a, &b = *planes.b;
    // The line in which two nearly equal planes meet is not known well enough.
    if (glm::length(glm::cross(a.normal, b.normal)) < least_angle && glm::dot(a.normal, b.normal) > 0)
        return std::nullopt;
    const std::optional<Op> op = edge_between(box, triangles, planes);
    if (!op) return std::nullopt;
    DensityTree wedge{{half_space(a), half_space(b)}, {{Op::half_space, 0}, {Op::half_space, 1}, {*op, 0, 1}}, {}};
    if (!sharp_) {
        wedge.nodes.push_back({Op::convolution, wedge.root()});
        wedge.ball = Mat3(radius_);
    }
    return wedge;
}

// How the two planes meet: in edges that are all convex (conjunction) or all concave (disjunction), one of which is
// provably within reach of the box; else none.
std::optional<Op> MeshField::edge_between(const Box& box, const std::vector<int>& triangles,
                                          const NearPlanes& planes) const {
    bool convex = false, concave = false, meet = false;
    for (const int t : triangles) {
        if (!planes.is_a(mesh_->plane(t))) continue;
        for (int k = 0; k < 3; ++k) {
            const ClosedMesh::Neighbour& other = mesh_->across(t, k);
            if (planes.is_a(mesh_->plane(other.triangle))) continue;
            if (!std::binary_search(triangles.begin(), triangles.end(), other.triangle)) continue;
            const Vec3 beyond = mesh_->corner(other.triangle, (other.edge + 2) % 3);
            (glm::dot(planes.a->normal, beyond) < planes.a->offset ? convex : concave) = true;
            meet = meet || distance_bound(mesh_->corner(t, k), mesh_->corner(t, (k + 1) % 3), box) < radius_;
        }
    }
    if (!meet || convex == concave) return std::nullopt;
    return convex ? Op::conjunction : Op::disjunction;
}

}  // namespace deburr
