// Range of F over a box, by a second-order Taylor form about the box's middle: in steps u of half the box each term is
// c + g·u + uᵀHu + r. Constants, g and H of all terms are summed before they are bounded, so what cancels in F cancels
// in the bound; only the remainders r, of third order in the box's size, are added by absolute values. With q₀ and g of
// the quadric, s its second-order part and w = g·u + s = Q − q₀, a cube is
//
//     Q³ = q₀³ + 3q₀²(g·u + s) + 3q₀(g·u)² + r,   r = 3q₀(2(g·u)s + s²) + w³
//
// This holds where Q > 0 throughout the box. A perturbation that begins within the box lies in [0, max³] there, which
// is of third order itself.
#include "bounds/free_form.hpp"

#include <algorithm>

namespace deburr {
namespace {

// Cost of an evaluation in half-space densities: of the base and of each perturbation.
constexpr int cost_base = 2, cost_perturbation = 2;

double cube(double x) { return x * x * x; }
double positive_cube(double x) { return x > 0 ? cube(x) : 0; }

Range times(double f, Range r) { return f >= 0 ? Range{f * r.lo, f * r.hi} : Range{f * r.hi, f * r.lo}; }

// Range of Q over the part of the box where Q may be positive; only positive values count.
Range positive_range(const Perturbation& p, const Box& box) {
    const Box part = intersection(box, p.support);
    if (part.empty()) return {-1, 0};
    Range q = p.quadric.range(part);
    const bool whole = part.lo == box.lo && part.hi == box.hi;
    if (!whole) q.lo = std::min(q.lo, 0.0);
    return q;
}

/// Whether the perturbation may be anything but 0 in the box.
bool counts(const Perturbation& p, const Box& box) { return p.factor != 0 && positive_range(p, box).hi > 0; }

// Taylor form of a sum of terms over a box, in steps of half the box.
struct Taylor {
    double constant = 0;
    Vec3 slope{0.0}, square{0.0}, cross{0.0};  // cross: coefficients of yz, xz, xy
    Range rest{0, 0};

    Range range() const {
        Range sum{constant + rest.lo, constant + rest.hi};
        for (int i = 0; i < 3; ++i) {
            const Range own = parabola_range(slope[i], square[i], -1, 1);
            const double both = std::abs(cross[i]);
            sum = {sum.lo + own.lo - both, sum.hi + own.hi + both};
        }
        return sum;
    }
};

Vec3 cross_part(const Mat3& A, Vec3 h) {
    return {2 * A[1][2] * h.y * h.z, 2 * A[0][2] * h.x * h.z, 2 * A[0][1] * h.x * h.y};
}

void add_base(Taylor& sum, const Quadric& q, Vec3 middle, Vec3 half) {
    sum.constant += q.at(middle);
    sum.slope += q.gradient(middle) * half;
    sum.square += Vec3(q.A[0][0], q.A[1][1], q.A[2][2]) * half * half;
    sum.cross += cross_part(q.A, half);
}

void add_perturbation(Taylor& sum, const Perturbation& p, Range q, Vec3 middle, Vec3 half) {
    const Range plain = times(p.factor, {positive_cube(q.lo), positive_cube(q.hi)});
    const auto add_plain = [&] { sum.rest = {sum.rest.lo + plain.lo, sum.rest.hi + plain.hi}; };
    if (!(q.lo > 0)) return add_plain();
    const double q0 = p.quadric.at(middle);
    const Vec3 g = p.quadric.gradient(middle) * half;
    const Vec3 square = Vec3(p.quadric.A[0][0], p.quadric.A[1][1], p.quadric.A[2][2]) * half * half;
    const Vec3 cross = cross_part(p.quadric.A, half);
    const double first = std::abs(g.x) + std::abs(g.y) + std::abs(g.z);
    double second = 0;
    for (int i = 0; i < 3; ++i) second += std::abs(square[i]) + std::abs(cross[i]);
    const double w = std::max(q0 - q.lo, q.hi - q0);
    const double rest = std::abs(p.factor) * (3 * q0 * (2 * first * second + second * second) + cube(w));
    if (!(rest < 0.5 * (plain.hi - plain.lo))) return add_plain();
    const double f = 3 * q0 * p.factor;
    sum.constant += p.factor * cube(q0);
    sum.slope += f * q0 * g;
    sum.square += f * (q0 * square + g * g);
    sum.cross += f * (q0 * cross + 2.0 * Vec3(g.y * g.z, g.x * g.z, g.x * g.y));
    sum.rest = {sum.rest.lo - rest, sum.rest.hi + rest};
}

}  // namespace

FreeForm::FreeForm(const Quadric& base, std::vector<Perturbation> perturbations)
    : base_(base), perturbations_(std::move(perturbations)) {
    const auto unit = [](double size) { return size > 0 ? std::exp2(-std::ilogb(size)) : 1.0; };
    const double to_unit = unit(base_.largest());
    base_ = base_.scaled(to_unit);
    for (Perturbation& p : perturbations_) {
        const double own = unit(p.quadric.largest());
        p.quadric = p.quadric.scaled(own);
        p.factor *= to_unit / own / own / own;
    }
    find_box();
}

ValueGradient FreeForm::at(Vec3 x) const {
    ValueGradient sum{base_.at(x), base_.gradient(x)};
    for (const Perturbation& p : perturbations_) {
        const double q = p.quadric.at(x);
        if (!(q > 0)) continue;
        sum.value += p.factor * cube(q);
        sum.gradient += (3 * p.factor * q * q) * p.quadric.gradient(x);
    }
    return sum;
}

Range FreeForm::range(const Box& box) const {
    if (!box.finite()) {
        // A bounded form is not positive outside of its box, and the part inside is finite.
        const Box part = intersection(box, box_);
        if (part.empty()) return {-infinity, 0};
        if (part.finite()) return {-infinity, std::max(0.0, range(part).hi)};
        Range sum = base_.range(box);
        for (const Perturbation& p : perturbations_) {
            const Range q = positive_range(p, box);
            const Range r = times(p.factor, {positive_cube(q.lo), positive_cube(q.hi)});
            sum = {sum.lo + r.lo * (1 + quadric_rounding), sum.hi + r.hi * (1 + quadric_rounding)};
        }
        return sum.lo <= sum.hi ? sum : Range{-infinity, infinity};
    }
    const Vec3 half = 0.5 * (box.hi - box.lo), middle = box.lo + half;
    const auto reach = [&](const Quadric& q) { return glm::abs(middle - q.center) + half; };
    Taylor sum;
    add_base(sum, base_, middle, half);
    double off = base_.magnitude(reach(base_));
    for (const Perturbation& p : perturbations_) {
        const Range q = positive_range(p, box);
        if (!(q.hi > 0)) continue;
        add_perturbation(sum, p, q, middle, half);
        off += 3 * std::abs(p.factor) * q.hi * q.hi * p.quadric.magnitude(reach(p.quadric));
    }
    const Range r = sum.range();
    return {r.lo - quadric_rounding * off, r.hi + quadric_rounding * off};
}

Box FreeForm::extent() const {
    if (box_.finite()) return box_;
    Box all = base_.extent();
    for (const Perturbation& p : perturbations_)
        if (!p.support.empty()) all = hull(all, p.support.finite() ? p.support : p.quadric.extent());
    return all;
}

FieldPtr FreeForm::prune(const Box& box) const {
    const auto count = std::count_if(perturbations_.begin(), perturbations_.end(),
                                     [&](const Perturbation& p) { return counts(p, box); });
    if (std::size_t(count) == perturbations_.size()) return nullptr;
    std::vector<Perturbation> left;
    left.reserve(std::size_t(count));
    for (const Perturbation& p : perturbations_)
        if (counts(p, box)) left.push_back(p);
    return FieldPtr(new FreeForm(Part{}, base_, std::move(left), box_));
}

int FreeForm::size() const { return cost_base + cost_perturbation * int(perturbations_.size()); }

LocalSize FreeForm::local_size(const Box& box) const {
    const auto count = std::count_if(perturbations_.begin(), perturbations_.end(),
                                     [&](const Perturbation& p) { return counts(p, box); });
    return {range(box), cost_base + cost_perturbation * int(count)};
}

FieldPtr FreeForm::transformed_by(const Affine& map) const {
    std::vector<Perturbation> to;
    for (const Perturbation& p : perturbations_) to.push_back({p.factor, transformed(p.quadric, map)});
    return std::make_shared<FreeForm>(transformed(base_, map), std::move(to));
}

// F > 0 only where the base is positive or a perturbation raises it; of that box, the hull of the parts that a search
// by halving cannot exclude.
void FreeForm::find_box() {
    Box all = base_.bounding_box();
    for (const Perturbation& p : perturbations_)
        if (p.factor > 0 && !p.support.empty()) all = all.empty() ? p.support : hull(all, p.support);
    box_ = all;
    if (perturbations_.empty() || !all.finite()) return;
    // Boxes that may hold some of the set enlarge the result. Boxes inside of it already, or halved so often, are not
    // halved.
    constexpr int halvings = 15;  // five for each axis
    struct Open {
        Box box;
        FieldPtr form;
        int depth;
    };
    box_ = {};
    std::vector<Open> open{{all, nullptr, 0}};
    while (!open.empty()) {
        Open now = std::move(open.back());
        open.pop_back();
        if (!box_.empty() && box_.contains(now.box.lo) && box_.contains(now.box.hi)) continue;
        const FreeForm& form = now.form ? static_cast<const FreeForm&>(*now.form) : *this;
        if (form.range(now.box).hi <= 0) continue;
        if (now.depth == halvings) {
            box_ = box_.empty() ? now.box : hull(box_, now.box);
            continue;
        }
        if (FieldPtr left = form.prune(now.box)) now.form = std::move(left);
        const int axis = now.depth % 3;
        const double middle = 0.5 * (now.box.lo[axis] + now.box.hi[axis]);
        for (const bool upper : {false, true}) {
            Open part{now.box, now.form, now.depth + 1};
            (upper ? part.box.lo : part.box.hi)[axis] = middle;
            open.push_back(std::move(part));
        }
    }
}

}  // namespace deburr
