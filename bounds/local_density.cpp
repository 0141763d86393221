// A decision node with thresholds τ₀ … τₘ₋₁ and children c₀ … cₘ has the value Σ pⱼ cⱼ, where
// pⱼ = F(τⱼ) − F(τⱼ₋₁). Collected by the F that is
//
//     V = cₘ + Σⱼ Fⱼ (cⱼ − cⱼ₊₁),
//
// affine in every Fⱼ = profile((n·x − τⱼ)/r), from which slopes and bounds follow term by term:
//
//     V′ = cₘ′ + Σ Fⱼ′ (cⱼ − cⱼ₊₁) + Fⱼ (cⱼ′ − cⱼ₊₁′),   and the second parts of it are Σ pⱼ cⱼ′,
//     L(V) = Σ L(Fⱼ) max(Mⱼ, Mⱼ₊₁) + maxⱼ Lⱼ
//     G(V) = Σ G(Fⱼ) max(Mⱼ, Mⱼ₊₁) + 2 Σ L(Fⱼ)(Lⱼ + Lⱼ₊₁) + maxⱼ Gⱼ
//
// as children lie in [0, M]: slopes of children are averaged with weights pⱼ ≥ 0 of sum 1.
#include "bounds/local_density.hpp"

#include <algorithm>

#include "bounds/decision_diagram.hpp"
#include "bounds/thread_memory.hpp"

namespace deburr {
namespace {

// Which nodes are Boolean functions of half-spaces, and so may be part of a diagram.
void boolean_nodes(const DensityTree& tree, std::vector<char>& boolean) {
    boolean.clear();
    for (const TreeNode& n : tree.nodes) {
        switch (n.op) {
            case Op::half_space:
            case Op::conjunction:
            case Op::disjunction: boolean.push_back(true); break;
            case Op::constant: boolean.push_back(n.value == 0 || n.value == 1); break;
            case Op::complement: boolean.push_back(boolean[n.a]); break;
            default: boolean.push_back(false);
        }
    }
}

// Roots of the Boolean parts: used by the papers' arithmetic, or by nobody.
void roots_of_boolean_parts(const DensityTree& tree, const std::vector<char>& boolean, std::vector<char>& root) {
    root.assign(tree.nodes.size(), false);
    root.back() = boolean.back();
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const TreeNode& n = tree.nodes[i];
        if (boolean[i] || n.op == Op::constant || n.op == Op::half_space) continue;
        for (const int child : {n.a, n.b})
            if (child >= 0 && boolean[child]) root[child] = true;
    }
}

}  // namespace

LocalDensity::LocalDensity(const DensityTree& tree) : rounds_(tree.rounds) {
    if (tree.nodes.back().op == Op::convolution) {
        convolution_ = std::make_shared<BallConvolution>(tree);
        half_spaces_ = convolution_->half_spaces();
        return;
    }
    nodes_.reserve(tree.nodes.size());
    half_spaces_.reserve(tree.half_spaces.size());
    // Kept from one to the next of a thread.
    thread_local std::vector<char> boolean, is_root, positive;  // never below 0, as far as the ops can tell
    thread_local std::vector<int> new_index;
    boolean_nodes(tree, boolean);
    roots_of_boolean_parts(tree, boolean, is_root);
    new_index.assign(tree.nodes.size(), -1);
    positive.assign(tree.nodes.size(), true);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const TreeNode& n = tree.nodes[i];
        const auto at = [&](int child) { return child < 0 ? -1 : new_index[child]; };
        bool operands = true;
        if (n.op != Op::half_space)
            for (const int child : {n.a, n.b}) operands &= child < 0 || positive[child];
        if (n.op == Op::constant)
            positive[i] = n.value >= 0;
        else if (n.op == Op::sum || n.op == Op::product)
            positive[i] = operands;
        else
            positive[i] = boolean[i];
        if (boolean[i]) {
            if (is_root[i]) new_index[i] = add_boolean(tree, int(i));
            continue;
        }
        switch (n.op) {
            case Op::constant: new_index[i] = add({Step::constant, -1, -1, n.value}); break;
            case Op::sum: new_index[i] = add({Step::sum, at(n.a), at(n.b)}); break;
            case Op::product: new_index[i] = add({Step::product, at(n.a), at(n.b)}); break;
            case Op::difference: new_index[i] = add({Step::difference, at(n.a), at(n.b), double(operands)}); break;
            case Op::complement: new_index[i] = add({Step::complement, at(n.a), -1, double(operands)}); break;
            default: break;
        }
    }
    for (const HalfSpace& h : half_spaces_) has_sharp_ |= h.radius == 0;
}

LocalDensity::LocalDensity(FieldPtr field) : field_(std::move(field)), half_spaces_(field_->planes()) {}

int LocalDensity::add(Node node) {
    nodes_.push_back(node);
    return int(nodes_.size()) - 1;
}

int LocalDensity::add_boolean(const DensityTree& tree, int root) {
    const TreeNode& top = tree.nodes[root];
    if (top.op == Op::half_space) {  // needs no diagram
        half_spaces_.push_back(tree.half_spaces[top.a]);
        polarity_.push_back(1);
        return add({Step::half_space, int(half_spaces_.size()) - 1});
    }
    const std::size_t first = half_spaces_.size();
    const DecisionDiagram diagram = build_diagram(tree, root);
    // Of the diagram, what its root reaches.
    std::vector<char> reached(diagram.nodes.size(), false);
    reached[diagram.root] = true;
    for (int i = int(diagram.nodes.size()) - 1; i >= 2; --i)
        if (reached[i])
            for (const int child : diagram.nodes[i].children) reached[child] = true;

    std::vector<std::vector<int>> plane(diagram.families.size());  // of (family, threshold)
    for (std::size_t f = 0; f < plane.size(); ++f) plane[f].assign(diagram.families[f].thresholds.size(), -1);
    const auto plane_of = [&](int family, int threshold) {
        int& index = plane[family][threshold];
        if (index < 0) {
            const PlaneFamily& f = diagram.families[family];
            half_spaces_.push_back({f.normal, f.thresholds[threshold], f.radius, f.round});
            index = int(half_spaces_.size()) - 1;
        }
        return index;
    };

    std::vector<int> new_index(diagram.nodes.size(), -1);
    for (std::size_t i = 0; i < diagram.nodes.size(); ++i) {
        if (!reached[i]) continue;
        if (i < 2) {
            new_index[i] = add({Step::constant, -1, -1, double(i)});
            continue;
        }
        const Decision& d = diagram.nodes[i];
        if (d.thresholds.size() == 1 && d.children[0] < 2 && d.children[1] < 2) {
            const int h = add({Step::half_space, plane_of(d.family, d.thresholds[0])});
            new_index[i] = d.children[0] == 1 ? h : add({Step::complement, h, -1, 1.0});
            continue;
        }
        const Node node{Step::decision, int(children_.size()), int(d.thresholds.size())};
        for (const int t : d.thresholds) children_.push_back(plane_of(d.family, t));
        for (const int c : d.children) children_.push_back(new_index[c]);
        new_index[i] = add(node);
    }
    find_polarities(tree, root, first);
    return new_index[diagram.root];
}

// Of the half-spaces from `first` on, which came from the Boolean function at `root`.
void LocalDensity::find_polarities(const DensityTree& tree, int root, std::size_t first) {
    enum : unsigned char { rises = 1, falls = 2 };
    const auto flipped = [](unsigned char p) {
        return static_cast<unsigned char>((p & rises) << 1 | (p & falls) >> 1);
    };
    thread_local std::vector<unsigned char> of_node, of_plane;
    of_node.assign(tree.nodes.size(), 0);
    of_node[root] = rises;
    of_plane.assign(half_spaces_.size() - first, 0);
    // Planes that the diagram took for one differ by less.
    constexpr double same_direction = 1e-8, same_radius = 1e-8, same_offset = 1e-11;
    for (int i = root; i >= 0; --i) {
        const TreeNode& n = tree.nodes[i];
        const unsigned char polarity = of_node[i];
        if (polarity == 0) continue;
        if (n.op == Op::half_space) {
            const HalfSpace& h = tree.half_spaces[n.a];
            for (std::size_t k = 0; k < of_plane.size(); ++k) {
                const HalfSpace& plane = half_spaces_[first + k];
                if ((h.round != nullptr) != (plane.round != nullptr) || (h.round && !h.round->is_same(*plane.round)))
                    continue;
                const double side = glm::dot(h.normal, plane.normal) < 0 ? -1 : 1;
                if (std::abs(side * h.offset - plane.offset) > same_offset * (1 + std::abs(h.offset)) ||
                    std::abs(h.radius - plane.radius) > same_radius * h.radius ||
                    largest(side * h.normal - plane.normal) > same_direction)
                    continue;
                of_plane[k] |= side > 0 ? polarity : flipped(polarity);
            }
        } else if (n.op != Op::constant) {
            for (const int child : {n.a, n.b})
                if (child >= 0) of_node[child] |= n.op == Op::complement ? flipped(polarity) : polarity;
        }
    }
    for (const unsigned char p : of_plane) polarity_.push_back(p == rises ? 1 : p == falls ? -1 : 0);
}

namespace {

ValueGradient operator+(const ValueGradient& a, const ValueGradient& b) {
    return {a.value + b.value, a.gradient + b.gradient};
}
ValueGradient operator-(const ValueGradient& a, const ValueGradient& b) {
    return {a.value - b.value, a.gradient - b.gradient};
}
ValueGradient operator*(const ValueGradient& a, const ValueGradient& b) {
    return {a.value * b.value, a.value * b.gradient + b.value * a.gradient};
}

ValueSlope operator+(ValueSlope a, ValueSlope b) { return {a.value + b.value, a.slope + b.slope}; }
ValueSlope operator-(ValueSlope a, ValueSlope b) { return {a.value - b.value, a.slope - b.slope}; }
ValueSlope operator*(ValueSlope a, ValueSlope b) { return {a.value * b.value, a.value * b.slope + b.value * a.slope}; }

// Beyond a plane's reach nothing depends on what lies there.
bool is_zero(double v) { return v == 0; }
bool is_zero(const ValueGradient& v) { return v.value == 0 && v.gradient == Vec3(0.0); }
bool is_zero(ValueSlope v) { return v.value == 0 && v.slope == 0; }

}  // namespace

// One pass over the steps in any arithmetic: values alone, with gradients, or with slopes.
template <class T, class Node, class Leaf>
static T run(const std::vector<Node>& nodes, const std::vector<int>& children, Leaf leaf) {
    using Step = decltype(Node::step);
    T* const done = memory_for<T>(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& n = nodes[i];
        const auto at = [&](int child) -> const T& { return done[child]; };
        switch (n.step) {
            case Step::constant: done[i] = T{n.value}; break;
            case Step::half_space: done[i] = leaf(std::size_t(n.a)); break;
            case Step::sum: done[i] = at(n.a) + at(n.b); break;
            case Step::product: done[i] = at(n.a) * at(n.b); break;
            case Step::difference: done[i] = at(n.a) - at(n.b); break;
            case Step::complement: done[i] = T{1.0} - at(n.a); break;
            case Step::decision: {
                const int* thresholds = &children[n.a];
                const int* operands = thresholds + n.b;
                T sum = at(operands[n.b]);
                for (int j = 0; j < n.b; ++j) {
                    const T share = leaf(std::size_t(thresholds[j]));
                    if (!is_zero(share)) sum = sum + share * (at(operands[j]) - at(operands[j + 1]));
                }
                done[i] = sum;
                break;
            }
        }
    }
    return done[nodes.size() - 1];
}

// Declared with the tree, so that who has one can ask it; made here of what is faster than a walk over it.
ValueGradient DensityTree::gradient_at(Vec3 x) const {
    return LocalDensity(prune(*this, Box{x, x}).tree).gradient_at(x);
}

double LocalDensity::at(Vec3 x) const {
    if (field_) return field_->at(x).value + 0.5;
    if (convolution_) return gradient_at(x).value;
    return run<double>(nodes_, children_, [&](std::size_t i) { return half_spaces_[i].density(x); });
}

ValueGradient LocalDensity::gradient_at(Vec3 x) const {
    if (field_) {
        ValueGradient v = field_->at(x);
        v.value += 0.5;
        return v;
    }
    if (convolution_) {
        thread_local std::vector<double> alpha, slope;
        alpha.clear();
        for (const HalfSpace& h : half_spaces_) alpha.push_back(h.alpha(x));
        ValueGradient v{convolution_->at(alpha, slope)};
        for (std::size_t i = 0; i < alpha.size(); ++i)
            v.gradient += half_spaces_[i].normal * (slope[i] / half_spaces_[i].radius);
        return v;
    }
    return run<ValueGradient>(nodes_, children_, [&](std::size_t i) -> ValueGradient {
        const HalfSpace& h = half_spaces_[i];
        const double alpha = h.alpha(x);
        if (h.radius == 0 || std::abs(alpha) >= 1) return {profile(alpha), Vec3(0.0)};
        return {profile(alpha), h.normal_at(x) * (profile_slope(alpha) / h.radius)};
    });
}

// ---- along a ray ---------------------------------------------------------------------------------

void RayDensity::set(const LocalDensity& density, Vec3 origin, Vec3 direction) {
    density_ = &density;
    origin_ = origin;
    direction_ = direction;
    lines_.clear();
    rounds_.clear();
    for (const HalfSpace& h : density.half_spaces_) {
        if (h.round) {
            rounds_.push_back({lines_.size(), {}});
            rounds_.back().on_ray.set(*h.round, origin, direction);
            lines_.push_back({});
            continue;
        }
        const double distance = h.distance(origin), rate = glm::dot(h.normal, direction);
        if (h.radius > 0)
            lines_.push_back({distance, rate, distance / h.radius, rate / h.radius});
        else
            lines_.push_back({distance, rate, distance <= 0 ? -2.0 : 2.0, 0});
    }
    leaf_.resize(lines_.size());
    leaf_bounds_.resize(lines_.size());
    if (!density.convolution_) return;
    speed_ = glm::length(density.convolution_->in_ball(direction));
    rates_.clear();
    for (const Line& line : lines_) rates_.push_back(std::abs(line.b));
}

void RayDensity::alphas(double t, std::vector<double>& all) const {
    all.clear();
    for (const Line& line : lines_) all.push_back(line.a + line.b * t);
}

void RayDensity::fix_sharp(double t) {
    for (std::size_t i = 0; i < lines_.size(); ++i)
        if (density_->half_spaces_[i].radius == 0)
            lines_[i].a = lines_[i].distance + lines_[i].rate * t <= 0 ? -2.0 : 2.0;
}

ValueSlope RayDensity::at(double t) const {
    if (density_->convolution_) {
        alphas(t, alphas_);
        ValueSlope v{density_->convolution_->at(alphas_, slopes_)};
        for (std::size_t i = 0; i < lines_.size(); ++i) v.slope += slopes_[i] * lines_[i].b;
        return v;
    }
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        const double alpha = lines_[i].a + lines_[i].b * t;
        leaf_[i] = {profile(alpha), profile_slope(alpha) * lines_[i].b};
    }
    if (!rounds_.empty()) evaluate_rounds(t);
    return run<ValueSlope>(density_->nodes_, density_->children_, [&](std::size_t i) { return leaf_[i]; });
}

void RayDensity::evaluate_rounds(double t) const {
    for (const Round& round : rounds_) {
        const HalfSpace& h = density_->half_spaces_[round.half_space];
        const double alpha = h.alpha_at(round.on_ray.at(t) - h.offset);
        leaf_[round.half_space] = {profile(alpha), profile_slope(alpha) * (round.on_ray.slope(t) / h.radius)};
    }
}

// With g, the even function of the distance s from the axis that the parts of one coordinate make up,
//
//     ρ″ = g″ s′² + g′ s″,     s″ ≤ speed²/s,     |g′| ≤ s·sup|g″|,
//
// so that g′ s″ ≤ speed²·sup|g″| wherever the ray comes near to the axis. A cone's two parts are a function of s and t
// that is even in s, with across²·(3/2 + 3/2 + 2·(¾)²)/r² as the bound of its second derivative by s.
RayBounds round_part_bounds(const HalfSpace& part, const RoundOnRay& on_ray, double t0, double t1) {
    const Range u = on_ray.range(t0, t1);
    const double r = part.radius, lo = (u.lo - part.offset) / r, hi = (u.hi - part.offset) / r;
    const RoundCoordinate& c = on_ray.coordinate();
    const double axis_distance = on_ray.least_distance(t0, t1);
    const bool is_near = axis_distance < 0.5 * r, is_cone = c.is_cone();
    if (lo >= 1 && !(is_near && is_cone)) return {};
    if (hi <= -1 && !(is_near && is_cone)) return {1, 0, 0};
    const double nearest = std::clamp(lo > 0 ? lo : hi < 0 ? -hi : 0.0, 0.0, 1.0);
    const double farthest = std::min(1.0, std::max(-lo, hi));
    const double slope = on_ray.max_slope(t0, t1) / r, steepest = 0.75 * (1 - nearest * nearest);
    constexpr double most = 1e200;  // products with 0 stay numbers
    const double alone = steepest > 0 ? std::min(steepest * on_ray.max_curvature(t0, t1) / r, most) : 0;
    const double along = 1.5 * farthest * slope * slope;
    if (!is_near) return {profile(lo), steepest * slope, along + alone};
    const double square = on_ray.square_of_speed() / (r * r);
    if (is_cone) return {1, steepest * slope, along + 4.2 * c.across * c.across * square};
    // Beside a circle its distance is that from a point, but for the bend of the circle, which is no more again.
    const double together = (c.kind == RoundCoordinate::Kind::circle ? 3.0 : 1.5) * square;
    return {profile(lo), steepest * slope, along + (std::abs(part.offset) < r ? together : std::min(alone, together))};
}

Vec3 RayDensity::gradient(double t) const {
    if (density_->convolution_) {
        alphas(t, alphas_);
        density_->convolution_->at(alphas_, slopes_);
        Vec3 gradient(0.0);
        for (std::size_t i = 0; i < lines_.size(); ++i)
            gradient += density_->half_spaces_[i].normal * (slopes_[i] / density_->half_spaces_[i].radius);
        return gradient;
    }
    return run<ValueGradient>(
               density_->nodes_, density_->children_,
               [&](std::size_t i) -> ValueGradient {
                   const double alpha = lines_[i].a + lines_[i].b * t;
                   const HalfSpace& h = density_->half_spaces_[i];
                   const double rate = h.radius > 0 ? profile_slope(alpha) / h.radius : 0.0;
                   if (h.round) {
                       const double at = h.alpha(origin_ + t * direction_);
                       return {profile(at), h.normal_at(origin_ + t * direction_) * (profile_slope(at) / h.radius)};
                   }
                   return {profile(alpha), h.normal * rate};
               })
        .gradient;
}

RayBounds RayDensity::bounds(double t0, double t1) const {
    if (density_->convolution_) {
        alphas(t0, alphas_);
        alphas(t1, alphas_at_end_);
        return density_->convolution_->bounds(alphas_, alphas_at_end_, rates_, speed_);
    }
    using Step = LocalDensity::Step;
    for (std::size_t i = 0; i < lines_.size(); ++i)
        leaf_bounds_[i] = half_space_bounds(alpha(i, t0), alpha(i, t1), std::abs(lines_[i].b));
    for (const Round& round : rounds_)
        leaf_bounds_[round.half_space] =
            round_part_bounds(density_->half_spaces_[round.half_space], round.on_ray, t0, t1);
    const auto& nodes = density_->nodes_;
    bounds_.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto& n = nodes[i];
        const auto at = [&](int child) -> const RayBounds& { return bounds_[child]; };
        switch (n.step) {
            case Step::constant: bounds_[i] = {std::abs(n.value), 0, 0}; break;
            case Step::half_space: bounds_[i] = leaf_bounds_[n.a]; break;
            case Step::sum: bounds_[i] = sum_bounds(at(n.a), at(n.b)); break;
            case Step::product: bounds_[i] = product_bounds(at(n.a), at(n.b)); break;
            case Step::difference: bounds_[i] = difference_bounds(at(n.a), at(n.b), n.value != 0); break;
            case Step::complement: bounds_[i] = complement_bounds(at(n.a), n.value != 0); break;
            case Step::decision: {
                const int* thresholds = &density_->children_[n.a];
                const int* children = thresholds + n.b;
                RayBounds sum = at(children[n.b]);
                for (int j = 0; j < n.b; ++j) {
                    const RayBounds& c = at(children[j]);
                    sum = {std::max(sum.M, c.M), std::max(sum.L, c.L), std::max(sum.G, c.G)};
                }
                for (int j = 0; j < n.b; ++j) {
                    const RayBounds& f = leaf_bounds_[thresholds[j]];
                    const RayBounds &c = at(children[j]), &next = at(children[j + 1]);
                    const double step = std::max(c.M, next.M);
                    sum.L += f.L * step;
                    sum.G += f.G * step + 2 * f.L * (c.L + next.L);
                }
                bounds_[i] = sum;
                break;
            }
        }
    }
    return bounds_.back();
}

}  // namespace deburr
