#include "bounds/solid_tree.hpp"

#include <algorithm>
#include <cmath>

#include "bounds/expression.hpp"
#include "bounds/round_density.hpp"
#include "bounds/sharp_round.hpp"

namespace deburr {
namespace {

/// A subexpression that is still to be flattened, or an operator whose operands are flattened already.
struct SolidTask {
    const SolidNode* node = nullptr;  // null: combine the last `count` results by `op`
    Affine map{};
    int material = 0;
    SolidOp op = SolidOp::nothing;
    int count = 0;
};

/// Whether all half-spaces are finite and have unit normals, that is, whether no placement was singular.
bool has_planes(const DensityTree& density) {
    for (const HalfSpace& h : density.half_spaces)
        if (!std::isfinite(h.offset) || !std::isfinite(h.radius) || !(std::abs(glm::length(h.normal) - 1) < 0.5))
            return false;
    return true;
}

bool is_operator(SolidNode::Kind kind) {
    return kind == SolidNode::Kind::unite || kind == SolidNode::Kind::intersect || kind == SolidNode::Kind::subtract;
}

// Flattens a solid's expression, with stacks of its own as in density_tree.cpp.
class SolidFlattening {
public:
    SolidTree run(const SolidNode& root) {
        tasks_.push_back({&root});
        while (!tasks_.empty()) {
            const SolidTask task = tasks_.back();
            tasks_.pop_back();
            if (task.node)
                open(task);
            else
                combine(task);
        }
        return std::move(tree_);
    }

private:
    static const SolidNode& through_placements(SolidTask& task) {
        const SolidNode* node = task.node;
        while (node->kind == SolidNode::Kind::material || node->kind == SolidNode::Kind::transform) {
            if (node->kind == SolidNode::Kind::material)
                task.material = node->material();  // the innermost wins
            else
                task.map = compose(task.map, node->map());
            node = &node->children()[0].node();
        }
        return *node;
    }

    void open(SolidTask task) {
        const SolidNode& node = through_placements(task);
        if (node.kind == SolidNode::Kind::rounded && node.density().node().has_round) {
            open_round(node, task);
            return;
        }
        if (node.kind == SolidNode::Kind::rounded) {
            const Density& density = node.density();
            tree_.leaves.push_back({node.convolved() ? flatten_convolved(density, node.radius(), task.map)
                                                     : flatten(density, node.radius(), task.map),
                                    task.material, node.line});
            if (!has_planes(tree_.leaves.back().density)) throw SingularPlacement(node.line);
            done_.push_back(add({SolidOp::leaf, int(tree_.leaves.size()) - 1}));
            return;
        }
        if (node.kind == SolidNode::Kind::field) {
            open_field(node.field(), node, task);
            return;
        }
        const SolidOp op = node.kind == SolidNode::Kind::unite       ? SolidOp::unite
                           : node.kind == SolidNode::Kind::intersect ? SolidOp::intersect
                                                                     : SolidOp::subtract;
        std::vector<SolidTask> operands, open;
        const auto expand = [&](const SolidNode& parent, const SolidTask& at) {
            const auto children = parent.children();
            for (auto child = children.rbegin(); child != children.rend(); ++child)
                open.push_back({&child->node(), at.map, at.material});
        };
        expand(node, task);
        while (!open.empty()) {
            SolidTask inner = open.back();
            open.pop_back();
            const SolidNode& it = through_placements(inner);
            inner.node = &it;
            if (is_operator(it.kind) && it.kind == node.kind && op != SolidOp::subtract)
                expand(it, inner);
            else
                operands.push_back(inner);
        }
        tasks_.push_back({nullptr, {}, 0, op, int(operands.size())});
        tasks_.insert(tasks_.end(), operands.rbegin(), operands.rend());
    }

    // A leaf with round parts. A map that keeps angles is applied to the parts; any other is applied to the field.
    void open_round(const SolidNode& node, const SolidTask& task) {
        const double scale = even_scale(task.map);
        const bool keeps_angles =
            scale > 0 && std::isfinite(scale) && std::isfinite(task.map.shift.x + task.map.shift.y + task.map.shift.z);
        DensityTree density = flatten(node.density(), node.radius(), keeps_angles ? task.map : Affine{});
        SolidTask rest = task;
        if (keeps_angles) rest.map = {};
        if (keeps_angles && is_sharp_round(density))
            done_.push_back(add_sharp_round(density, task.material, node.line, tree_));
        else
            open_field(std::make_shared<RoundDensity>(std::move(density)), node, rest);
    }

    void open_field(const FieldPtr& field, const SolidNode& node, const SolidTask& task) {
        FieldPtr placed = transformed(field, task.map);
        if (!placed) throw SingularPlacement(node.line);
        tree_.leaves.push_back({DensityTree::constant(0), task.material, node.line, std::move(placed)});
        done_.push_back(add({SolidOp::leaf, int(tree_.leaves.size()) - 1}));
    }

    void combine(const SolidTask& task) {
        const std::size_t first = done_.size() - std::size_t(task.count);
        combine_balanced(done_, first, [&](int a, int b) { return add({task.op, a, b}); });
    }

    int add(SolidTreeNode node) {
        tree_.nodes.push_back(node);
        return int(tree_.nodes.size()) - 1;
    }

    SolidTree tree_;
    std::vector<SolidTask> tasks_;
    std::vector<int> done_;
};

}  // namespace

SingularPlacement::SingularPlacement(int of_line)
    : std::domain_error("expected placements that leave a volume, got scales that multiply to 0 or infinity"),
      line(of_line) {}

double SolidTree::min_radius() const {
    double least = infinity;
    for (const SolidLeaf& leaf : leaves) {
        for (const HalfSpace& h : leaf.density.half_spaces)
            if (h.radius > 0) least = std::min(least, h.radius);
        const double radius = leaf.field ? leaf.field->filter_radius() : 0;
        if (radius > 0) least = std::min(least, radius);
    }
    return least < infinity ? least : 0;
}

bool SolidTree::has_free_form() const {
    return std::any_of(leaves.begin(), leaves.end(),
                       [](const SolidLeaf& leaf) { return leaf.field && !leaf.field->is_density(); });
}

bool SolidTree::contains(Vec3 x) const {
    std::vector<char> in;
    for (const SolidTreeNode& n : nodes) {
        const auto at = [&](int child) -> bool { return in[child]; };
        switch (n.op) {
            case SolidOp::nothing: in.push_back(false); break;
            case SolidOp::everything: in.push_back(true); break;
            case SolidOp::leaf: {
                const SolidLeaf& leaf = leaves[n.a];
                in.push_back(leaf.field ? leaf.field->at(x).value > 0 : leaf.density.at(x) > 0.5);
                break;
            }
            case SolidOp::unite: in.push_back(at(n.a) || at(n.b)); break;
            case SolidOp::intersect: in.push_back(at(n.a) && at(n.b)); break;
            case SolidOp::subtract: in.push_back(at(n.a) && !at(n.b)); break;
        }
    }
    return in.back();
}

SolidTree flatten(const Solid& solid) {
    if (solid.node().leaves > max_half_spaces) throw TooManyHalfSpaces(solid.node().leaves);
    return SolidFlattening().run(solid.node());
}

}  // namespace deburr
