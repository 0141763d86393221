#include "raytracer/trace/local_solid.hpp"

#include <algorithm>

#include "bounds/decision_diagram.hpp"
#include "bounds/round_density.hpp"
#include "bounds/torus.hpp"

namespace deburr {
namespace {

// A density of one half-space, ρ = v₀ + (v₁ − v₀)·F, crosses ½ on at most one plane.
struct FlatDensity {
    enum { outside, inside, plane } kind;
    Vec3 normal{0.0};
    double offset = 0;
};

FlatDensity flat_density(const LocalDensity& density) {
    const HalfSpace& h = density.half_spaces()[0];
    RayDensity ray;                                   // straight through the plane, from well inside to well outside
    ray.set(density, h.normal * h.offset, h.normal);  // perpendicular to the plane, from well inside to well outside
    const double reach = h.radius > 0 ? 2 * h.radius : 1.0;
    ray.fix_sharp(-reach);
    const double v1 = ray.at(-reach).value;
    ray.fix_sharp(reach);
    const double v0 = ray.at(reach).value;
    if ((v0 > 0.5) == (v1 > 0.5)) return {v0 > 0.5 ? FlatDensity::inside : FlatDensity::outside};
    double offset = h.offset;
    if (h.radius > 0) offset += h.radius * displacement((0.5 - v0) / (v1 - v0));
    if (v1 > 0.5) return {FlatDensity::plane, h.normal, offset};
    return {FlatDensity::plane, -h.normal, -offset};
}

// The leaf's local density. Throws TooEntangled with the leaf's line in the scene.
LocalDensity prepared(const SolidLeaf& leaf) {
    try {
        return LocalDensity(leaf.density);
    } catch (const TooEntangled&) {
        throw TooEntangled(leaf.line);
    }
}

}  // namespace

LocalSolid::LocalSolid(int solid, const SolidTree& tree, const Box& box, const Tolerances& tolerances,
                       RootMethod root_method)
    : solid_(solid), scale_(tolerances.scale) {
    std::vector<int> new_index(tree.nodes.size(), -1);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        SolidTreeNode n = tree.nodes[i];
        if (n.op == SolidOp::leaf) {
            std::optional<bool> constant;
            add_leaf(tree.leaves[n.a], box, tolerances, root_method, constant);
            if (constant)
                n = {*constant ? SolidOp::everything : SolidOp::nothing};
            else
                n.a = int(leaves_.size()) - 1;
        }
        nodes_.push_back(n);  // constant leaves stay nodes, so children keep their numbers
    }
    has_surface_ = !leaves_.empty();
    if (!has_surface_) return;
    if (leaves_.size() == 1 && nodes_.size() > 1) {
        // One leaf under operators with constants is the leaf itself, its complement, or nothing.
        std::vector<char> state;
        const bool without = evaluate(state, {false}), with = evaluate(state, {true});
        if (without == with)
            has_surface_ = false;
        else if (with)
            nodes_ = {{SolidOp::leaf, 0}};
        else if (leaves_[0].soft < 0) {  // the complement is the plane's other side
            leaves_[0].normal = -leaves_[0].normal;
            leaves_[0].offset = -leaves_[0].offset;
            nodes_ = {{SolidOp::leaf, 0}};
        }
    }
}

void LocalSolid::add_leaf(const SolidLeaf& leaf, const Box& box, const Tolerances& tolerances, RootMethod root_method,
                          std::optional<bool>& constant) {
    if (leaf.field) {  // the tree is pruned, so the field straddles the box
        leaves_.push_back({Vec3(0.0), 0, int(softs_.size()), leaf.material});
        softs_.push_back({form_of_field(leaf.field, box, tolerances, root_method), std::size_t(leaf.field->size())});
        return;
    }
    LocalDensity density = prepared(leaf);
    if (const Side side = classify(density.range(box)); side != Side::straddling) {
        constant = side == Side::inside;
        return;
    }
    Leaf to;
    to.material = leaf.material;
    const std::size_t half_spaces = density.half_spaces().size();
    if (half_spaces == 1) {
        const FlatDensity flat = flat_density(density);
        if (flat.kind != FlatDensity::plane) {
            constant = flat.kind == FlatDensity::inside;
            return;
        }
        to.normal = flat.normal;
        to.offset = flat.offset;
    } else if (auto convex = root_method == RootMethod::always ? std::nullopt : convex_density(density, scale_);
               convex && convex->planes.size() == 1) {  // the other planes coincide with it or have no effect
        const AlphaPlane& p = convex->planes[0];
        const double length = glm::length(p.slope) * (convex->complement ? -1 : 1);
        to.normal = p.slope / length;
        to.offset = -p.base / length;
    } else {
        to.soft = int(softs_.size());
        softs_.push_back({convex ? Form(*std::move(convex))
                                 : form_of_density(std::move(density), leaf.density, box, tolerances, root_method),
                          half_spaces});
    }
    leaves_.push_back(to);
}

// The form of a field: closed for round parts, else one that is searched.
LocalSolid::Form LocalSolid::form_of_field(const FieldPtr& field, const Box& box, const Tolerances& tolerances,
                                           RootMethod root_method) {
    const auto* round = dynamic_cast<const RoundDensity*>(field.get());
    if (round && round->local() && root_method != RootMethod::always) {
        if (auto surface = RoundSurface::of(*round->local())) return *std::move(surface);
        if (auto sum = ProductSum::of(*round->local(), tolerances.clearance())) return *std::move(sum);
        if (auto product = RoundProduct::of(*round->local())) return *std::move(product);
    }
    const auto* torus = dynamic_cast<const Torus*>(field.get());
    if (torus && root_method != RootMethod::always)
        if (auto surface = RoundSurface::of(*torus)) return *std::move(surface);
    const Box seen = intersection(box, inflated(field->bounding_box(), tolerances.margin()));
    const double max_noise_scale = !seen.empty() && seen.finite() ? field->max_noise_scale(seen) : 0;
    return SearchedField{field, max_noise_scale};
}

// The form of a density that is not a single product: a sum of products, or a search between bounds. `tree` is its
// definition.
LocalSolid::Form LocalSolid::form_of_density(LocalDensity density, const DensityTree& tree, const Box& box,
                                             const Tolerances& tolerances, RootMethod root_method) {
    const double clearance = tolerances.clearance();
    if (root_method != RootMethod::always)
        if (auto sum = ProductSum::of(density, clearance)) return *std::move(sum);
    const auto is_sharp = [](const HalfSpace& h) { return h.radius == 0; };
    const bool all_sharp = std::all_of(density.half_spaces().begin(), density.half_spaces().end(), is_sharp);
    return SearchedDensity{.density = std::move(density),
                           .outer = outer_bound(tree, 0.5, clearance),
                           .inner = inner_bound(tree, 0.5, clearance),
                           .bounded = bounds_hold(tree, box),
                           .all_sharp = all_sharp};
}

std::size_t LocalSolid::half_spaces() const {
    std::size_t sum = 0;
    for (const Leaf& leaf : leaves_) sum += leaf.soft < 0 ? 1 : softs_[leaf.soft].half_spaces;
    return sum;
}

std::optional<LocalSolid::Convex> LocalSolid::convex() const {
    constexpr std::size_t max_leaves = 6;
    if (leaves_.empty() || leaves_.size() > max_leaves) return std::nullopt;
    for (const Leaf& leaf : leaves_)
        if (leaf.material != leaves_[0].material) return std::nullopt;
    // As a Boolean function of the leaves, it is an intersection of leaves and complements if it is true in one case
    // only, and the complement of such a one if it is false in one case only.
    std::vector<char> state, inside(leaves_.size());
    unsigned ones = 0, zeros = 0, the_one = 0, the_zero = 0;
    for (unsigned bits = 0; bits < 1u << leaves_.size(); ++bits) {
        for (std::size_t i = 0; i < leaves_.size(); ++i) inside[i] = bits >> i & 1;
        const bool in = evaluate(state, inside);
        (in ? ones : zeros)++;
        (in ? the_one : the_zero) = bits;
    }
    if (ones == 1)
        if (auto found = intersection_of_leaves(the_one)) return Convex{*std::move(found), leaves_[0].material};
    if (zeros == 1)
        if (auto found = intersection_of_leaves(the_zero)) {
            found->complement = true;
            return Convex{*std::move(found), leaves_[0].material};
        }
    return std::nullopt;
}

std::optional<ConvexDensity> LocalSolid::intersection_of_leaves(unsigned positive) const {
    ConvexDensity d;
    std::vector<AlphaPlane> sharp;
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        const Leaf& leaf = leaves_[i];
        const bool is_positive = positive >> i & 1;
        if (leaf.soft < 0) {
            const double sign = is_positive ? 1 : -1;
            sharp.push_back({sign * leaf.normal, -sign * leaf.offset});
            continue;
        }
        const auto* part = std::get_if<ConvexDensity>(&softs_[leaf.soft].form);
        if (!part || part->complement == is_positive) return std::nullopt;
        const auto soft_end = part->planes.end() - part->sharp;
        // The intersection of {P > ½} of two products is not {P > ½} of their product.
        if (!d.planes.empty() && soft_end != part->planes.begin()) return std::nullopt;
        d.planes.insert(d.planes.end(), part->planes.begin(), soft_end);
        sharp.insert(sharp.end(), soft_end, part->planes.end());
    }
    d.planes.insert(d.planes.end(), sharp.begin(), sharp.end());
    d.sharp = int(sharp.size());
    if (d.planes.size() > std::size_t(max_factors)) return std::nullopt;
    return d;
}

bool LocalSolid::evaluate(std::vector<char>& state, const std::vector<char>& inside) const {
    state.clear();
    for (const SolidTreeNode& n : nodes_) {
        const auto at = [&](int child) -> bool { return state[child]; };
        switch (n.op) {
            case SolidOp::nothing: state.push_back(false); break;
            case SolidOp::everything: state.push_back(true); break;
            case SolidOp::leaf: state.push_back(inside[n.a]); break;
            case SolidOp::unite: state.push_back(at(n.a) || at(n.b)); break;
            case SolidOp::intersect: state.push_back(at(n.a) && at(n.b)); break;
            case SolidOp::subtract: state.push_back(at(n.a) && !at(n.b)); break;
        }
    }
    return state.back();
}

}  // namespace deburr
