#include "raytracer/scene/round_convolution.hpp"

#include "bounds/bounding_box.hpp"
#include "bounds/density_tree.hpp"
#include "bounds/mesh_field.hpp"
#include "bounds/solid_tree.hpp"
#include "polygonizer/mesh/mesh_check.hpp"
#include "polygonizer/triage/triage.hpp"
#include "raytracer/model/flat_faces.hpp"

namespace deburr {
namespace {

// In radii of the ball. An error of the mesh moves the surface by at most as much. The mesh's edges are rounded, since
// smooth surfaces take far fewer cells: rounding by δ removes some δ² of an edge's cross-section and moves the surface
// by some δ²/r; at seams of tangent surfaces it moves it by a part of 0.28 δ.
constexpr double mesh_tolerance = 0.005, mesh_rounding = 0.05;
// Solids with more are refused, since they would take minutes.
constexpr std::size_t most_half_spaces = 400'000;
constexpr double most_triangles = 400'000;
// Triangles of balls and tori, per area over tolerance times radius; measured on balls.
constexpr double triangles_for_area = 0.7;
// Points may be this many tolerances from the surface, as the mesh is measured at few places.
constexpr double check_slack = 2;
// A mesh that fails its check is made again with half the tolerance, up to this many times.
constexpr int attempts = 3;

// Upper bound of the number of triangles for balls and tori; other parts need few, since they are straight in one
// direction.
double triangles_of(const DensityTree& tree, const Box& box, double tolerance) {
    const double side = glm::distance(box.lo, box.hi), most_area = 2 * side * side;
    double sum = 0;
    for (const HalfSpace& part : tree.half_spaces) {
        if (!part.round || part.round->kind == RoundCoordinate::Kind::axis) continue;
        const double R = part.offset, ring = part.round->ring;
        const bool is_ball = part.round->kind == RoundCoordinate::Kind::point;
        const double area = std::min(most_area, is_ball ? 4 * pi * R * R : 4 * pi * pi * ring * R);
        sum += triangles_for_area * area / (tolerance * R);
    }
    return sum;
}

NoRoundConvolution too_fine() {
    return NoRoundConvolution(
        "expected a radius that is larger for the size of the density, whose round parts are polygonized to a part of "
        "it; rounded(r, d) takes any");
}

// A mesh of the solid that has passed its check; empty if the solid is. Throws NoRoundConvolution.
Mesh polygonized(const SolidTree& solid, double tolerance) {
    const Box box = polygonization_box(solid);
    try {
        for (int k = 0; k < attempts; ++k, tolerance *= 0.5) {
            Mesh mesh = triage(solid, box, {.tolerance = tolerance, .max_half_spaces = most_half_spaces});
            if (check_mesh(mesh, solid, box, {.tolerance = check_slack * tolerance}).faults() == 0) return mesh;
        }
    } catch (const TooManyCells&) {
    }
    throw too_fine();
}

}  // namespace

Solid convolved_round(double radius, const Density& density, int line) {
    // Operators + - * get the meaning that they have below a Boolean operator.
    const double rounding = mesh_rounding * radius;
    const Density function = density.node().may_be_illegal ? density | density : density;
    const double tolerance = mesh_tolerance * radius;
    const DensityTree tree = flatten(function, rounding);
    const Box box = bounding_box(tree);
    if (box.empty()) return Solid::rounded(radius, density, line);
    if (!box.finite())
        throw NoRoundConvolution(
            "expected a bounded density, as this one has round parts; cut it off with box(lo, hi)");
    if (triangles_of(tree, box, tolerance) > most_triangles) throw too_fine();
    const SolidTree solid = flatten(Solid::rounded(rounding, function));
    Mesh mesh = polygonized(solid, tolerance);
    if (mesh.triangles.empty()) return Solid::rounded(radius, density, line);
    std::vector<ClosedMesh::Corners> corners;
    corners.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) corners.push_back(t.vertex);
    flatten_faces(mesh.positions, corners);
    auto closed = std::make_shared<ClosedMesh>(std::move(mesh.positions), std::move(corners));
    return Solid::of_field(std::make_shared<MeshField>(std::move(closed), radius), line);
}

}  // namespace deburr
