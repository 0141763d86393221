#include "raytracer/mesh/face_count.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "bounds/in_parallel.hpp"
#include "polygonizer/mesh/decimate.hpp"
#include "polygonizer/mesh/sharp_parts.hpp"
#include "polygonizer/triage/triage.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

// A mesh with up to this fraction fewer triangles than wanted is accepted.
constexpr double tolerated_lack = 0.1;

std::size_t count_triangles(const SceneMesh& mesh) {
    std::size_t count = 0;
    for (const Mesh& part : mesh.parts) count += part.triangles.size();
    return count;
}

// The leaf whose surface each triangle approximates: the one nearest to its middle; none for smooth triangles.
std::vector<Origin> origins_of(const Mesh& mesh, const FacetJudge& judge) {
    std::vector<Origin> origins;
    for (const Triangle& t : mesh.triangles) {
        Origin& origin = origins.emplace_back();
        if (t.normal[0] == t.normal[1] && t.normal[0] == t.normal[2]) continue;
        Vec3 middle(0.0);
        for (const int v : t.vertex) middle += mesh.positions[v] / 3.0;
        origin.leaf = judge.solid().at(middle).leaf;
    }
    return origins;
}

// The farthest distance from a solid's surface at which points still tell where the surface is: about a radius.
double max_told(const SolidTree& solid, const Mesh& mesh) {
    double farthest = 0;
    for (const SolidLeaf& leaf : solid.leaves) {
        for (const HalfSpace& h : leaf.density.half_spaces) farthest = std::max(farthest, h.radius);
        if (leaf.field) farthest = std::max(farthest, mean_edge(mesh));
    }
    return farthest;
}

// The largest distance of the middles of triangles and edges from the surface, as far as they can tell.
double largest_distance(const Mesh& mesh, const SolidTree& solid) {
    const double reach = max_told(solid, mesh);
    const DistanceField field(solid, inflated(field_box(mesh), reach), reach);
    double largest = 0;
    for (const Triangle& t : mesh.triangles) {
        const std::array<Vec3, 3> x = mesh.corners(t);
        for (const Vec3& p :
             {(x[0] + x[1] + x[2]) / 3.0, 0.5 * (x[0] + x[1]), 0.5 * (x[1] + x[2]), 0.5 * (x[2] + x[0])})
            if (const double d = field.distance_along_normal(p, reach); std::isfinite(d))
                largest = std::max(largest, d);
    }
    return largest;
}

// One solid's mesh while it is thinned out.
class Thinning {
public:
    Thinning(Mesh& mesh, const SolidTree& solid, double tolerance) : mesh_(mesh), solid_(separate_sharp(solid)) {
        if (mesh.triangles.empty()) return;
        judge_.emplace(solid_, mesh);
        origins_ = origins_of(mesh, *judge_);
        // Triage thins out to this fraction of its tolerance; a mesh without a tolerance begins far below its edges'
        // length.
        constexpr double share = 0.85, start = 0.01;
        tolerance_ = std::isfinite(tolerance) ? share * tolerance : start * mean_edge(mesh);
        look_far();
    }

    std::size_t size() const { return mesh_.triangles.size(); }
    bool can_thin(double coarseness) const { return judge_ && coarseness * tolerance_ <= max_distance_; }
    void thin(double coarseness, std::size_t enough, CancelFlag cancel) {
        if (!can_thin(coarseness)) return;
        reached_ = coarseness * tolerance_;
        decimate(mesh_, origins_, *judge_, reached_, {.enough = enough, .cancel = cancel});
    }
    /// Saves the mesh before it is thinned out further.
    void save() {
        saved_.push_back({mesh_, origins_, reached_});
        if (judge_ && solid_.has_free_form()) look_far();
    }
    /// Restores the mesh that was saved last, and forgets it; false if there is none.
    bool restore() {
        if (saved_.empty()) return false;
        std::tie(mesh_, origins_, reached_) = std::move(saved_.back());
        saved_.pop_back();
        return true;
    }
    /// The options with their tolerance raised to the distance that the mesh may have now.
    MeshCheckOptions checked(MeshCheckOptions options) const {
        constexpr double slack = 3;  // points between those that collapses test are farther away
        double& tolerance = std::isfinite(options.tolerance) ? options.tolerance : options.min_tolerance;
        tolerance = std::max(tolerance, slack * reached_);
        return options;
    }

private:
    // Renews the judge, because free forms are known as far from the surface as the mesh's edges are long.
    void look_far() {
        judge_.emplace(solid_, mesh_);
        max_distance_ = std::max(max_told(solid_, mesh_), tolerance_);
    }

    Mesh& mesh_;
    SolidTree solid_;
    std::optional<FacetJudge> judge_;
    std::vector<Origin> origins_;
    double tolerance_ = 0, max_distance_ = 0, reached_ = 0;
    std::vector<std::tuple<Mesh, std::vector<Origin>, double>> saved_;
};

// All solids' meshes while they are thinned out.
class SceneThinning {
public:
    SceneThinning(SceneMesh& mesh, CancelFlag cancel) : mesh_(mesh), cancel_(cancel) {
        parts_.reserve(mesh.parts.size());
        for (std::size_t i = 0; i < mesh.parts.size(); ++i)
            parts_.push_back(std::make_unique<Thinning>(mesh.parts[i], mesh.trees[i], mesh.tolerances[i]));
    }

    /// Thins out to at most `faces` triangles, if possible.
    void thin(std::size_t faces) {
        const double step = std::sqrt(2.0);
        for (double coarseness = step; count() > faces; coarseness *= step) {
            if (std::none_of(parts_.begin(), parts_.end(), [&](const auto& p) { return p->can_thin(coarseness); }))
                return;
            std::vector<std::size_t> before, enough(parts_.size(), 0);
            for (const auto& part : parts_) {
                before.push_back(part->size());
                part->save();
            }
            thin(coarseness, enough);
            if (count() > faces) continue;
            // Too few are left: repeats the step, with the same fraction for each part.
            const std::size_t all = sum(before), excess = all - faces, gone = all - count();
            for (std::size_t i = 0; i < parts_.size(); ++i) {
                const double share = double(before[i] - parts_[i]->size()) * double(excess) / double(gone);
                enough[i] = before[i] - std::size_t(std::ceil(share));
                parts_[i]->restore();
                parts_[i]->save();
            }
            thin(coarseness, enough);
        }
    }

    /// Checks all parts. A part that fails is set back to an earlier, less thinned state, as often as needed.
    void check() {
        mesh_.checks.assign(parts_.size(), {});
        in_parallel(parts_.size(), [&](std::size_t i) {
            if (mesh_.wanted[i]) do {
                    const SolidTree& tree = mesh_.trees[i];
                    mesh_.checks[i] = check_mesh(mesh_.parts[i], tree, polygonization_box(tree),
                                                 parts_[i]->checked(mesh_.check_options[i]));
                } while (mesh_.checks[i].faults() > 0 && parts_[i]->restore());
        });
    }

private:
    static std::size_t sum(const std::vector<std::size_t>& counts) {
        std::size_t all = 0;
        for (const std::size_t n : counts) all += n;
        return all;
    }
    std::size_t count() const { return count_triangles(mesh_); }
    void thin(double coarseness, const std::vector<std::size_t>& enough) {
        in_parallel(parts_.size(), [&](std::size_t i) { parts_[i]->thin(coarseness, enough[i], cancel_); });
    }

    SceneMesh& mesh_;
    CancelFlag cancel_;
    std::vector<std::unique_ptr<Thinning>> parts_;
};

// Meshes at smaller and smaller tolerances or cells until there are enough triangles. `asked` gets the tolerances that
// the solids have at first.
SceneMesh fine_enough(const Scene& scene, MeshSettings settings, std::size_t faces, CancelFlag cancel,
                      std::vector<double>& asked) {
    constexpr int max_halvings = 12;
    constexpr int max_idle = 2;  // halvings that add next to nothing: no more triangles are to be had
    constexpr double next_to_nothing = 1.01;
    SceneMesh mesh = mesh_parts(scene, settings, {cancel, {}});
    asked = mesh.tolerances;
    int idle = 0;
    for (int k = 0; k < max_halvings && idle < max_idle; ++k) {
        const std::size_t count = count_triangles(mesh);
        if (double(count) >= (1 - tolerated_lack) * double(faces)) break;
        settings.coarseness *= 0.5;
        try {
            SceneMesh finer = mesh_parts(scene, settings, {cancel, {}});
            idle = double(count_triangles(finer)) < next_to_nothing * double(count) ? idle + 1 : 0;
            if (count_triangles(finer) > count) mesh = std::move(finer);
        } catch (const UnsupportedError&) {  // it cannot be made so fine
            break;
        }
    }
    return mesh;
}

// Warns of the solid that is farthest from its surface, relative to its tolerance if it has one; no warning if all keep
// theirs.
void warn_of_distance(SceneMesh& mesh, const std::vector<double>& asked) {
    std::vector<double> distances(mesh.parts.size(), 0);
    in_parallel(mesh.parts.size(),
                [&](std::size_t i) { distances[i] = largest_distance(mesh.parts[i], mesh.trees[i]); });
    std::optional<std::size_t> worst;
    const auto measure = [&](std::size_t i) {
        return std::isfinite(asked[i]) ? std::pair{true, distances[i] / asked[i]} : std::pair{false, distances[i]};
    };
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const bool kept = std::isfinite(asked[i]) ? distances[i] <= asked[i] : distances[i] == 0;
        if (!kept && (!worst || measure(i) > measure(*worst))) worst = i;
    }
    if (!worst) return;
    mesh.warnings.push_back(
        fmt::format("--faces: the mesh of solid {} is up to {:.3g} from its surface{}", *worst + 1, distances[*worst],
                    std::isfinite(asked[*worst]) ? fmt::format(", and its tolerance is {:.3g}", asked[*worst]) : ""));
}

void warn_of_count(SceneMesh& mesh, std::size_t faces) {
    const std::size_t count = count_triangles(mesh);
    if (count > faces)
        mesh.warnings.push_back(
            fmt::format("--faces: expected at most {} triangles, and {} are the fewest found", faces, count));
    else if (double(count) < (1 - tolerated_lack) * double(faces))
        mesh.warnings.push_back(
            fmt::format("--faces: expected up to {} triangles, and {} are the most found", faces, count));
}

// The mesh thinned out to at most `faces` triangles, and checked if wanted.
SceneMesh thinned(SceneMesh mesh, std::size_t faces, bool check, CancelFlag cancel) {
    SceneThinning thinning(mesh, cancel);
    thinning.thin(faces);
    if (check) thinning.check();
    return mesh;
}

// Meshes by triage, or by the method that each solid needs, to the wanted number of triangles.
SceneMesh by_tolerance(const Scene& scene, MeshSettings settings, std::size_t faces, CancelFlag cancel) {
    if (!std::isfinite(settings.tolerance) && !std::isfinite(settings.tolerance_in_radii))
        settings.triage_tolerance_in_radii = std::min(settings.triage_tolerance_in_radii, default_tolerance_in_radii);
    const bool check = std::exchange(settings.check, false);
    std::vector<double> asked;
    SceneMesh mesh = fine_enough(scene, settings, faces, cancel, asked);
    const bool too_many = count_triangles(mesh) > faces;
    mesh = thinned(std::move(mesh), faces, check, cancel);
    if (too_many) warn_of_distance(mesh, asked);
    return mesh;
}

// Meshes by even cells of one size, to the wanted number of triangles. The number changes in steps, of more than a
// tenth where it is small, so a mesh with slightly too many triangles is thinned out.
SceneMesh by_cells(const Scene& scene, MeshSettings settings, std::size_t faces, CancelFlag cancel) {
    constexpr int max_rounds = 12;
    constexpr double near_enough = 0.99, aim = 0.995;  // fractions of the wanted number
    constexpr double max_step = 16, min_slope = 0.5, max_slope = 4;
    const bool check = std::exchange(settings.check, false);
    std::optional<SceneMesh> below, above;  // the meshes closest to the wanted number
    double coarse = infinity, fine = 0;     // and the coarseness of their cells
    // The number of triangles grows with the inverse square of lengths; near the wanted number the last two meshes tell
    // better.
    double slope = 2, last_coarseness = 0, last_count = 0;
    for (int round = 0; round < max_rounds; ++round) {
        SceneMesh mesh = mesh_parts(scene, settings, {cancel, {}});
        const double coarseness = settings.coarseness, count = double(std::max<std::size_t>(count_triangles(mesh), 1));
        if (last_count > 0 && count != last_count && coarseness != last_coarseness)
            slope = std::clamp(-std::log(count / last_count) / std::log(coarseness / last_coarseness), min_slope,
                               max_slope);
        last_coarseness = coarseness;
        last_count = count;
        if (count > double(faces)) {
            fine = std::max(fine, coarseness);
            if (!above || count < double(count_triangles(*above))) above = std::move(mesh);
        } else {
            coarse = std::min(coarse, coarseness);
            if (!below || count > double(count_triangles(*below))) below = std::move(mesh);
            if (count >= near_enough * double(faces)) break;
        }
        double next =
            coarseness * std::clamp(std::pow(count / (aim * double(faces)), 1 / slope), 1 / max_step, max_step);
        if (next <= fine || next >= coarse)  // stays between the two, if both are known
            next = fine == 0 ? coarse / 2 : std::isfinite(coarse) ? std::sqrt(fine * coarse) : 2 * fine;
        settings.coarseness = next;
    }
    std::optional<SceneMesh> found;
    const bool is_near = below && double(count_triangles(*below)) >= near_enough * double(faces);
    if (above && !is_near) {
        found = thinned(std::move(*above), faces, check, cancel);
        if (count_triangles(*found) <= faces || !below) return std::move(*found);
    }
    // Cells that are too large lose details.
    SceneMesh mesh = thinned(std::move(*below), faces, check, cancel);
    const bool is_right =
        std::all_of(mesh.checks.begin(), mesh.checks.end(), [](const MeshCheck& c) { return c.faults() == 0; });
    return is_right || !found ? std::move(mesh) : std::move(*found);
}

}  // namespace

SceneMesh mesh_scene_with_faces(const Scene& scene, MeshSettings settings, std::size_t faces, CancelFlag cancel) {
    const bool even_cells = settings.method == MeshMethod::octree || settings.method == MeshMethod::marching_cubes;
    SceneMesh mesh =
        even_cells ? by_cells(scene, settings, faces, cancel) : by_tolerance(scene, settings, faces, cancel);
    warn_of_count(mesh, faces);
    join_parts(mesh);
    return mesh;
}

}  // namespace deburr
