#include "raytracer/scene/thin_walls.hpp"

#include <array>
#include <vector>

namespace deburr {
namespace {

// Cosine between two faces' normals above which they do not form a wall but an edge that is rounded off.
constexpr double opposite = -0.9;

// The distance at which the ray from x in this direction leaves the solid through the triangle; infinity if it does
// not.
double distance_along(const ClosedMesh& mesh, int t, Vec3 x, Vec3 direction) {
    const ClosedMesh::Plane& plane = mesh.plane(t);
    const double fall = glm::dot(plane.normal, direction);
    if (fall <= 0) return infinity;
    const double distance = (plane.offset - glm::dot(plane.normal, x)) / fall;
    const Vec3 y = x + distance * direction;
    for (int k = 0; k < 3; ++k) {
        const Vec3 a = mesh.corner(t, k), b = mesh.corner(t, (k + 1) % 3);
        if (glm::dot(glm::cross(b - a, y - a), plane.normal) < 0) return infinity;
    }
    return distance;
}

// The thickness of the solid behind a point of the facet, if it is at most `most` and ends at a face that looks the
// opposite way; else infinity.
double thickness(const ClosedMesh& mesh, int facet, Vec3 x, double most, std::vector<int>& near) {
    const Vec3 inward = -mesh.plane(facet).normal, end = x + most * inward;
    near.clear();
    mesh.near({glm::min(x, end), glm::max(x, end)}, 0, near);
    double least = most;
    int other = -1;
    for (const int t : near) {
        if (mesh.plane(t).id == mesh.plane(facet).id) continue;
        const double distance = distance_along(mesh, t, x, inward);
        if (!(distance > 1e-9 * most) || distance > least) continue;
        least = distance;
        other = t;
    }
    return other >= 0 && glm::dot(mesh.plane(other).normal, -inward) < opposite ? least : infinity;
}

}  // namespace

ThinWalls thin_walls(const MeshField& field, std::size_t most) {
    ThinWalls walls;
    const double radius = field.filter_radius();
    if (radius == 0) return walls;
    const ClosedMesh& mesh = field.mesh();
    constexpr double third = 1.0 / 3, far = 2.0 / 3, near_side = 1.0 / 6;
    constexpr std::array<std::array<double, 3>, 4> points = {
        {{third, third, third}, {far, near_side, near_side}, {near_side, far, near_side}, {near_side, near_side, far}}};
    const std::size_t step = mesh.size() / most + 1;
    std::vector<int> memory;
    for (std::size_t t = 0; t < mesh.size(); t += step) {
        bool vanishes = false;
        for (const auto& weight : points) {
            Vec3 x(0.0);
            for (int k = 0; k < 3; ++k) x += weight[std::size_t(k)] * mesh.corner(int(t), k);
            const double thick = thickness(mesh, int(t), x, vanishing_thickness * radius, memory);
            if (thick == infinity || field.at(x - 0.5 * thick * mesh.plane(int(t)).normal).value >= 0) continue;
            vanishes = true;
            if (thick >= walls.thickness) continue;
            walls.thickness = thick;
            walls.place = x;
        }
        walls.facets += vanishes;
    }
    return walls;
}

}  // namespace deburr
