// Slopes and bounds of a decision node, whose value [local_density_pass.hpp] is
//
//     V = cₘ + Σⱼ Fⱼ (cⱼ − cⱼ₊₁),
//
// affine in every Fⱼ = profile((n·x − τⱼ)/r). Slopes and bounds follow term by term:
//
//     V′ = cₘ′ + Σ Fⱼ′ (cⱼ − cⱼ₊₁) + Fⱼ (cⱼ′ − cⱼ₊₁′), where cₘ′ and the last terms add up to Σ pⱼ cⱼ′,
//     L(V) = Σ L(Fⱼ) max(Mⱼ, Mⱼ₊₁) + maxⱼ Lⱼ
//     G(V) = Σ G(Fⱼ) max(Mⱼ, Mⱼ₊₁) + 2 Σ L(Fⱼ)(Lⱼ + Lⱼ₊₁) + maxⱼ Gⱼ
//
// because children lie in [0, M], and their slopes are averaged with weights pⱼ ≥ 0 of sum 1.
#include "bounds/local_density.hpp"

#include <algorithm>

#include "bounds/local_density_pass.hpp"

namespace deburr {

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
    return evaluate_nodes<ValueSlope>(density_->nodes_, density_->children_, [&](std::size_t i) { return leaf_[i]; });
}

void RayDensity::evaluate_rounds(double t) const {
    for (const Round& round : rounds_) {
        const HalfSpace& h = density_->half_spaces_[round.half_space];
        const double alpha = h.alpha_at(round.on_ray.at(t) - h.offset);
        leaf_[round.half_space] = {profile(alpha), profile_slope(alpha) * (round.on_ray.slope(t) / h.radius)};
    }
}

// M, L and G of a round part. Let g be the even function of the distance s from the axis that the parts of one
// coordinate make up together. Then
//
//     ρ″ = g″ s′² + g′ s″,     s″ ≤ speed²/s,     |g′| ≤ s·sup|g″|,
//
// so that g′ s″ ≤ speed²·sup|g″| wherever the ray comes near the axis. The two parts of a cone are a function of s and
// t that is even in s, and whose second derivative by s is bounded by across²·(3/2 + 3/2 + 2·(¾)²)/r².
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
    constexpr double most = 1e200;  // finite, so that products with 0 are not NaN
    const double alone = steepest > 0 ? std::min(steepest * on_ray.max_curvature(t0, t1) / r, most) : 0;
    const double along = 1.5 * farthest * slope * slope;
    if (!is_near) return {profile(lo), steepest * slope, along + alone};
    const double square = on_ray.square_of_speed() / (r * r);
    if (is_cone) return {1, steepest * slope, along + 4.2 * c.across * c.across * square};
    // Near a circle the distance from it is that from a point, but for the circle's curvature, which adds no more than
    // as much again.
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
    return evaluate_nodes<ValueGradient>(
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
