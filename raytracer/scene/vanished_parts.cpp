#include "raytracer/scene/vanished_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "bounds/bounding_box.hpp"
#include "bounds/canonical_solids.hpp"
#include "bounds/decision_diagram.hpp"
#include "bounds/density_part.hpp"
#include "bounds/emptiness.hpp"
#include "raytracer/scene/box_text.hpp"
#include "raytracer/scene/thin_walls.hpp"

namespace deburr {
namespace {

// Larger solids are not looked at: nothing of them fits into the time.
constexpr double max_leaves = 3'000;
// Halvings in search of the largest radius that keeps a part: three digits of it.
constexpr int halvings = 12;
// Points along each side of a part's box where it is compared with the whole.
constexpr int points_along = 12;

double rounded_down(double x) {
    const double unit = std::pow(10.0, std::floor(std::log10(x)) - 2);
    return std::floor(x / unit) * unit;
}

DensityTree sharpened(DensityTree tree) {
    for (HalfSpace& h : tree.half_spaces) h.radius = 0;
    return tree;
}

// A rounded density where it is placed first.
class Leaf {
public:
    Leaf(const SolidNode& node, const Affine& map, std::int64_t& nodes) : node_(node), map_(map), nodes_(nodes) {
        whole_ = rounded(node.radius());
        parts_ = summands(whole_);
        for (const int part : parts_) sharp_parts_.push_back(sharpened(part_below(whole_, part)));
    }

    // What to say of each part that vanishes, but for the place.
    std::vector<std::string> vanished() {
        std::vector<std::string> said;
        for (std::size_t i = 0; i < parts_.size() && nodes_ > 0; ++i) {
            const Box box = bounding_box(sharp_parts_[i]);
            if (box.empty() || !box.finite() || !vanishes(i, box)) continue;
            const auto kept = [&](double r) {
                return emptiness(part_below(rounded(r), parts_[i]), box, nodes_) == Emptiness::not_empty;
            };
            said.push_back((parts_.size() > 1 ? fmt::format("a part in {}", box_text(box)) : "it") + at_radius(kept));
        }
        return said;
    }

private:
    DensityTree rounded(double r) const { return flatten(node_.density(), r, map_); }

    // Errs towards yes.
    bool is_kept(const DensityTree& tree, const Box& box) { return emptiness(tree, box, nodes_) != Emptiness::empty; }

    // It has a volume, none when it is rounded alone, and its neighbours do not hold it either.
    bool vanishes(std::size_t i, const Box& box) {
        const DensityTree alone = part_below(whole_, parts_[i]);
        if (is_kept(alone, box) || emptiness(sharp_parts_[i], box, nodes_) != Emptiness::not_empty) return false;
        nodes_ -= points_along * points_along * points_along * std::int64_t(sharp_parts_[i].nodes.size());
        bool own = parts_.size() == 1;
        for (int n = 0; n < points_along * points_along * points_along; ++n) {
            const Vec3 at(n % points_along, n / points_along % points_along, n / points_along / points_along);
            const Vec3 x = glm::mix(box.lo, box.hi, (at + 0.5) / double(points_along));
            if (!(sharp_parts_[i].at(x) > 0.5) || in_another(i, x)) continue;
            own = true;
            nodes_ -= std::int64_t(whole_.nodes.size());
            if (whole_.at(x) > 0.5) return false;
        }
        return own;
    }

    bool in_another(std::size_t i, Vec3 x) {
        for (std::size_t k = 0; k < sharp_parts_.size(); ++k) {
            if (k == i) continue;
            nodes_ -= std::int64_t(sharp_parts_[k].nodes.size());
            if (sharp_parts_[k].at(x) > 0.5) return true;
        }
        return false;
    }

    template <class Kept>
    std::string at_radius(Kept kept) const {
        const double radius = node_.radius();
        std::string text = fmt::format(" vanishes at radius {:.4g}", radius);
        double low = 0, high = radius;
        for (int i = 0; i < halvings; ++i) {
            const double middle = 0.5 * (low + high);
            (kept(middle) ? low : high) = middle;
        }
        // Radii that are fixed for some faces may leave none.
        return low > 0 ? text + fmt::format("; up to {:.3g} it stays", rounded_down(low)) : text;
    }

    const SolidNode& node_;
    const Affine map_;
    std::int64_t& nodes_;
    DensityTree whole_;
    std::vector<int> parts_;
    std::vector<DensityTree> sharp_parts_;
};

// What to say of a model's walls that vanish, but for the place; nothing if there are none.
std::string thin_walls_text(const MeshField& model, const Affine& map) {
    const ThinWalls walls = thin_walls(model);
    if (walls.facets == 0) return {};
    const double scale = std::cbrt(std::abs(glm::determinant(map.linear))), thickness = scale * walls.thickness;
    const Vec3 at = map(walls.place);
    return fmt::format(
        "walls behind {} facet{} vanish at radius {:.4g}, the thinnest {:.4g} thick near ({:.4g}, {:.4g}, {:.4g}); up "
        "to "
        "{:.3g} they stay",
        walls.facets, walls.facets == 1 ? "" : "s", scale * model.filter_radius(), thickness, at.x, at.y, at.z,
        rounded_down(thickness / vanishing_thickness));
}

// Errs towards no.
bool is_empty(const Solid& solid, std::int64_t& nodes) {
    if (solid.node().leaves > max_leaves || nodes <= 0) return false;
    const SolidTree tree = flatten(solid);
    const Box box = bounding_box(tree);
    return box.empty() || (box.finite() && emptiness(tree, box, nodes) == Emptiness::empty);
}

}  // namespace

VanishedParts vanished_parts(const Scene& scene, std::int64_t nodes) {
    VanishedParts result;
    std::unordered_set<const SolidNode*> met;
    CanonicalSolids canonical;
    std::unordered_set<int> seen;
    for (std::size_t i = 0; i < scene.solids.size() && nodes > 0; ++i) {
        const Solid& solid = scene.solids[i];
        const std::string name = scene.names[i].empty() ? "" : fmt::format(" ({})", scene.names[i]);
        const auto said = [&](int line, const std::string& what) {
            return fmt::format("{}: solid {}{}: {}", scene.place(line), i + 1, name, what);
        };
        int first_line = 0;
        bool told = false;
        const auto look = [&](const Solid& leaf, const Affine& map) {
            const SolidNode& node = leaf.node();
            if (first_line == 0) first_line = node.line;
            const auto* model = dynamic_cast<const MeshField*>(node.field().get());
            if (model && seen.insert(canonical.of(leaf).canonical).second) {
                const std::string what = thin_walls_text(*model, map);
                if (what.empty()) return;
                result.rounded_away.push_back(said(node.line, what));
                told = true;
            }
            if (node.field() || node.convolved() || node.radius() == 0 || node.leaves > max_leaves) return;
            if (!seen.insert(canonical.of(leaf).canonical).second) return;
            for (const std::string& what : Leaf(node, map, nodes).vanished()) {
                result.rounded_away.push_back(said(node.line, what));
                told = true;
            }
        };
        try {
            for_each_leaf(
                {solid}, [&](const SolidNode& node) { return nodes > 0 && met.insert(&node).second; }, look);
            if (!is_empty(solid, nodes)) continue;
        } catch (const TooEntangled&) {  // it is told when it is rendered
            continue;
        }
        if (!told) result.empty.push_back(said(first_line, "it is empty: & or - leaves nothing of it"));
    }
    return result;
}

bool nothing_is_left(const Scene& scene, std::int64_t nodes) {
    try {
        return std::all_of(scene.solids.begin(), scene.solids.end(),
                           [&](const Solid& solid) { return is_empty(solid, nodes); });
    } catch (const TooEntangled&) {
        return false;
    }
}

}  // namespace deburr
