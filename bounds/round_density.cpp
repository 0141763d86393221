#include "bounds/round_density.hpp"

#include <algorithm>

#include "bounds/bounding_box.hpp"
#include "bounds/decision_diagram.hpp"

namespace deburr {
namespace {

// Densities of more half-spaces are evaluated by the local density at a point or beside a ray.
constexpr std::size_t max_ready = 24;

// A torus that is alone is intersected in closed form; beside other parts it takes the general search, which takes a
// ray as long as this many half-spaces more. Measured on a groove in a block.
constexpr int torus_beside_others = 6;

// A radius, relative to the object's size, that no picture and no mesh distinguishes from 0.

/// The extent of the tree's surfaces: the largest offset, or center and ring of round parts; never 0.
double size_of(const DensityTree& tree) {
    double size = 0;
    for (const HalfSpace& h : tree.half_spaces)
        size = std::max(size, std::abs(h.offset) + (h.round ? h.round->ring + largest(h.round->center) : 0));
    return size > 0 ? size : 1;
}

// The local density beside the latest ray.
struct RayState final : FieldRayState {
    std::optional<LocalDensity> own;  // where the field has none prepared
    RayDensity density;
};

}  // namespace

Range cosine_range(const HalfSpace& h, const Box& box, Vec3 direction) {
    if (!h.round) {
        const double cosine = glm::dot(h.normal, direction);
        return {cosine, cosine};
    }
    // The unit gradient turns by at most the distance over the least radius of curvature.
    const Vec3 middle = 0.5 * (box.lo + box.hi);
    const RoundCoordinate& c = *h.round;
    const double reach = 0.5 * glm::distance(box.lo, box.hi), here = glm::dot(c.gradient(middle), direction);
    RoundCoordinate distance = c;  // from the point, axis or circle
    distance.across = 1;
    distance.along = 0;
    double bend = 1 / std::max(distance.range(box).lo, 1e-300);
    if (c.kind == RoundCoordinate::Kind::axis) bend *= std::abs(c.across);
    if (c.kind == RoundCoordinate::Kind::circle) {
        const double from_axis = RoundCoordinate::distance_from_axis(c.center, c.axis).range(box).lo;
        bend = std::max(bend, 1 / std::max(from_axis, 1e-300));
    }
    const double off = bend * reach;
    return {std::max(-1.0, here - off), std::min(1.0, here + off)};
}

RoundDensity::RoundDensity(DensityTree tree) : tree_(std::move(tree)) {
    const double least = sharp_radius * size_of(tree_);
    radius_ = infinity;
    for (HalfSpace& h : tree_.half_spaces) {
        if (h.radius > 0) radius_ = std::min(radius_, h.radius);
        if (h.radius == 0) h.radius = least;
    }
    if (radius_ == infinity) radius_ = 0;
    box_ = deburr::bounding_box(tree_);
    make_ready();
}

RoundDensity::RoundDensity(Part, DensityTree tree, const Box& seen, const RoundDensity& of)
    : tree_(std::move(tree)), radius_(of.radius_), box_(of.box_), seen_(seen) {
    make_ready();
}

void RoundDensity::make_ready() {
    if (tree_.half_spaces.size() > max_ready) return;
    try {
        local_.emplace(tree_);
    } catch (const TooEntangled&) {  // its local densities elsewhere may be simple enough
    }
}

bool RoundDensity::has_sharp() const {
    return std::any_of(tree_.half_spaces.begin(), tree_.half_spaces.end(),
                       [&](const HalfSpace& h) { return is_sharp(h); });
}

DensityTree RoundDensity::as_written() const {
    DensityTree tree = tree_;
    for (HalfSpace& h : tree.half_spaces)
        if (is_sharp(h)) h.radius = 0;
    return tree;
}

ValueGradient RoundDensity::at(Vec3 x) const {
    ValueGradient v = local_ ? local_->gradient_at(x) : tree_.gradient_at(x);
    v.value -= 0.5;
    return v;
}

Range RoundDensity::range(const Box& box) const {
    Range r = density_range(tree_, box);
    if (local_ && classify(r) == Side::straddling) {
        const Range own = local_->range(box);
        r = {std::max(r.lo, own.lo), std::min(r.hi, own.hi)};
    }
    return {r.lo - 0.5, r.hi - 0.5};
}

Range RoundDensity::rate_range(const Box& box, Vec3 direction) const {
    if (!local_) {
        const FieldPtr part = prune(box);
        if (!part || !static_cast<const RoundDensity&>(*part).local_) return {-infinity, infinity};
        return part->rate_range(box, direction);
    }
    thread_local std::vector<Range> rho, rates;
    rho.clear();
    rates.clear();
    for (const HalfSpace& h : local_->half_spaces()) {
        const Range d = distance_range(h, box);
        const double lo = d.lo / h.radius, hi = d.hi / h.radius;
        rho.push_back({profile(hi), profile(lo)});
        // dρ/dα = −¾(1 − α²) is least where |α| is least.
        const double nearest = lo > 0 ? lo : hi < 0 ? hi : 0, farthest = std::max(-lo, hi);
        const Range slope{profile_slope(nearest) / h.radius, profile_slope(farthest) / h.radius};
        rates.push_back(slope.lo == 0 ? Range{0, 0} : product(slope, cosine_range(h, box, direction)));
    }
    return local_->rate_range(rho, rates);
}

Box RoundDensity::extent() const {
    if (box_.empty() || box_.finite()) return box_;
    Box seen;
    for (const HalfSpace& h : tree_.half_spaces) {
        if (!h.round) continue;
        const double reach = std::abs(h.offset) + h.radius + h.round->ring;
        seen = hull(seen, inflated({h.round->center, h.round->center}, reach));
    }
    return seen.empty() ? box_ : seen;
}

FieldPtr RoundDensity::prune(const Box& box) const {
    Pruned left = deburr::prune(tree_, box);
    if (left.tree.half_spaces.size() == tree_.half_spaces.size()) return nullptr;
    return FieldPtr(new RoundDensity(Part{}, std::move(left.tree), box, *this));
}

std::optional<DensityTree> RoundDensity::as_density(const Box& box) const {
    for (const HalfSpace& h : tree_.half_spaces) {
        if (!h.round) continue;
        const Range r = density_range(h, box);
        if (r.hi > 0 && r.lo < 1) return std::nullopt;
    }
    DensityTree left = deburr::prune(tree_, box).tree;
    left.rounds = nullptr;
    return left;
}

// Planes to cut space along for a round part. A part that is alone gets planes through its middle, with its own size as
// their radius; one that meets others gets planes that touch it, with the filter's radius.
void RoundDensity::add_planes(const HalfSpace& h, std::vector<HalfSpace>& to) const {
    const RoundCoordinate& c = *h.round;
    const bool alone = tree_.half_spaces.size() == 1;
    double radius = h.radius;
    if (alone && c.kind == RoundCoordinate::Kind::point) radius = std::max(radius, h.offset);
    if (alone && c.kind == RoundCoordinate::Kind::circle) radius = std::max(radius, h.offset);
    if (alone && c.kind == RoundCoordinate::Kind::axis && seen_.finite()) {
        const Range s = RoundCoordinate::distance_from_axis(c.center, c.axis).range(seen_);
        radius = std::max(radius, 0.5 * (s.lo + s.hi));
    }
    for (int k = 0; k < 3; ++k) {
        Vec3 normal(0.0);
        normal[k] = 1;
        if (c.kind == RoundCoordinate::Kind::axis) {
            normal -= c.axis * c.axis[k];
            const double length = glm::length(normal);
            constexpr double parallel = 1e-6;
            if (length < parallel) continue;
            normal /= length;
        }
        const double middle = glm::dot(normal, c.center);
        const bool is_along = c.kind != RoundCoordinate::Kind::axis || (c.axis[k] == 0 && !c.is_cone());
        if (alone || !is_along || h.offset < 0) {
            to.push_back({normal, middle, radius});
            continue;
        }
        const double reach = h.offset + (c.kind == RoundCoordinate::Kind::circle
                                             ? c.ring * std::sqrt(std::max(0.0, 1 - c.axis[k] * c.axis[k]))
                                             : 0);
        to.push_back({normal, middle + reach, radius});
        to.push_back({-normal, reach - middle, radius});
    }
}

std::vector<HalfSpace> RoundDensity::planes() const {
    constexpr std::size_t few = 64;
    std::vector<HalfSpace> found;
    for (const HalfSpace& h : tree_.half_spaces) {
        if (found.size() >= few) break;
        if (h.round)
            add_planes(h, found);
        else
            found.push_back(h);
    }
    return found;
}

LocalSize RoundDensity::local_size(const Box& box) const {
    const LocalSize size = deburr::local_size(tree_, box);
    const auto is_torus = [&](const HalfSpace& h) {
        if (!h.round || h.round->kind != RoundCoordinate::Kind::circle) return false;
        const Range r = density_range(h, box);
        return r.hi > 0 && r.lo < 1;
    };
    const auto tori =
        size.half_spaces > 1 ? std::count_if(tree_.half_spaces.begin(), tree_.half_spaces.end(), is_torus) : 0;
    return {{size.range.lo - 0.5, size.range.hi - 0.5}, size.half_spaces + torus_beside_others * int(tori)};
}

FieldPtr RoundDensity::transformed_by(const Affine& map) const {
    if (even_scale(map) == 0) return nullptr;
    return std::make_shared<RoundDensity>(placed(as_written(), map));
}

double RoundDensity::last_sign_change_bound(Vec3 origin, Vec3 direction) const {
    if (box_.finite()) return leaves_box(box_, origin, direction);
    double last = 0;
    const double speed = glm::length(direction);
    for (const HalfSpace& h : tree_.half_spaces) {
        // Beyond the last crossing of the filter's edges; for spheres and tori, of a ball around the part and its
        // filter.
        if (!h.round) {
            const double rate = std::abs(glm::dot(h.normal, direction));
            if (rate > 0) last = std::max(last, (std::abs(h.distance(origin)) + h.radius) / rate);
            continue;
        }
        if (h.round->kind != RoundCoordinate::Kind::axis) {
            const double reach = h.round->ring + std::abs(h.offset) + h.radius;
            last = std::max(last, (glm::distance(origin, h.round->center) + reach) / speed);
            continue;
        }
        RoundOnRay ray;
        ray.set(*h.round, origin, direction);
        for (const double side : {-1.0, 0.0, 1.0}) {
            const RoundOnRay::Crossings c = ray.crossings(h.offset + side * h.radius);
            for (int i = 0; i < c.count; ++i) last = std::max(last, c.t[i]);
        }
    }
    return last;
}

void RoundDensity::begin_ray(FieldRay& ray) const {
    auto* state = dynamic_cast<RayState*>(ray.state.get());
    if (!state) {
        ray.state = std::make_unique<RayState>();
        state = static_cast<RayState*>(ray.state.get());
    }
    const LocalDensity* density = local();
    if (!density) {
        const Vec3 a = ray.origin + ray.t0 * ray.direction, b = ray.origin + ray.t1 * ray.direction;
        state->own.emplace(deburr::prune(tree_, Box{glm::min(a, b), glm::max(a, b)}).tree);
        density = &*state->own;
    }
    state->density.set(*density, ray.origin, ray.direction);
    // The rounding error of ρ is that of coordinates, in filter radii.
    double farthest = 0, least = infinity;
    const double reach =
        largest(ray.origin) + std::max(std::abs(ray.t0), std::abs(ray.t1)) * glm::length(ray.direction);
    for (const HalfSpace& h : density->half_spaces()) {
        farthest = std::max(farthest, std::abs(h.offset) + reach + (h.round ? largest(h.round->center) : 0));
        least = std::min(least, h.radius);
    }
    constexpr double share = 1.0 / 16;  // RootFinder::rounding is many ε
    ray.noise_scale = least < infinity ? std::max(1.0, share * farthest / least) : 1;
}

ValueSlope RoundDensity::at(const FieldRay& ray, double t) const {
    const ValueSlope v = static_cast<const RayState&>(*ray.state).density.at(t);
    return {(v.value - 0.5) / ray.noise_scale, v.slope / ray.noise_scale};
}

RayBounds RoundDensity::bounds(const FieldRay& ray, double t0, double t1) const {
    const RayBounds b = static_cast<const RayState&>(*ray.state).density.bounds(t0, t1);
    return {(b.M + 0.5) / ray.noise_scale, b.L / ray.noise_scale, b.G / ray.noise_scale};
}

}  // namespace deburr
