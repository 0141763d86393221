#include "polygonizer/mesh/surface_distance.hpp"

#include "bounds/solid_range.hpp"
#include "polygonizer/mesh/sharp_parts.hpp"
#include "polygonizer/mesh/sharp_set.hpp"

namespace deburr {
namespace {

SurfaceSample negated(SurfaceSample o) { return {-o.distance, -o.normal, o.leaf, o.plane}; }
SurfaceSample least(const SurfaceSample& a, const SurfaceSample& b) { return b.distance < a.distance ? b : a; }
SurfaceSample greatest(const SurfaceSample& a, const SurfaceSample& b) { return b.distance > a.distance ? b : a; }

// ρ − ½, or 0 where rounding does not distinguish ρ from the level. On the ridge between two surfaces that touch, where
// ρ is flat, a rounding error divided by the slope would become a distance.
double above_level(double rho) {
    constexpr double rounding = 8 * epsilon;
    const double f = rho - 0.5;
    return std::abs(f) <= rounding ? 0 : f;
}

// A sharp density is a polyhedron: ∨ is a union and ∧ an intersection; + * - remain only in legal densities that were
// too large for sharp_set().
SurfaceSample sharp_at(const DensityTree& tree, Vec3 x) {
    thread_local std::vector<SurfaceSample> done;
    done.clear();
    for (const TreeNode& n : tree.nodes) {
        const auto at = [&](int child) -> const SurfaceSample& { return done[child]; };
        SurfaceSample o;
        switch (n.op) {
            case Op::constant: o.distance = n.value > 0.5 ? infinity : -infinity; break;
            case Op::half_space: {
                const HalfSpace& h = tree.half_spaces[n.a];
                o = {-h.distance(x), h.normal, -1, n.a};
                break;
            }
            case Op::sum:
            case Op::disjunction: o = greatest(at(n.a), at(n.b)); break;
            case Op::product:
            case Op::conjunction: o = least(at(n.a), at(n.b)); break;
            case Op::difference: o = least(at(n.a), negated(at(n.b))); break;
            case Op::complement: o = negated(at(n.a)); break;
            case Op::convolution: break;  // a convolution is never sharp
        }
        done.push_back(o);
    }
    return done.back();
}

}  // namespace

SignedDistance::SignedDistance(const SolidTree& solid) : solid_(separate_sharp(solid)) {
    for (SolidLeaf& leaf : solid_.leaves) {
        bool sharp = !leaf.field;
        for (const HalfSpace& h : leaf.density.half_spaces) sharp &= h.radius == 0;
        sharp_.push_back(sharp);
        if (sharp) leaf.density = sharp_set(std::move(leaf.density));
    }
    densities_.resize(solid_.leaves.size());
}

const LocalDensity& SignedDistance::density(std::size_t leaf) const {
    auto& density = densities_[leaf];
    if (!density) density = std::make_unique<LocalDensity>(solid_.leaves[leaf].density);
    return *density;
}

// A number with the sign of leaf_at(x).distance.
double SignedDistance::leaf_value(std::size_t leaf, Vec3 x) const {
    if (sharp_[leaf]) return sharp_at(solid_.leaves[leaf].density, x).distance;
    if (const Field* field = solid_.leaves[leaf].field.get()) {
        const double f = field->at(x).value;
        return field->is_density() ? above_level(f + 0.5) : f;
    }
    return above_level(density(leaf).at(x));
}

bool SignedDistance::inside(Vec3 x) const {
    if (solid_.nodes.size() == 1 && solid_.nodes[0].op == SolidOp::leaf)
        return leaf_value(std::size_t(solid_.nodes[0].a), x) > 0;
    thread_local std::vector<double> done;  // numbers with the sign of at(x).distance
    done.clear();
    for (const SolidTreeNode& n : solid_.nodes) {
        const auto of = [&](int child) { return done[child]; };
        switch (n.op) {
            case SolidOp::nothing: done.push_back(-1); break;
            case SolidOp::everything: done.push_back(1); break;
            case SolidOp::leaf: done.push_back(leaf_value(std::size_t(n.a), x)); break;
            case SolidOp::unite: done.push_back(std::max(of(n.a), of(n.b))); break;
            case SolidOp::intersect: done.push_back(std::min(of(n.a), of(n.b))); break;
            case SolidOp::subtract: done.push_back(std::min(of(n.a), -of(n.b))); break;
        }
    }
    return done.back() > 0;
}

SurfaceSample SignedDistance::leaf_at(std::size_t leaf, Vec3 x) const {
    SurfaceSample o;
    const Field* field = solid_.leaves[leaf].field.get();
    if (sharp_[leaf]) {
        o = sharp_at(solid_.leaves[leaf].density, x);
    } else {
        const ValueGradient v = field ? field->at(x) : density(leaf).gradient_at(x);
        const double slope = glm::length(v.gradient),
                     f = field && !field->is_density() ? v.value : above_level(field ? v.value + 0.5 : v.value);
        if (slope > 0)
            o = {f / slope, -v.gradient / slope};
        else
            o.distance = f > 0 ? infinity : f < 0 ? -infinity : 0;
    }
    o.leaf = int(leaf);
    return o;
}

std::vector<SmoothPiece> SignedDistance::pieces() const {
    std::vector<SmoothPiece> all;
    std::vector<double> side(solid_.nodes.size(), 1), side_of_part;
    for (std::size_t i = solid_.nodes.size(); i-- > 0;) {
        const SolidTreeNode& n = solid_.nodes[i];
        if (n.op == SolidOp::nothing || n.op == SolidOp::everything) continue;
        if (n.op != SolidOp::leaf) {
            side[n.a] = side[i];
            side[n.b] = n.op == SolidOp::subtract ? -side[i] : side[i];
            continue;
        }
        if (!sharp(n.a)) {
            all.push_back({n.a, -1, side[i]});
            continue;
        }
        const DensityTree& density = solid_.leaves[n.a].density;
        side_of_part.assign(density.nodes.size(), side[i]);
        for (std::size_t j = density.nodes.size(); j-- > 0;) {
            const TreeNode& part = density.nodes[j];
            if (part.op == Op::half_space) all.push_back({n.a, part.a, side_of_part[j]});
            if (part.a < 0 || part.op == Op::half_space) continue;
            side_of_part[part.a] = part.op == Op::complement ? -side_of_part[j] : side_of_part[j];
            if (part.b >= 0) side_of_part[part.b] = part.op == Op::difference ? -side_of_part[j] : side_of_part[j];
        }
    }
    return all;
}

SurfaceSample SignedDistance::piece_at(const SmoothPiece& piece, Vec3 x) const {
    SurfaceSample o;
    if (piece.plane < 0) {
        o = leaf_at(std::size_t(piece.leaf), x);
    } else {
        const HalfSpace& h = solid_.leaves[piece.leaf].density.half_spaces[piece.plane];
        o = {-h.distance(x), h.normal, piece.leaf, piece.plane};
    }
    return piece.side < 0 ? negated(o) : o;
}

SurfaceSample SignedDistance::at(Vec3 x) const {
    if (solid_.nodes.size() == 1 && solid_.nodes[0].op == SolidOp::leaf)
        return leaf_at(std::size_t(solid_.nodes[0].a), x);
    thread_local std::vector<SurfaceSample> done;
    done.clear();
    for (const SolidTreeNode& n : solid_.nodes) {
        SurfaceSample o;
        switch (n.op) {
            case SolidOp::nothing: o.distance = -infinity; break;
            case SolidOp::everything: o.distance = infinity; break;
            case SolidOp::leaf: o = leaf_at(std::size_t(n.a), x); break;
            case SolidOp::unite: o = greatest(done[n.a], done[n.b]); break;
            case SolidOp::intersect: o = least(done[n.a], done[n.b]); break;
            case SolidOp::subtract: o = least(done[n.a], negated(done[n.b])); break;
        }
        done.push_back(o);
    }
    return done.back();
}

namespace {

// Root search on the line through x along the normal; Field is SignedDistance or DistanceField.
template <class Field>
double search_along_normal(const Field& field, Vec3 x, double reach) {
    const SurfaceSample here = field.at(x);
    if (here.distance == 0) return 0;
    if (here.normal == Vec3(0.0)) return infinity;
    const bool in = here.distance > 0;
    const Vec3 line = here.normal * (in ? 1.0 : -1.0);
    double lo = 0, hi = std::min(reach, 1.5 * std::abs(here.distance));
    while (field.inside(x + line * hi) == in) {
        if (hi >= reach) return infinity;
        lo = hi;
        hi = std::min(reach, 1.5 * hi);
    }
    while (true) {
        const double middle = 0.5 * (lo + hi);
        if (middle <= lo || middle >= hi || hi - lo < 1e-12 * reach) return middle;
        (field.inside(x + line * middle) == in ? lo : hi) = middle;
    }
}

}  // namespace

double SignedDistance::distance_along_normal(Vec3 x, double reach) const {
    return search_along_normal(*this, x, reach);
}

std::size_t SignedDistance::half_spaces() const {
    std::size_t count = 0;
    for (const SolidLeaf& leaf : solid_.leaves)
        count += leaf.field ? std::size_t(leaf.field->size()) : leaf.density.half_spaces.size();
    return count;
}

// The margin is positive, so that a surface in the wall between two boxes is seen from both.
DistanceField::DistanceField(const SolidTree& solid, const Box& box, double margin)
    : root_(std::make_unique<Node>(box, std::make_shared<const SignedDistance>(solid), nullptr)),
      margin_(std::max(margin, 1e-6 * glm::length(box.hi - box.lo))) {}

double DistanceField::distance_along_normal(Vec3 x, double reach) const { return search_along_normal(*this, x, reach); }

const SignedDistance& DistanceField::near(Vec3 x) const {
    // A box is not split if that does not pay or does not help. Where very many half-spaces vary together, the nearest
    // have to do.
    constexpr std::size_t few = 8, many = 40;
    constexpr std::size_t large = 512;  // of more half-spaces, copies of nearly all would take too much memory
    constexpr int max_depth = 40;
    constexpr double min_margin = 0.05;  // relative to the margin
    // The greatest fraction of half-spaces left after three splits, once along each axis, with which splitting goes on.
    constexpr double most_left = 0.6;
    // If more than this fraction of the half-spaces is left in the half, it shares those of the box that is split.
    constexpr double nearly_all = 0.9;
    const Box& all = root_->box;
    // A point in the wall between two boxes belongs to the lower one, whichever box was used last.
    const auto belongs_to = [&](const Box& box) {
        for (int k = 0; k < 3; ++k)
            if (x[k] > box.hi[k] || x[k] < box.lo[k] || (x[k] == box.lo[k] && box.lo[k] > all.lo[k])) return false;
        return true;
    };
    if (last_ && belongs_to(last_->box)) return *last_->solid;
    // Consecutive points are usually near each other, so the search starts at the smallest box around both.
    Node* node = last_ ? last_ : root_.get();
    while (node->parent && !belongs_to(node->box)) node = node->parent;
    // A point outside of the box gets the surfaces nearest in it, because the whole solid may be too much to evaluate.
    const Vec3 y = glm::clamp(x, all.lo, all.hi);
    while (node->depth < max_depth && node->half_spaces > few) {
        const Vec3 size = node->box.hi - node->box.lo;
        const int axis = greatest_axis(size);
        double margin = margin_;
        if (size[axis] < 2 * margin_) {
            margin = 0.5 * size[axis];
            if (node->half_spaces <= many || margin < min_margin * margin_) break;
            const Node& was = node->depth < 3 ? *root_ : *node->parent->parent->parent;
            if (double(node->half_spaces) > most_left * double(was.half_spaces)) break;
        }
        const double middle = 0.5 * (node->box.lo[axis] + node->box.hi[axis]);
        std::unique_ptr<Node>& child = node->children[y[axis] > middle];
        if (!child) {
            Box half = node->box;
            (y[axis] > middle ? half.lo : half.hi)[axis] = middle;
            auto part = std::make_shared<const SignedDistance>(node->solid->within(inflated(half, margin)));
            const std::size_t left = part->half_spaces();
            if ((left > large && 4 * left > 3 * node->half_spaces) ||
                double(left) > nearly_all * double(node->half_spaces))
                part = node->solid;
            child = std::make_unique<Node>(half, std::move(part), node);
        }
        node = child.get();
    }
    last_ = node;
    return *node->solid;
}

SignedDistance SignedDistance::within(const Box& box) const { return SignedDistance(prune(solid_, box)); }

double SignedDistance::constant_side(const Box& box) const {
    const Side side = local_size(solid_, box).side;
    return side == Side::inside ? infinity : side == Side::outside ? -infinity : 0;
}

}  // namespace deburr
