#include "raytracer/scene/vanished_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "bounds/bounding_box.hpp"
#include "bounds/canonical_solids.hpp"
#include "bounds/decision_diagram.hpp"
#include "bounds/density_part.hpp"
#include "bounds/emptiness.hpp"
#include "bounds/selective_mesh_field.hpp"
#include "raytracer/scene/box_text.hpp"
#include "raytracer/scene/thin_walls.hpp"
#include "raytracer/util/count_text.hpp"

namespace deburr {
namespace {

// Larger solids are not examined: nothing would be found in the given time.
constexpr double max_searched_leaves = 3'000;
// Halvings in the search for the largest radius at which a part stays: three digits of it.
constexpr int halvings = 12;
// Most nodes evaluated for one radius to find a point that stays.
constexpr std::int64_t nodes_of_radius = 1'000'000;
// Points along each side of a part's box at which the part is compared with the whole.
constexpr int points_along = 12;
// A plate this many radii thick contains half of a ball around its middle: half of it, u = 2 sin 10°, solves 3u − u³ =
// 1.
constexpr double thinnest_plate = 0.694592;
// A value of a true convolution takes as long as this many nodes for each node of its own, and much longer with more
// leaves than this.
constexpr int nodes_of_convolution = 100;
constexpr double max_convolved_leaves = 100;

double rounded_down(double x) {
    const double unit = std::pow(10.0, std::floor(std::log10(x)) - 2);
    return std::floor(x / unit) * unit;
}

DensityTree sharpened(DensityTree tree) {
    for (HalfSpace& h : tree.half_spaces) h.radius = 0;
    return tree;
}

// Whether the Boolean function of a true convolution lies between two planes that are too close for it. This finds
// plates and small boxes at once; ranges of true convolutions take long.
bool is_thin_plate(const DensityTree& tree) {
    constexpr double parallel = 1e-12;
    std::vector<HalfSpace> between;
    std::vector<int> open{tree.nodes.back().a};
    while (!open.empty()) {
        const TreeNode& n = tree.nodes[open.back()];
        open.pop_back();
        if (n.op == Op::conjunction) open.insert(open.end(), {n.a, n.b});
        if (n.op == Op::half_space && !tree.half_spaces[n.a].round) between.push_back(tree.half_spaces[n.a]);
    }
    for (std::size_t i = 0; i < between.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (largest(between[i].normal + between[k].normal) <= parallel &&
                between[i].offset + between[k].offset < thinnest_plate * between[i].radius)
                return true;
    return false;
}

// A rounded density or a true convolution, as it is placed first.
class Leaf {
public:
    Leaf(const SolidNode& node, const Affine& map, std::int64_t& nodes) : node_(node), map_(map), nodes_(nodes) {
        whole_ = rounded(node.radius());
        parts_ = summands(node.convolved() ? part_below(whole_, whole_.nodes.back().a) : whole_);
        for (const int part : parts_) sharp_parts_.push_back(sharpened(part_below(whole_, part)));
    }

    // The message for each part that vanishes, without the place.
    std::vector<std::string> vanished() {
        std::vector<std::string> said;
        for (std::size_t i = 0; i < parts_.size() && nodes_ > 0; ++i) {
            const Box box = bounding_box(sharp_parts_[i]);
            if (box.empty() || !box.finite() || !vanishes(i, box)) continue;
            const auto kept = [&](double r) { return is_surely_kept(rounded_part(rounded(r), i), box); };
            said.push_back((parts_.size() > 1 ? fmt::format("a part in {}", box_text(box)) : "it") + at_radius(kept));
        }
        return said;
    }

private:
    DensityTree rounded(double r) const {
        return node_.convolved() ? flatten_convolved(node_.density(), r, map_) : flatten(node_.density(), r, map_);
    }

    // Part i of such a tree as if it were alone.
    DensityTree rounded_part(const DensityTree& tree, std::size_t i) const {
        DensityTree part = part_below(tree, parts_[i]);
        if (!node_.convolved()) return part;
        part.nodes.push_back({Op::convolution, part.root()});
        part.ball = tree.ball;
        return part;
    }

    // Whether the tree may keep some volume; if this is not proved either way, true.
    bool is_kept(const DensityTree& tree, const Box& box) {
        if (node_.convolved()) return !is_thin_plate(tree);
        return emptiness(tree, box, nodes_) != Emptiness::empty;
    }

    // Whether the tree surely keeps some volume; if this is not proved, false.
    bool is_surely_kept(const DensityTree& tree, const Box& box) {
        if (node_.convolved()) return some_point(box, [&](Vec3 x) { return value(tree, x) > 0.5; });
        // The work is limited, since beyond the largest such radius there may be no answer.
        const std::int64_t given = std::min(nodes_, nodes_of_radius);
        std::int64_t left = given;
        const Emptiness found = emptiness(tree, box, left);
        nodes_ -= given - left;
        return found == Emptiness::not_empty;
    }

    double value(const DensityTree& tree, Vec3 x) {
        nodes_ -= (node_.convolved() ? nodes_of_convolution : 1) * std::int64_t(tree.nodes.size());
        return tree.at(x);
    }

    // Whether the predicate holds at the box's middle or at a point of a grid in it.
    template <class Predicate>
    static bool some_point(const Box& box, Predicate predicate) {
        if (predicate(0.5 * (box.lo + box.hi))) return true;
        for (int n = 0; n < points_along * points_along * points_along; ++n) {
            const Vec3 at(n % points_along, n / points_along % points_along, n / points_along / points_along);
            if (predicate(glm::mix(box.lo, box.hi, (at + 0.5) / double(points_along)))) return true;
        }
        return false;
    }

    // Whether part i has a volume and none when it is rounded alone, and is not contained in its neighbours either.
    bool vanishes(std::size_t i, const Box& box) {
        const DensityTree alone = rounded_part(whole_, i);
        if (is_kept(alone, box) || emptiness(sharp_parts_[i], box, nodes_) != Emptiness::not_empty) return false;
        bool own = parts_.size() == 1;
        const bool held = some_point(box, [&](Vec3 x) {
            nodes_ -= std::int64_t(sharp_parts_[i].nodes.size());
            if (nodes_ <= 0 || !(sharp_parts_[i].at(x) > 0.5) || in_another(i, x)) return false;
            own = true;
            return value(whole_, x) > 0.5;
        });
        return own && !held && nodes_ > 0;
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
        // Where faces have fixed radii of their own, no radius may keep the part.
        return low > 0 ? text + fmt::format("; up to {:.3g} it stays", rounded_down(low)) : text;
    }

    const SolidNode& node_;
    const Affine map_;
    std::int64_t& nodes_;
    DensityTree whole_;
    std::vector<int> parts_;
    std::vector<DensityTree> sharp_parts_;
};

// The message for a model's walls that vanish, without the place; "" if there are none.
std::string thin_walls_text(const MeshField& model, const Affine& map) {
    const ThinWalls walls = thin_walls(model);
    if (walls.facets == 0) return {};
    const double scale = std::cbrt(std::abs(glm::determinant(map.linear))), thickness = scale * walls.thickness;
    const Vec3 at = map(walls.place);
    return fmt::format(
        "walls behind {} vanish at radius {:.4g}, the thinnest {:.4g} thick near ({:.4g}, {:.4g}, {:.4g}); up "
        "to "
        "{:.3g} they stay",
        count_of(walls.facets, "facet"), scale * model.filter_radius(), thickness, at.x, at.y, at.z,
        rounded_down(thickness / vanishing_thickness));
}

// Whether the solid is proved to be empty.
bool is_empty(const Solid& solid, std::int64_t& nodes) {
    if (solid.node().leaves > max_searched_leaves || nodes <= 0) return false;
    const SolidTree tree = flatten(solid);
    const Box box = bounding_box(tree);
    if (box.empty() || !box.finite()) return box.empty();
    const bool is_convolved = std::any_of(tree.leaves.begin(), tree.leaves.end(), [](const SolidLeaf& leaf) {
        return !leaf.density.nodes.empty() && leaf.density.nodes.back().op == Op::convolution;
    });
    const std::int64_t each = is_convolved ? nodes_of_convolution : 1, given = nodes / each;
    std::int64_t left = given;
    const Emptiness found = emptiness(tree, box, left);
    nodes -= each * (given - left);
    return found == Emptiness::empty;
}

}  // namespace

VanishedParts vanished_parts(const Scene& scene, std::int64_t nodes) {
    VanishedParts result;
    std::unordered_set<const SolidNode*> met;
    CanonicalSolids canonical;
    std::unordered_set<int> seen;
    std::unordered_map<int, bool> is_empty_by_part;  // by canonical solid
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
            const MeshField* model = mesh_field_of(node.field().get());
            if (model && seen.insert(canonical.of(leaf).canonical).second) {
                const std::string what = thin_walls_text(*model, map);
                if (what.empty()) return;
                result.rounded_away.push_back(said(node.line, what));
                told = true;
            }
            if (node.field() || node.radius() == 0) return;
            if (node.leaves > (node.convolved() ? max_convolved_leaves : max_searched_leaves)) return;
            if (!seen.insert(canonical.of(leaf).canonical).second) return;
            for (const std::string& what : Leaf(node, map, nodes).vanished()) {
                result.rounded_away.push_back(said(node.line, what));
                told = true;
            }
        };
        try {
            for_each_leaf(
                {solid}, [&](const SolidNode& node) { return nodes > 0 && met.insert(&node).second; }, look);
            // Only one of all placements of a solid is examined.
            const auto [at, is_new] = is_empty_by_part.try_emplace(canonical.of(solid).canonical, false);
            if (is_new) at->second = is_empty(solid, nodes);
            if (!at->second) continue;
        } catch (const TooEntangled&) {  // reported when it is rendered
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
