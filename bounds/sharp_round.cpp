#include "bounds/sharp_round.hpp"

#include <algorithm>

#include "bounds/bounding_box.hpp"
#include "bounds/density.hpp"
#include "bounds/density_part.hpp"
#include "bounds/free_form.hpp"
#include "bounds/torus.hpp"

namespace deburr {
namespace {

// A slanted cylinder or cone has no bounding box of its own, and neither has a slanted plane that cuts it. Their
// intersection is given a box that is larger than it by this fraction of its size, so that few cells contain parts of
// that box.
constexpr double around = 1.0 / 64;

/// Whether it is a cylinder or cone whose axis is not a coordinate axis.
bool is_slanted(const HalfSpace& h) {
    if (!h.round || h.round->kind != RoundCoordinate::Kind::axis) return false;
    const Vec3 axis = h.round->axis;
    return (axis.x != 0) + (axis.y != 0) + (axis.z != 0) > 1;
}

/// Converts a density into leaves and nodes of a solid tree.
class Conversion {
public:
    Conversion(const DensityTree& density, int material, int line, SolidTree& to)
        : density_(density), material_(material), line_(line), to_(to) {}

    int run() {
        // Subtrees without round parts become leaves of their own.
        std::vector<char> flat(density_.nodes.size(), true), wanted(density_.nodes.size(), false);
        for (std::size_t i = 0; i < flat.size(); ++i) {
            const TreeNode& n = density_.nodes[i];
            if (n.op == Op::half_space) flat[i] = !density_.half_spaces[n.a].round;
            if (n.op == Op::half_space || n.op == Op::constant) continue;
            flat[i] = flat[n.a] && (n.b < 0 || flat[n.b]);
        }
        wanted[std::size_t(density_.root())] = true;
        for (std::size_t i = flat.size(); i-- > 0;) {
            const TreeNode& n = density_.nodes[i];
            if (!wanted[i] || flat[i] || n.op == Op::half_space) continue;
            wanted[n.a] = true;
            if (n.b >= 0) wanted[n.b] = true;
        }
        std::vector<int> done(flat.size(), -1);
        for (std::size_t i = 0; i < flat.size(); ++i) {
            if (!wanted[i]) continue;
            const TreeNode& n = density_.nodes[i];
            if (flat[i])
                done[i] = leaf({part_below(density_, int(i)), material_, line_});
            else if (n.op == Op::half_space)
                done[i] = round(density_.half_spaces[n.a]);
            else if (n.op == Op::complement)
                done[i] = add({SolidOp::subtract, add({SolidOp::everything}), done[n.a]});
            else
                done[i] = add({solid_op(n.op), done[n.a], done[n.b]});
        }
        const std::vector<HalfSpace>& parts = density_.half_spaces;
        return std::any_of(parts.begin(), parts.end(), is_slanted) ? boxed(done.back()) : done.back();
    }

private:
    // The node intersected with a box around the density, which removes nothing of it.
    int boxed(int node) {
        const Box box = bounding_box(density_);
        if (box.empty() || !box.finite()) return node;
        const Vec3 size = box.hi - box.lo;
        const Box outer = inflated(box, around * max_component(size));
        return add({SolidOp::intersect, node, leaf({flatten(Density::box(outer.lo, outer.hi), 0), material_, line_})});
    }

    static SolidOp solid_op(Op op) {
        if (op == Op::sum || op == Op::disjunction) return SolidOp::unite;
        return op == Op::difference ? SolidOp::subtract : SolidOp::intersect;
    }

    int add(SolidTreeNode node) {
        to_.nodes.push_back(node);
        return int(to_.nodes.size()) - 1;
    }

    int leaf(SolidLeaf of) {
        of.density.rounds = nullptr;
        to_.leaves.push_back(std::move(of));
        return add({SolidOp::leaf, int(to_.leaves.size()) - 1});
    }

    int field(FieldPtr of) { return leaf({DensityTree::constant(0), material_, line_, std::move(of)}); }

    int round(const HalfSpace& part) {
        const RoundCoordinate& c = *part.round;
        const double R = part.offset;
        if (c.kind == RoundCoordinate::Kind::circle) return field(std::make_shared<Torus>(c.center, c.axis, c.ring, R));
        if (c.kind == RoundCoordinate::Kind::point) {
            Quadric ball;
            ball.center = c.center;
            ball.A = Mat3(-1 / (R * R));
            ball.k = 1;
            return field(std::make_shared<FreeForm>(ball, std::vector<Perturbation>{}));
        }
        if (!c.is_cone())
            return field(std::make_shared<FreeForm>(revolved({1, 0, 0, -1}, c.center, c.axis, R, 1),
                                                    std::vector<Perturbation>{}));
        // The double cone along²·(t − apex)² > across²·s² is cut to the side of the apex where along·t < R.
        const double apex = R / c.along;
        const int cones = field(std::make_shared<FreeForm>(
            revolved({0, 0, c.along * c.along, -c.across * c.across}, c.center + c.axis * apex, c.axis, 1, 1),
            std::vector<Perturbation>{}));
        const Vec3 normal = c.along > 0 ? c.axis : -c.axis;
        const double offset = glm::dot(normal, c.center) + std::abs(apex) * (R >= 0 ? 1 : -1);
        return add({SolidOp::intersect, cones,
                    leaf({DensityTree{{{normal, offset, 0}}, {{Op::half_space, 0}}}, material_, line_})});
    }

    const DensityTree& density_;
    const int material_, line_;
    SolidTree& to_;
};

}  // namespace

bool is_sharp_round(const DensityTree& tree) {
    return tree.rounds && std::all_of(tree.half_spaces.begin(), tree.half_spaces.end(),
                                      [](const HalfSpace& h) { return h.radius == 0; });
}

int add_sharp_round(const DensityTree& density, int material, int line, SolidTree& to) {
    return Conversion(density, material, line, to).run();
}

}  // namespace deburr
