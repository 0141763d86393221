#include "polygonizer/triage/triage.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "bounds/bounding_box.hpp"
#include "bounds/sort_once.hpp"
#include "polygonizer/mesh/decimate.hpp"
#include "polygonizer/mesh/degenerate_shells.hpp"
#include "polygonizer/mesh/patches.hpp"
#include "polygonizer/mesh/refine.hpp"
#include "polygonizer/mesh/separate_touching.hpp"
#include "polygonizer/mesh/sharp_parts.hpp"
#include "polygonizer/mesh/simplify_borders.hpp"
#include "polygonizer/triage/mend.hpp"
#include "polygonizer/triage/rounds.hpp"
#include "polygonizer/triage/surface.hpp"

namespace deburr {

Box polygonization_box(const SolidTree& solid) {
    Box box = bounding_box(solid);
    if (box.empty()) return box;
    double size = 0;
    for (int k = 0; k < 3; ++k)
        if (std::isfinite(box.hi[k] - box.lo[k])) size = std::max(size, box.hi[k] - box.lo[k]);
    if (size == 0) size = 1;
    // An infinite side is placed this many sizes away from what is finite.
    constexpr double reach = 10;
    for (int k = 0; k < 3; ++k) {
        const bool lo = std::isfinite(box.lo[k]), hi = std::isfinite(box.hi[k]);
        if (!lo && !hi)
            box.lo[k] = -reach * size, box.hi[k] = reach * size;
        else if (!lo)
            box.lo[k] = box.hi[k] - reach * size;
        else if (!hi)
            box.hi[k] = box.lo[k] + reach * size;
        else {
            box.lo[k] -= 0.05 * size;
            box.hi[k] += 0.05 * size;
        }
    }
    return box;
}

namespace {

// The fraction of a tolerance within which cells are polygonized as flat, because decimation would make them flat
// again.
constexpr double of_slack = 0.4;

// Replaces `at_points` for a mesh for pictures, whose normals have to be right between its vertices.
constexpr double at_points_of_picture = 0.2;

// Appends boxes around the triangle's corners, each as large as its shortest edge.
void add_corners(const Mesh& mesh, const Triangle& triangle, std::vector<Box>& boxes) {
    const std::array<Vec3, 3> x = mesh.corners(triangle);
    const double shortest = std::min({glm::length(x[0] - x[1]), glm::length(x[1] - x[2]), glm::length(x[2] - x[0])});
    for (const Vec3& corner : x) boxes.push_back(inflated(Box{corner, corner}, 0.5 * shortest));
}

constexpr std::size_t max_mending_rounds = 8, max_fine_rounds = 6;

// The rounds that lead to the mesh of one solid. Every whole round polygonizes all cells, after some were halved. Where
// nothing has changed since the round before, facets stay as they were refined and mended.
class Triage {
public:
    /// No leaf of `solid` is both sharp and rounded (sharp_parts.hpp).
    Triage(const SolidTree& solid, const Box& box, const TriageOptions& options)
        : options_(options),
          solid_(solid),
          thin_out_(options.decimate && std::isfinite(options.tolerance)),
          near_((options.decimate ? at_points : at_points_of_picture) * options.tolerance),
          slack_(thin_out_ ? of_slack * options.tolerance : 0),
          subdivision_(solid, box, subdivision_options()),
          // A limit of cells, because where surfaces nearly touch, halves of cells may stay too far for ever.
          local_(subdivision_, solid, slack_, 8 * subdivision_.complex.cells.size() + 20'000, options.cancel) {}

    Mesh run() {
        while (mending_ < max_mending_rounds) {
            throw_if_cancelled(options_.cancel);
            polygonize();
            if (!cut_leaning() && !refine() && finish()) break;
        }
        simplify_borders(best_.mesh, best_.origins, *judge_, best_.farthest);
        merge_close(best_.mesh);
        return std::move(best_.mesh);
    }

    TriageStatistics statistics() const {
        TriageStatistics s{subdivision_.complex.cells.size(), 0, whole_rounds_};
        for (const int node : subdivision_.node_of) s.open_cells += subdivision_.nodes[node].side == Side::straddling;
        return s;
    }

private:
    // Begins a phase of the progress. Fractions of what is left are those of most models.
    void begin(double share) const {
        if (options_.progress) options_.progress->begin(share);
    }

    SubdivisionOptions subdivision_options() const {
        begin(0.25);
        return {options_.max_half_spaces, options_.cancel, options_.progress};
    }

    void polygonize() {
        begin(0.15);
        Subspace subspace(subdivision_, slack_);
        subspace.polygonize();
        origins_.clear();
        mesh_ = surface(subspace, solid_, &origins_);
        ++whole_rounds_;
        ++rounds_;
    }

    // The number of rounds left in which cells may be halved.
    std::size_t rounds_left() const {
        const std::size_t max_rounds = std::isfinite(options_.tolerance) ? 6 : 5;
        return max_rounds > rounds_ && local_.may_halve() ? max_rounds - rounds_ : 0;
    }

    // Without a tolerance: cuts cells whose triangles lean. Returns whether any was cut.
    bool cut_leaning() {
        if (rounds_left() == 0 || std::isfinite(options_.tolerance)) return false;
        const std::size_t times = local_.cut_leaning(cells_to_halve(mesh_, origins_, subdivision_), rounds_left());
        if (times > 0) rounds_ += times - 1;
        return times > 0;
    }

    // Refines the mesh within its cells, and cuts cells where that does not help. Returns whether any was cut.
    bool refine() {
        if (!judge_) judge_.emplace(solid_, mesh_);
        drop_flat_shells(mesh_, origins_, 10 * subdivision_.complex.tolerance, judge_->solid());
        std::vector<int> left, wrong;
        std::vector<Cut> far;
        Patches patches;
        if (std::isfinite(options_.tolerance)) {
            begin(0.2);
            patches = refined_ ? refined_->patches.put_into(mesh_, origins_, refined_->mesh, refined_->origins,
                                                            refined_->wrong)
                               : Patches(mesh_, origins_);
            refined_.reset();
            left = deburr::refine(mesh_, origins_, *judge_, near_, options_.cancel, &good_, &patches);
            // Triangles that halving does not help are judged again at the end, by the tolerance itself.
            if (rounds_left() > 0) far = local_.hopeful_far(cells_to_halve(mesh_, origins_, left, subdivision_));
        }
        if (thin_out_) {
            // Facets that lean are mended first, while there are small facets to mend them with. Smaller cells for
            // those that cannot be mended cost less before the rest is decimated, as long as they help.
            wrong = wrong_before_decimation(mesh_, origins_, *judge_, options_.tolerance, left, options_.cancel, &good_,
                                            &patches);
        }
        std::vector<Cut> around_wrong = cuts_around(wrong, far);
        const bool cut =
            !far.empty() && local_.cut_far(far, *judge_, near_, left.size(), thin_out_ ? options_.tolerance : infinity);
        bool mended = mend_cells(std::move(around_wrong), wrong.size());
        // Planes may miss all cells that were to be cut. A decimated mesh would be wrong there.
        if (!far.empty() && !cut && !mended) mended = mend_cells(cuts_around(wrong, {}), wrong.size());
        mending_ += mended;
        const bool again = cut || mended;
        if (std::isfinite(options_.tolerance)) {
            refined_ = again ? Refined{std::move(mesh_), std::move(origins_)} : Refined{mesh_, origins_};
            refined_->wrong = std::move(thin_out_ ? wrong : left);
            refined_->patches = std::move(patches);
        }
        if (again) know_good();
        return again;
    }

    // Cuts around triangles found by wrong_before_decimation(), except beside the cells of `others`.
    std::vector<Cut> cuts_around(const std::vector<int>& wrong, const std::vector<Cut>& others) const {
        if (wrong.empty() || mending_ >= max_fine_rounds || !local_.may_halve()) return {};
        return without_neighbours(local_.hopeful_wrong(cells_around(mesh_, origins_, wrong, subdivision_)), others,
                                  subdivision_.complex);
    }
    bool mend_cells(std::vector<Cut> cuts, std::size_t wrong) {
        return !cuts.empty() && local_.mend(std::move(cuts), *judge_, options_.tolerance, wrong);
    }

    // Facets of the refined mesh that are not wrong are good.
    void know_good() {
        if (!refined_) return;
        good_.become(refined_->mesh, refined_->origins, refined_->wrong);
        local_.know(good_);
    }

    // Decimates and repairs the mesh. Facets that this cannot help need smaller cells; false if such were made.
    bool finish() {
        if (thin_out_) {
            begin(0.8);
            decimate(mesh_, origins_, *judge_, at_points * options_.tolerance,
                     {.dense = dense_, .cancel = options_.cancel, .progress = options_.progress});
        }
        ++mending_;
        std::vector<Cut> cuts[2];
        const bool crosses = mend_both_ways(cuts);
        if (best_.is_right() || !local_.may_halve()) return true;
        const bool any =
            !halve_all(subdivision_, cuts[0], crosses).empty() || !halve_all(subdivision_, cuts[1], crosses).empty();
        if (!any && !thin_out_) return true;
        for (const int t : best_.wrong) add_corners(best_.mesh, best_.mesh.triangles[t], dense_);
        know_good();
        return false;
    }

    // Repairs the mesh with splits and, if that is not enough, without; `cuts` become the cuts that would help each.
    // Returns whether facets cross in either.
    bool mend_both_ways(std::vector<Cut> (&cuts)[2]) {
        begin(0.3);
        bool crosses = false;
        for (const bool may_split : {true, false}) {
            MendedMesh mended = mend(mesh_, origins_, *judge_, options_.tolerance, may_split, options_.cancel);
            cuts[may_split] = cells_around(mended.mesh, mended.origins, mended.wrong, subdivision_);
            crosses |= mended.crosses;
            if (mended.is_better_than(best_)) best_ = std::move(mended);
            if (best_.is_right()) break;
        }
        return crosses;
    }

    // The mesh of a whole round before it was decimated.
    struct Refined {
        Mesh mesh;
        std::vector<Origin> origins;
        std::vector<int> wrong = {};
        Patches patches = {};  // the patches that led to it
    };

    const TriageOptions& options_;
    const SolidTree& solid_;
    const bool thin_out_;
    const double near_, slack_;  // distance that refine() allows; slack of Subspace
    Subdivision subdivision_;
    LocalRounds local_;
    Mesh mesh_;  // of the current round
    std::vector<Origin> origins_;
    MendedMesh best_;
    std::optional<FacetJudge> judge_;
    std::optional<Refined> refined_;  // of the last round
    GoodFacets good_;                 // in the mesh of refined_
    std::size_t rounds_ = 0, whole_rounds_ = 0, mending_ = 0;
    std::vector<Box> dense_;  // where a decimated mesh was wrong
};

}  // namespace

Mesh triage(const SolidTree& mixed, const Box& box, const TriageOptions& options, TriageStatistics* statistics) {
    if (box.empty()) return {};
    const SolidTree solid = separate_sharp(mixed);
    Triage work(solid, box, options);
    Mesh mesh = work.run();
    if (statistics) *statistics = work.statistics();
    return mesh;
}

}  // namespace deburr
