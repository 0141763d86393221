#include "bounds/density_tree.hpp"

#include <cstdint>
#include <iomanip>
#include <sstream>

#include "bounds/expression.hpp"
#include "bounds/support.hpp"

namespace deburr {
namespace {

struct Placement {
    double radius;
    Affine map;
};

// A subexpression that is still to be flattened, or an operator whose operands are flattened already.
struct DensityTask {
    const DensityNode* node = nullptr;  // null: combine the last `count` results by `op`
    Placement placement{};
    bool boolean = false;
    Op op = Op::constant;  // combine only
    int count = 0, line = 0;
};

Op arithmetic(DensityNode::Kind kind) {
    switch (kind) {
        case DensityNode::Kind::sum: return Op::sum;
        case DensityNode::Kind::product: return Op::product;
        case DensityNode::Kind::difference: return Op::difference;
        case DensityNode::Kind::disjunction: return Op::disjunction;
        case DensityNode::Kind::conjunction: return Op::conjunction;
        case DensityNode::Kind::complement: return Op::complement;
        default: return Op::half_space;
    }
}

Op boolean_reading(Op op) {
    if (op == Op::sum) return Op::disjunction;
    if (op == Op::product) return Op::conjunction;
    return op;
}

bool associative(Op op) { return op != Op::difference && op != Op::complement && op != Op::half_space; }

// Flattens an expression into a DensityTree. Every loop keeps a stack of its own instead of recursing: scenes write
// chains as long as their loops.
class DensityFlattening {
public:
    DensityTree run(const DensityNode& root, Placement placement, bool boolean) {
        tasks_.push_back({&root, placement, boolean});
        while (!tasks_.empty()) {
            const DensityTask task = tasks_.back();
            tasks_.pop_back();
            if (task.node)
                open(task);
            else
                combine(task);
        }
        if (rounds_) tree_.rounds = std::move(rounds_);
        return std::move(tree_);
    }

private:
    static const DensityNode& through_placements(const DensityNode* node, Placement& placement) {
        while (node->kind == DensityNode::Kind::radius || node->kind == DensityNode::Kind::transform) {
            if (node->kind == DensityNode::Kind::radius)
                placement.radius = node->radius();
            else
                placement.map = compose(placement.map, node->map());
            node = &node->children()[0].node();
        }
        return *node;
    }

    void open(DensityTask task) {
        const DensityNode& node = through_placements(task.node, task.placement);
        if (node.is_plane()) {
            const HalfSpace unplaced{node.normal(), node.offset(), task.placement.radius};
            done_.push_back(add({Op::half_space, int(tree_.half_spaces.size())}));
            tree_.half_spaces.push_back(transformed(unplaced, task.placement.map, false));
            if (node.kind == DensityNode::Kind::cover) tree_.half_spaces.back().offset += task.placement.radius;
            return;
        }
        if (node.kind == DensityNode::Kind::round) {
            done_.push_back(round(image(task.placement.map, node.round()), task.placement));
            return;
        }
        Op op = arithmetic(node.kind);
        const bool boolean = task.boolean || op == Op::disjunction || op == Op::conjunction || op == Op::complement;
        if (boolean) op = boolean_reading(op);
        if (boolean && op == Op::difference) {  // a ∧ ¬b
            tasks_.push_back({nullptr, {}, true, Op::conjunction, 2, node.line});
            tasks_.push_back({nullptr, {}, true, Op::complement, 1, node.line});
            tasks_.push_back({&node.children()[1].node(), task.placement, true});
            tasks_.push_back({&node.children()[0].node(), task.placement, true});
            return;
        }
        const std::vector<DensityTask> operands = chain(node, task.placement, boolean, op);
        tasks_.push_back({nullptr, {}, boolean, op, int(operands.size()), node.line});
        tasks_.insert(tasks_.end(), operands.rbegin(), operands.rend());
    }

    int round_part(const RoundCoordinate& coordinate, double offset, double radius) {
        if (!rounds_) rounds_ = std::make_shared<std::deque<RoundCoordinate>>();
        rounds_->push_back(coordinate);
        tree_.half_spaces.push_back({Vec3(0.0), offset, radius, &rounds_->back()});
        return add({Op::half_space, int(tree_.half_spaces.size()) - 1});
    }

    // The leaf of a round part. Where the filter is wider than the part, the random draw of a distance must lie in
    // [−offset, offset], and that of a cone's coordinate on this side of the axis and on the other (docs/design.md,
    // Round primitives). Throws BadRoundPart.
    int round(const RoundPart& part, const Placement& placement) {
        const RoundCoordinate& c = part.coordinate;
        const double r = placement.radius;
        if (even_scale(placement.map) == 0)
            throw BadRoundPart(
                "expected scales that keep round parts round, got a density that is longer one way than "
                "another; scale the rounded solid instead");
        if (c.kind == RoundCoordinate::Kind::circle && c.ring < part.offset + r)
            throw BadRoundPart("expected a torus whose radius is at least its tube and the rounding radius, got " +
                               number(c.ring) + " < " + number(part.offset) + " + " + number(r));
        const int within = round_part(c, part.offset, r);
        if (c.is_cone() && r > 0) {
            const int beyond = round_part(c.mirrored(), part.offset, r);
            return add({Op::conjunction, within, beyond});
        }
        if (c.is_cone() || part.offset >= r) return within;
        const int below = round_part(c, -part.offset, r);
        const int above = add({Op::complement, below});
        return add({Op::conjunction, within, above});
    }

    static std::string number(double x) {
        std::ostringstream text;
        text << x;
        return text.str();
    }

    // The operands of a chain of one associative operator; the papers' sums and products count as one chain only if one
    // line of the scene wrote them.
    std::vector<DensityTask> chain(const DensityNode& node, Placement placement, bool boolean, Op op) const {
        std::vector<DensityTask> operands, open;
        const auto expand = [&](const DensityNode& parent, const Placement& at) {
            const auto children = parent.children();
            for (auto child = children.rbegin(); child != children.rend(); ++child)
                open.push_back({&child->node(), at, boolean});
        };
        expand(node, placement);
        while (!open.empty()) {
            DensityTask task = open.back();
            open.pop_back();
            const DensityNode& inner = through_placements(task.node, task.placement);
            const Op inner_op = boolean ? boolean_reading(arithmetic(inner.kind)) : arithmetic(inner.kind);
            if (inner_op == op && associative(op) && (boolean || inner.line == node.line)) {
                expand(inner, task.placement);
            } else {
                task.node = &inner;
                operands.push_back(task);
            }
        }
        return operands;
    }

    void combine(const DensityTask& task) {
        const std::size_t first = done_.size() - std::size_t(task.count);
        if (task.op == Op::complement) {
            done_.back() = add({Op::complement, done_.back()});
            return;
        }
        combine_balanced(done_, first, [&](int a, int b) { return add({task.op, a, b, 0, task.line, -1}); });
    }

    int add(TreeNode node) {
        tree_.nodes.push_back(node);
        return int(tree_.nodes.size()) - 1;
    }

    DensityTree tree_;
    std::shared_ptr<std::deque<RoundCoordinate>> rounds_;  // a deque, so that pointers to its elements stay valid
    std::vector<DensityTask> tasks_;
    std::vector<int> done_;
};

}  // namespace

std::string count_text(double count) {
    constexpr double exact = 1e15;  // counts below this are whole numbers in a double
    if (count > exact) return "more than 10^15";
    return std::to_string(std::int64_t(count));
}

static std::string too_many(double got) {
    std::string text = "expected a solid of at most ";
    text += count_text(max_half_spaces);
    text += " half-spaces, those of shared parts counted once per use, got ";
    return text += count_text(got);
}

TooManyHalfSpaces::TooManyHalfSpaces(double got) : std::length_error(too_many(got)) {}

HalfSpace transformed(const HalfSpace& h, const Affine& map, bool carry_radius) {
    const Vec3 normal = glm::transpose(glm::inverse(map.linear)) * h.normal;
    const double length = glm::length(normal);
    return {normal / length, (h.offset + glm::dot(normal, map.shift)) / length,
            carry_radius ? h.radius / length : h.radius};
}

// Maps the round parts by `to_world`, radii included. Throws BadRoundPart where the map does not keep angles.
static void carry_along(DensityTree& tree, const Affine& to_world) {
    const double scale = even_scale(to_world);
    if (scale == 0) throw BadRoundPart("expected a map that keeps angles");
    auto rounds = std::make_shared<std::deque<RoundCoordinate>>();
    for (HalfSpace& h : tree.half_spaces) {
        if (!h.round) continue;
        const RoundPart part = image(to_world, {*h.round, h.offset});
        rounds->push_back(part.coordinate);
        h = {Vec3(0.0), part.offset, h.radius * scale, &rounds->back()};
    }
    tree.rounds = std::move(rounds);
}

DensityTree placed(DensityTree tree, const Affine& map) {
    if (tree.rounds) carry_along(tree, map);
    for (HalfSpace& h : tree.half_spaces)
        if (!h.round) h = transformed(h, map, true);
    tree.supports.clear();
    for (TreeNode& n : tree.nodes) n.support = -1;
    find_supports(tree);
    return tree;
}

static DensityTree without_supports(const Density& density, double radius, const Affine& to_world, bool convolved) {
    if (density.node().leaves > max_half_spaces) throw TooManyHalfSpaces(density.node().leaves);
    DensityTree tree = DensityFlattening().run(density.node(), {radius, Affine{}}, convolved);
    if (convolved) {
        for (HalfSpace& h : tree.half_spaces) h.radius = radius;
        tree.nodes.push_back({Op::convolution, tree.root()});
        tree.ball = to_world.linear * radius;
    }
    if (tree.rounds) carry_along(tree, to_world);
    for (HalfSpace& h : tree.half_spaces)
        if (!h.round) h = transformed(h, to_world, true);
    return tree;
}

static DensityTree flatten(const Density& density, double radius, const Affine& to_world, bool convolved) {
    DensityTree tree = without_supports(density, radius, to_world, convolved);
    find_supports(tree);
    return tree;
}

std::vector<HalfSpace> flat_half_spaces(const Density& density, double radius, const Affine& to_world) {
    return without_supports(density, radius, to_world, false).half_spaces;
}

DensityTree flatten(const Density& density, double radius, const Affine& to_world) {
    return flatten(density, radius, to_world, false);
}

DensityTree flatten_convolved(const Density& density, double radius, const Affine& to_world) {
    return flatten(density, radius, to_world, true);
}

}  // namespace deburr
