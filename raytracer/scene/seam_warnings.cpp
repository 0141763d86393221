#include "raytracer/scene/seam_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "bounds/canonical_solids.hpp"
#include "bounds/tangent_seams.hpp"

namespace deburr {
namespace {

// Larger densities are not examined, nor more of them than this, so that the time is not noticeable.
constexpr double max_seam_leaves = 500;
constexpr std::size_t max_densities = 100;

std::string place_of(Vec3 x) {
    const auto rounded = [](double v) { return std::abs(v) < 1e-12 ? 0.0 : v; };
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", rounded(x.x), rounded(x.y), rounded(x.z));
}

}  // namespace

std::vector<std::string> seam_warnings(const Scene& scene) {
    std::vector<std::string> lines;
    std::unordered_set<const SolidNode*> met;
    CanonicalSolids canonical;
    std::unordered_set<int> seen;
    for_each_leaf(
        scene.solids, [&](const SolidNode& node) { return met.insert(&node).second; },
        [&](const Solid& leaf, const Affine& map) {
            const SolidNode& node = leaf.node();
            if (node.field() || node.convolved() || !node.density().node().has_round) return;
            if (node.leaves > max_seam_leaves || seen.size() >= max_densities || even_scale(map) == 0) return;
            if (!seen.insert(canonical.of(leaf).canonical).second) return;
            const std::vector<TangentSeam> seams = tangent_seams(flatten(node.density(), node.radius(), map));
            if (seams.empty()) return;
            const TangentSeam& worst =
                *std::max_element(seams.begin(), seams.end(),
                                  [](const TangentSeam& a, const TangentSeam& b) { return a.bulge < b.bulge; });
            const std::size_t more = seams.size() - 1;
            lines.push_back(
                fmt::format("{}: a round part runs on smoothly into another surface and bulges there by {:.2g}, {:.2g} "
                            "of the radius, "
                            "at {}{}",
                            scene.place(node.line), worst.bulge, worst.bulge / worst.radius, place_of(worst.at),
                            more == 0   ? ""
                            : more == 1 ? "; and in one more place"
                                        : fmt::format("; and in {} more places", more)));
        });
    return lines;
}

}  // namespace deburr
