#include "raytracer/scene_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "bounds/bounding_box.hpp"
#include "polygonizer/marching_cubes.hpp"
#include "polygonizer/octree.hpp"
#include "polygonizer/separate.hpp"
#include "raytracer/errors.hpp"

namespace deburr {
namespace {

// A grid of more cubes than this is refused: it would take tens of gigabytes.
constexpr double most_cubes = 2e9;

// For pictures: the horizon of a floor that ends so far away is the true one to a pixel.
constexpr double rendering_reach = 1e4;
// For pictures: on Figure 12 of Lobb's paper 99 % of the hits are then within 0.03 r of the exact
// ones, where the paper's one refinement of each edge leaves 0.26 r.
constexpr double rendering_tolerance = 0.03;

bool finite(const Box& box) { return box.empty() || box.finite(); }

// All that is finite of the scene, and the eye: infinite solids are cut off around it.
Box finite_part(const Scene& scene, const std::vector<Box>& boxes) {
    Box all;
    for (const Box& b : boxes)
        if (!b.empty() && b.finite()) all = hull(all, b);
    if (all.empty()) {
        all = hull(Box{scene.camera.target, scene.camera.target}, Box{scene.camera.eye, scene.camera.eye});
        for (const Box& b : boxes)
            for (int k = 0; k < 3; ++k)
                for (const double side : {b.lo[k], b.hi[k]})
                    if (std::isfinite(side)) {
                        all.lo[k] = std::min(all.lo[k], side);
                        all.hi[k] = std::max(all.hi[k], side);
                    }
    }
    return all;
}

}  // namespace

MeshMethod parse_mesh_method(const std::string& what, const std::string& name) {
    if (name == "triage") return MeshMethod::triage;
    if (name == "marching-cubes") return MeshMethod::marching_cubes;
    throw UsageError(fmt::format("{}: expected {}, got '{}'", what, mesh_method_names(), name));
}

std::string mesh_method_names() { return "triage or marching-cubes"; }

double parse_positive(const std::string& what, const std::string& text) {
    double x = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (error != std::errc() || end != text.data() + text.size() || !(x > 0) || !std::isfinite(x))
        throw UsageError(fmt::format("{}: expected a number > 0, got '{}'", what, text));
    return x;
}

double parse_tolerance(const std::string& text) {
    return text == "inf" ? infinity : parse_positive("--tolerance", text);
}

MeshSettings picture_mesh_settings(const std::string& via, const std::string& tolerance) {
    MeshSettings settings;
    settings.method = parse_mesh_method("--via", via);
    settings.reach = rendering_reach;
    if (tolerance.empty()) settings.tolerance_in_radii = rendering_tolerance;
    else settings.tolerance = parse_tolerance(tolerance);
    return settings;
}

double least_radius(const SolidTree& solid) {
    double least = infinity;
    for (const SolidLeaf& leaf : solid.leaves)
        for (const HalfSpace& h : leaf.density.half_spaces)
            if (h.radius > 0) least = std::min(least, h.radius);
    return least < infinity ? least : 0;
}

// Triage follows half-spaces: what has none it cannot see.
static bool has_field(const SolidTree& solid) {
    return std::any_of(solid.leaves.begin(), solid.leaves.end(), [](const SolidLeaf& leaf) { return leaf.field != nullptr; });
}

SceneMesh mesh_scene(const Scene& scene, const MeshSettings& settings) {
    SceneMesh result;
    std::vector<Box> boxes;
    for (const Solid& solid : scene.solids) {
        result.trees.push_back(flatten(solid));
        boxes.push_back(bounding_box(result.trees.back()));
    }
    const Box finite_box = finite_part(scene, boxes);
    const Vec3 size = finite_box.hi - finite_box.lo;
    const Box limit = inflated(finite_box, settings.reach * std::max({size.x, size.y, size.z, 1e-6}));
    for (std::size_t i = 0; i < scene.solids.size(); ++i) {
        SolidTree& tree = result.trees[i];
        Mesh part;
        Box box = boxes[i];
        if (!finite(box)) {
            // Cut off on infinite sides only; the others keep their margin.
            Box margin = inflated(box, 0.05 * std::max({size.x, size.y, size.z}));
            for (int k = 0; k < 3; ++k) {
                margin.lo[k] = std::isfinite(margin.lo[k]) ? margin.lo[k] : limit.lo[k];
                margin.hi[k] = std::isfinite(margin.hi[k]) ? margin.hi[k] : limit.hi[k];
            }
            tree = flatten(scene.solids[i] & Solid::sharp(Density::box(margin.lo, margin.hi)));
            result.warnings.push_back(fmt::format("solid {} is unbounded: its mesh is cut off", i + 1));
        }
        box = polygonization_box(tree);
        if (box.empty()) {
            result.parts.emplace_back();
            continue;
        }
        if (settings.method == MeshMethod::triage && has_field(tree)) {
            part = octree(tree, box, {.tolerance = settings.tolerance});
        } else if (settings.method == MeshMethod::triage) {
            TriageStatistics statistics;
            const double radius = least_radius(tree);
            const double relative = radius > 0 ? settings.tolerance_in_radii * radius : infinity;
            part = triage(tree, box, {std::min(settings.tolerance, relative)}, &statistics);
            result.triage.cells += statistics.cells;
            result.triage.open_cells += statistics.open_cells;
            result.triage.rounds = std::max(result.triage.rounds, statistics.rounds);
        } else {
            const double grid = settings.grid > 0 ? settings.grid : marching_cubes_grid(tree, box);
            if (marching_cubes_count(box, grid) > most_cubes)
                throw UnsupportedError(fmt::format(
                    "--grid: a grid of {:g} would have more than {:g} cubes for solid {}", grid, most_cubes, i + 1));
            part = marching_cubes(tree, box, grid);
        }
        result.mesh.append(part, int(i));
        result.parts.push_back(std::move(part));
    }
    separate_touching(result.mesh);
    auto moved = result.mesh.positions.begin();
    for (Mesh& part : result.parts)
        for (Vec3& x : part.positions) x = *moved++;
    return result;
}

std::vector<MeshMetrics> measure_parts(const SceneMesh& mesh) {
    std::vector<MeshMetrics> all;
    for (std::size_t i = 0; i < mesh.parts.size(); ++i) all.push_back(measure(mesh.parts[i], mesh.trees[i]));
    return all;
}

}  // namespace deburr
