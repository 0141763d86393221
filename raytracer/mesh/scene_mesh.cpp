#include "raytracer/mesh/scene_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bounds/bounding_box.hpp"
#include "bounds/in_parallel.hpp"
#include "polygonizer/marching_cubes/marching_cubes.hpp"
#include "polygonizer/mesh/model_mesh.hpp"
#include "polygonizer/mesh/separate_touching.hpp"
#include "polygonizer/octree/octree_cells.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

// A grid of more cubes than this is refused, since it would take tens of gigabytes.
constexpr double max_cubes = 2e9;

// Most cells at the surface where the user has not chosen their size: two million triangles, ten times as many as any
// scene in scenes/ needs, which take some seconds for a free form with twenty perturbations.
constexpr std::size_t max_own_open_cells = 1'000'000;

// A mesh's tolerance is measured at middles and to first order; more than this many of it is a fault.
constexpr double check_slack = 2;

bool finite(const Box& box) { return box.empty() || box.finite(); }

// The box of all that is finite in the scene, or of the camera if nothing is; infinite solids are cut off around it.
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

// Whether the solid has a model with a varying radius: a field with a radius that is not a density of one radius.
bool varies_in_radius(const SolidTree& tree) {
    return std::any_of(tree.leaves.begin(), tree.leaves.end(), [](const SolidLeaf& leaf) {
        return leaf.field && !leaf.field->is_density() && leaf.field->filter_radius() > 0;
    });
}

// Throws UnsupportedError if the solid has parts that triage cannot follow: anything but half-spaces and constant
// radii.
void need_densities(const SolidTree& solid, std::size_t id) {
    if (!solid.has_free_form()) return;
    const char* found = varies_in_radius(solid) ? "a model with a radius that varies (keep_sharp)"
                                                : "a free form or a sharp round part";
    throw UnsupportedError(fmt::format(
        "--method triage: expected rounded solids, got {} in solid {}; use octree or marching-cubes", found, id));
}

double octree_tolerance(const SolidTree& tree, const Box& box, const MeshSettings& settings) {
    const double radius = tree.min_radius();
    // A model with a varying radius gets the tolerance that triage would use if it could.
    const double in_radii = varies_in_radius(tree)
                                ? std::min(settings.tolerance_in_radii, settings.triage_tolerance_in_radii)
                                : settings.tolerance_in_radii;
    const double relative = radius > 0 ? in_radii * radius : settings.tolerance_in_sizes * largest(box.hi - box.lo);
    return std::min(settings.tolerance, tree.has_free_form() || radius > 0 ? relative : infinity);
}

bool has_chosen_cells(const MeshSettings& settings) {
    return settings.level > 0 || settings.edge > 0 || std::isfinite(settings.tolerance);
}

OctreeOptions octree_options(const SolidTree& tree, const Box& box, bool cut_off, const MeshSettings& settings,
                             CancelFlag cancel, WorkProgress* progress) {
    const double longest = largest(box.hi - box.lo), own = octree_edge(tree, box);
    OctreeOptions options;
    options.edge = settings.level > 0 ? std::ldexp(longest, -settings.level) : settings.edge > 0 ? settings.edge : own;
    // A solid that was cut off is many times as large as it looks.
    if (cut_off && settings.level == 0) options.edge = std::max(options.edge, own);
    options.edge *= settings.coarseness;
    options.hard_angle = settings.hard_angle;
    options.max_open_cells = has_chosen_cells(settings) ? CellTree::max_cells : max_own_open_cells;
    options.cancel = cancel;
    options.progress = progress;
    options.tolerance = octree_tolerance(tree, box, settings);
    options.decimate = settings.decimate && varies_in_radius(tree);
    return options;
}

// Calls `work`, and turns its errors into messages that name the solid and the cells.
template <class Work>
auto with_octree_errors(const Box& box, const MeshSettings& settings, double edge, std::size_t id, const Work& work) {
    try {
        return work();
    } catch (const OpenMeshError& error) {
        throw WorkError(fmt::format("solid {}: {}", id, error.what()));
    } catch (const std::length_error&) {
        if (has_chosen_cells(settings))
            throw UnsupportedError(
                fmt::format("--edge: cells of {:g} would be more than {} for solid {}", edge, CellTree::max_cells, id));
        throw UnsupportedError(fmt::format(
            "octree: the surface of solid {}, {:.3g} across, passes more than {} cells of {:.3g}: cut the solid off "
            "with & box(…), or choose its mesh by --via or --method, --tolerance or --edge",
            id, largest(box.hi - box.lo), max_own_open_cells, edge));
    }
}

Mesh by_octree(const SolidTree& tree, const Box& box, bool cut_off, const MeshSettings& settings, std::size_t id,
               CancelFlag cancel, WorkProgress& progress, OctreeStatistics& statistics) {
    const OctreeOptions options = octree_options(tree, box, cut_off, settings, cancel, &progress);
    return with_octree_errors(box, settings, options.edge, id, [&] { return octree(tree, box, options, &statistics); });
}

MeshMethod method_of(const SolidTree& tree, const MeshSettings& settings) {
    return settings.method.value_or(tree.has_free_form() ? MeshMethod::octree : MeshMethod::triage);
}

// Throws UnsupportedError if the solid's octree would be too large; called for all solids before any is meshed, which
// may take long.
void check_cells(const SolidTree& tree, bool cut_off, const MeshSettings& settings, std::size_t id, CancelFlag cancel) {
    const Box box = polygonization_box(tree);
    if (box.empty() || closed_mesh_of(tree) || method_of(tree, settings) != MeshMethod::octree) return;
    const OctreeOptions options = octree_options(tree, box, cut_off, settings, cancel, nullptr);
    with_octree_errors(box, settings, options.edge, id, [&] { check_octree_cells(tree, box, options); });
}

// The work of meshing the solid, relative to other solids.
double work_of(const SolidTree& solid) {
    std::size_t half_spaces = 1;
    for (const SolidLeaf& leaf : solid.leaves)
        half_spaces += leaf.field ? std::size_t(leaf.field->size()) : leaf.density.half_spaces.size();
    return double(half_spaces);
}

// One solid's mesh, and how it was made.
struct SolidMesh {
    Mesh mesh;
    std::optional<MeshMethod> method;
    double tolerance = infinity;
    TriageStatistics triage;
    OctreeStatistics octree;
    MeshCheckOptions check_options;
    std::optional<MeshCheck> check;
    bool made_again = false;
};

// Meshes one solid. `id` is its number in messages; `cut_off` tells that it was infinite, so that its box is not its
// own.
SolidMesh polygonize(const SolidTree& tree, bool cut_off, const MeshSettings& settings, std::size_t id,
                     CancelFlag cancel, WorkProgress& progress) {
    SolidMesh result;
    const Box box = polygonization_box(tree);
    if (box.empty()) return result;
    if (const auto model = closed_mesh_of(tree)) {  // a model without a radius is its own mesh, whatever the method
        result.mesh = mesh_of(*model, tree.leaves[tree.nodes[0].a].material);
        result.tolerance = 0;
        result.check_options.cancel = cancel;
        return result;
    }
    result.method = method_of(tree, settings);
    result.check_options.cancel = cancel;
    if (result.method == MeshMethod::octree) {
        result.mesh = by_octree(tree, box, cut_off, settings, id, cancel, progress, result.octree);
        result.tolerance = octree_tolerance(tree, box, settings);
        result.check_options.tolerance = check_slack * result.tolerance;
        if (!std::isfinite(result.check_options.tolerance)) result.check_options.min_tolerance = result.octree.edge;
    } else if (result.method == MeshMethod::triage) {
        need_densities(tree, id);
        const double radius = tree.min_radius();
        const double in_radii = std::min(settings.tolerance_in_radii, settings.triage_tolerance_in_radii);
        // A mesh without a tolerance relies on the half-spaces' planes, which cut it into pieces; a model's triangles
        // do not.
        constexpr double coarsest_of_model = 0.25;
        const bool of_model = std::any_of(tree.leaves.begin(), tree.leaves.end(),
                                          [](const SolidLeaf& leaf) { return leaf.field != nullptr; });
        const double most = of_model ? std::min(in_radii, coarsest_of_model) : in_radii;
        const double relative = radius > 0 ? most * radius : infinity;
        result.tolerance = settings.coarseness * std::min(settings.tolerance, relative);
        try {
            result.mesh = triage(
                tree, box,
                {.tolerance = result.tolerance, .decimate = settings.decimate, .cancel = cancel, .progress = &progress},
                &result.triage);
        } catch (const TooManyCells&) {
            throw UnsupportedError(
                fmt::format("triage: solid {}, {:.3g} across, has more than {} half-spaces in cells as small as its "
                            "radius of {:.3g}: "
                            "choose a larger radius, or --method octree",
                            id, largest(box.hi - box.lo), SubdivisionOptions{}.max_half_spaces, radius));
        }
        result.check_options.tolerance = check_slack * result.tolerance;
    } else {
        const double grid = settings.coarseness * (settings.grid > 0 ? settings.grid : marching_cubes_grid(tree, box));
        if (marching_cubes_count(box, grid) > max_cubes)
            throw UnsupportedError(fmt::format("--grid: a grid of {:g} would have more than {:g} cubes for solid {}",
                                               grid, max_cubes, id));
        result.mesh = marching_cubes(tree, box, grid, cancel, &progress);
        result.check_options.min_tolerance = grid;
        result.check_options.may_lean = true;
    }
    return result;
}

// Meshes one solid and checks the result. If it fails, it is made once more, finer, and the better of both is returned.
SolidMesh polygonize_checked(const SolidTree& tree, bool cut_off, const MeshSettings& settings, std::size_t id,
                             CancelFlag cancel, WorkProgress& progress) {
    SolidMesh first = polygonize(tree, cut_off, settings, id, cancel, progress);
    if (!settings.check) return first;
    const Box box = polygonization_box(tree);
    first.check = check_mesh(first.mesh, tree, box, first.check_options);
    if (first.check->faults() == 0) return first;
    MeshSettings finer = settings;
    finer.coarseness *= 0.5;
    // Without a tolerance, half of what a mesh without one is expected to keep.
    constexpr double expected = 0.25;
    finer.tolerance_in_radii = std::min(finer.tolerance_in_radii, 2 * expected);
    finer.tolerance_in_sizes = std::min(finer.tolerance_in_sizes, 1.0);
    try {
        SolidMesh second = polygonize(tree, cut_off, finer, id, cancel, progress);
        second.check_options = first.check_options;
        second.check = check_mesh(second.mesh, tree, box, second.check_options);
        if (second.check->faults() < first.check->faults()) std::swap(first, second);
    } catch (const UnsupportedError&) {  // it cannot be made so fine
    } catch (const WorkError&) {
    }
    first.made_again = true;
    return first;
}

// "solid 3 (floor) is", "solids 3 (floor), 5 are"
std::string listed(const Scene& scene, const std::vector<std::size_t>& solids) {
    constexpr std::size_t most = 10;
    std::string all = solids.size() == 1 ? "solid" : "solids";
    for (std::size_t k = 0; k < std::min(most, solids.size()); ++k) {
        const std::string name = solids[k] < scene.names.size() ? scene.names[solids[k]] : "";
        all += fmt::format("{} {}{}", k == 0 ? "" : ",", solids[k] + 1, name.empty() ? "" : " (" + name + ")");
    }
    if (solids.size() > most) all += fmt::format(" and {} more", solids.size() - most);
    return all + (solids.size() == 1 ? " is" : " are");
}

// Which solids get a mesh. Appends a warning about unbounded solids that are left out.
std::vector<char> wanted_solids(const Scene& scene, const std::vector<Box>& boxes, const MeshSettings& settings,
                                std::vector<std::string>& warnings) {
    std::vector<char> wanted(scene.solids.size(), settings.only.empty());
    for (const std::size_t i : settings.only) wanted.at(i) = true;
    if (!settings.leave_out_unbounded) return wanted;
    std::vector<std::size_t> left_out;
    for (std::size_t i = 0; i < wanted.size(); ++i)
        if (wanted[i] && !finite(boxes[i])) {
            left_out.push_back(i);
            wanted[i] = false;
        }
    if (left_out.empty()) return wanted;
    const std::string what =
        fmt::format("{} unbounded and left out; --only {} cuts {} off and writes {}", listed(scene, left_out),
                    left_out.size() == 1 ? fmt::format("{}", left_out[0] + 1) : "NAME or ID",
                    left_out.size() == 1 ? "it" : "one", "it");
    if (std::none_of(wanted.begin(), wanted.end(), [](char w) { return w; })) throw UnsupportedError(what);
    warnings.push_back(what);
    return wanted;
}

void add_statistics(SceneMesh& to, const SolidMesh& from) {
    if (from.method && std::find(to.methods.begin(), to.methods.end(), *from.method) == to.methods.end())
        to.methods.push_back(*from.method);
    if (from.method == MeshMethod::triage) {
        to.triage.cells += from.triage.cells;
        to.triage.open_cells += from.triage.open_cells;
        to.triage.rounds = std::max(to.triage.rounds, from.triage.rounds);
    } else if (from.method == MeshMethod::octree) {
        OctreeStatistics& sum = to.octree;
        const OctreeStatistics& one = from.octree;
        sum.level = std::max(sum.level, one.level);
        sum.edge = sum.edge > 0 ? std::min(sum.edge, one.edge) : one.edge;
        sum.range_tests += one.range_tests;
        sum.cells += one.cells;
        sum.open_cells += one.open_cells;
        sum.hard_points += one.hard_points;
        sum.partitions += one.partitions;
        sum.rounds = std::max(sum.rounds, one.rounds);
    }
}

}  // namespace

std::string SceneMesh::method_names() const {
    std::string names;
    for (const MeshMethod m : methods) names += (names.empty() ? "" : ", ") + mesh_method_name(m);
    return names;
}

SceneMesh mesh_parts(const Scene& scene, const MeshSettings& settings, const MeshWatch& watch) {
    SceneMesh result;
    std::vector<Box> boxes;
    for (const Solid& solid : scene.solids) {
        result.trees.push_back(flatten(solid));
        boxes.push_back(bounding_box(result.trees.back()));
    }
    result.near = finite_part(scene, boxes);
    const Vec3 size = result.near.hi - result.near.lo;
    const Box limit = inflated(result.near, settings.reach * std::max(largest(size), 1e-6));
    const std::size_t count = scene.solids.size();
    result.wanted = wanted_solids(scene, boxes, settings, result.warnings);
    const std::vector<char>& wanted = result.wanted;
    for (std::size_t i = 0; i < count; ++i) {
        if (finite(boxes[i]) || !wanted[i]) continue;
        // Cut off on infinite sides only; on the others a margin remains.
        Box margin = inflated(boxes[i], 0.05 * largest(size));
        for (int k = 0; k < 3; ++k) {
            margin.lo[k] = std::isfinite(margin.lo[k]) ? margin.lo[k] : limit.lo[k];
            margin.hi[k] = std::isfinite(margin.hi[k]) ? margin.hi[k] : limit.hi[k];
        }
        result.trees[i] = flatten(scene.solids[i] & Solid::sharp(Density::box(margin.lo, margin.hi)));
        result.warnings.push_back(fmt::format("solid {} is unbounded: its mesh is cut off", i + 1));
    }
    double work = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (wanted[i]) work += work_of(result.trees[i]);
    if (count > 1)
        in_parallel(count, [&](std::size_t i) {
            if (wanted[i]) check_cells(result.trees[i], !finite(boxes[i]), settings, i + 1, watch.cancel);
        });
    std::vector<SolidMesh> parts(count);
    in_parallel(count, [&](std::size_t i) {
        throw_if_cancelled(watch.cancel);
        if (!wanted[i]) return;
        const double share = work_of(result.trees[i]) / work;
        WorkProgress progress([&](double done) {
            if (watch.done) watch.done(share * done);
        });
        parts[i] = polygonize_checked(result.trees[i], !finite(boxes[i]), settings, i + 1, watch.cancel, progress);
        progress.finish();
    });
    for (std::size_t i = 0; i < count; ++i) {
        add_statistics(result, parts[i]);
        if (wanted[i] && parts[i].mesh.triangles.empty())
            result.warnings.push_back(fmt::format("solid {} is not in the mesh: it is empty{}", i + 1,
                                                  parts[i].method ? ", or thinner than the mesh is fine" : ""));
        result.check_options.push_back(parts[i].check_options);
        result.made_again += parts[i].made_again;
        if (settings.check) result.checks.push_back(parts[i].check.value_or(MeshCheck{}));
        result.tolerances.push_back(parts[i].tolerance);
        result.parts.push_back(std::move(parts[i].mesh));
    }
    return result;
}

void join_parts(SceneMesh& mesh) {
    mesh.mesh = {};
    for (std::size_t i = 0; i < mesh.parts.size(); ++i) mesh.mesh.append(mesh.parts[i], int(i));
    separate_touching(mesh.mesh);
    auto moved = mesh.mesh.positions.begin();
    for (Mesh& part : mesh.parts)
        for (Vec3& x : part.positions) x = *moved++;
}

SceneMesh mesh_scene(const Scene& scene, const MeshSettings& settings, const MeshWatch& watch) {
    SceneMesh mesh = mesh_parts(scene, settings, watch);
    join_parts(mesh);
    return mesh;
}

std::vector<MeshMetrics> measure_parts(const SceneMesh& mesh) {
    std::vector<MeshMetrics> all;
    for (std::size_t i = 0; i < mesh.parts.size(); ++i) all.push_back(measure(mesh.parts[i], mesh.trees[i]));
    return all;
}

}  // namespace deburr
