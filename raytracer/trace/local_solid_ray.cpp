// A ray's crossings of the surface of a LocalSolid, for every form of its leaves.
#include <algorithm>

#include "raytracer/trace/local_solid.hpp"

namespace deburr {
namespace {

// A finite t beyond which the density does not vary along the ray: after `lo` and the last half-space's filter.
double last_change(const RayDensity& density, double scale, double lo) {
    double last = lo;
    for (std::size_t i = 0; i < density.size(); ++i) {
        const double rate = density.distance_rate(i), reach = density.density().half_spaces()[i].radius;
        if (rate != 0) last = std::max(last, (std::abs(density.distance0(i)) + reach + scale) / std::abs(rate));
    }
    return last < 1e300 ? last : 1e300;
}

// lo, hi, and the parameters between them where the ray crosses sharp planes, sorted.
const std::vector<double>& sharp_cuts(const RayDensity& density, double lo, double hi, std::vector<double>& cuts) {
    cuts.assign(1, lo);
    for (std::size_t i = 0; i < density.size(); ++i) {
        if (density.density().half_spaces()[i].radius > 0 || density.distance_rate(i) == 0) continue;
        const double t = density.plane_crossing(i);
        if (t > lo && t < hi) cuts.push_back(t);
    }
    cuts.push_back(hi);
    std::sort(cuts.begin(), cuts.end());
    return cuts;
}

// The normal of the sharp plane that is crossed at t; 0 if there is none.
Vec3 sharp_normal(const RayDensity& density, double t, double t_tolerance) {
    Vec3 normal(0.0);
    for (std::size_t i = 0; i < density.size(); ++i) {
        const HalfSpace& h = density.density().half_spaces()[i];
        if (h.radius > 0 || density.distance_rate(i) == 0) continue;
        if (std::abs(density.plane_crossing(i) - t) <= t_tolerance) normal = h.normal;
    }
    return normal;
}

// The crossings of a stretch of a ray on which sharp half-spaces do not change.
class Stretch {
public:
    Stretch(const RayDensity& density, CrossingScratch& scratch, double t_tolerance)
        : density_(density), scratch_(scratch), finder_({scratch.criterion, t_tolerance}, scratch.counters.roots) {}

    // Calls visit(t, entering) for each crossing until it returns false; then returns false.
    template <class Visit>
    bool crossings(double t0, double t1, Visit&& visit) {
        int varying = 0;
        std::size_t which = 0;
        for (std::size_t i = 0; i < density_.size() && varying < 2; ++i) {
            const double a = density_.alpha(i, t0), b = density_.alpha(i, t1);
            if ((a >= 1 && b >= 1) || (a <= -1 && b <= -1)) continue;
            ++varying;
            which = i;
        }
        if (varying == 0) return true;
        if (varying == 1) return one_varying(which, t0, t1, visit);
        return finder_.crossings(density_, t0, t1, [&](RootCrossing c) { return visit(c.t, c.entering); });
    }

private:
    // With one varying half-space ρ is affine in its density F, and ρ = ½ is a plane.
    template <class Visit>
    bool one_varying(std::size_t i, double t0, double t1, Visit&& visit) {
        const double r0 = density_.at(t0).value, r1 = density_.at(t1).value;
        scratch_.counters.roots.evaluations += 2;
        if ((r0 > 0.5) == (r1 > 0.5)) return true;
        const double a0 = density_.alpha(i, t0), a1 = density_.alpha(i, t1);
        const double f0 = profile(a0), f1 = profile(a1);
        const double alpha = displacement(f0 + (f1 - f0) * ((0.5 - r0) / (r1 - r0)));
        const double t = a1 == a0 ? t0 : t0 + (t1 - t0) * ((alpha - a0) / (a1 - a0));
        ++scratch_.counters.flat;
        return visit(std::clamp(t, t0, t1), r1 > 0.5);
    }

    const RayDensity& density_;
    CrossingScratch& scratch_;
    RootFinder finder_;
};

Vec3 normalized(Vec3 v) {
    const double length = glm::length(v);
    return length > 0 ? v / length : v;
}

// Turns a normal whose sign is unknown out of the solid: against a ray that enters.
Vec3 against(const Vec3& direction, bool entering, const Vec3& normal) {
    return (glm::dot(normal, direction) < 0) != entering ? -normal : normal;
}

// Cuts [t0, t1] down to the ray's interval in the box; false if it is empty.
bool clip(const Box& box, const Vec3& origin, const Vec3& direction, double& t0, double& t1) {
    for (int k = 0; k < 3; ++k) {
        const double o = origin[k], d = direction[k];
        if (d == 0) {
            if (o < box.lo[k] || o > box.hi[k]) return false;
            continue;
        }
        t0 = std::max(t0, ((d > 0 ? box.lo : box.hi)[k] - o) / d);
        t1 = std::min(t1, ((d > 0 ? box.hi : box.lo)[k] - o) / d);
    }
    return t0 <= t1;
}

}  // namespace

template <class Visit>
void LocalSolid::crossings_of(const SearchedField& searched, const Vec3& origin, const Vec3& direction, double t0,
                              double t1, CrossingScratch& scratch, bool* start_inside, Visit visit) const {
    const Field& field = *searched.field;
    // Touches up to this depth are ignored. f is in units of the ray's noise scale, in which rounding is the only
    // noise.
    constexpr double f_tolerance = 2 * RootFinder::rounding;
    constexpr double farthest = 1e30;  // squares and cubes are far from overflowing there
    if (start_inside) *start_inside = false;
    const double start = t0;
    // The box may touch the surface, which must be crossed before the ray leaves the box.
    const Box box = inflated(field.bounding_box(), Tolerances{scale_}.margin());
    if (!clip(box, origin, direction, t0, t1)) return;
    if (t1 == infinity) t1 = std::clamp(field.last_sign_change_bound(origin, direction), t0, std::max(t0, farthest));
    FieldRay& ray = scratch.field;
    const auto emit = [&](double t, bool entering) {
        const Vec3 gradient = field.at(origin + direction * t).gradient, normal = normalized(gradient);
        // Where large terms cancel, the error of f is more than its slope times the rounding of coordinates, and a ray
        // that leaves from here may pass through places where the terms are larger.
        const double slope = glm::length(gradient), most = 0x1p-30 * scale_;
        scratch.error = slope > 0
                            ? std::min(4 * epsilon * std::max(ray.noise_scale, searched.max_noise_scale) / slope, most)
                            : most;
        // A cone's apex has no normal; the ray's direction stands in.
        return visit(t, entering, normal == Vec3(0.0) ? direction : normal);
    };
    const auto inside_at = [&](double t) {
        ++scratch.counters.roots.evaluations;
        return ray.at(t).value > RootFinder::rounding;
    };
    // The ray is searched in stretches that are no longer than their distance from t = 0 on either side: where f is
    // large, far away, its rounding would hide values near the origin.
    for (double from = t0, to;; from = to) {
        to = std::min(t1, from < 0 ? from + std::max(-0.5 * from, 4 * scale_) : 2 * from + 4 * scale_);
        // By rounding, f may have another sign at the start of a stretch than at the end of the last one.
        const bool inside = from > t0 && inside_at(from);
        ray.set(field, origin, direction, from, to);
        if (from == start) {
            if (start_inside) *start_inside = inside_at(from);
        } else if (inside_at(from) != inside) {
            if (!emit(from, !inside)) return;
        }
        RootFinder finder({scratch.criterion, Tolerances{scale_}.along(from), f_tolerance}, scratch.counters.roots);
        if (!finder.crossings(ray, from, to, [&](RootCrossing c) { return emit(c.t, c.entering); })) return;
        if (to >= t1) return;
    }
}

template <class Round, class Crossings, class Visit>
void LocalSolid::visit_round(const Round& round, const Crossings& all, const Vec3& origin, const Vec3& direction,
                             CrossingScratch& scratch, bool* start_inside, Visit visit) const {
    if (start_inside) *start_inside = all.start_inside;
    scratch.error = Tolerances{scale_}.of_round();
    for (int i = 0; i < all.count; ++i) {
        const Vec3 normal = round.normal(origin + direction * all.at[i].t);
        // An apex has no normal; the ray's direction stands in.
        if (!visit(all.at[i].t, all.at[i].entering, normal == Vec3(0.0) ? direction : normal)) return;
    }
}

template <class Visit>
void LocalSolid::crossings_of(const RoundSurface& surface, const Vec3& origin, const Vec3& direction, double t0,
                              double t1, CrossingScratch& scratch, bool* start_inside, Visit visit) const {
    visit_round(surface, surface.crossings(origin, direction, t0, t1), origin, direction, scratch, start_inside, visit);
}

template <class Visit>
void LocalSolid::crossings_of(const RoundProduct& product, const Vec3& origin, const Vec3& direction, double t0,
                              double t1, CrossingScratch& scratch, bool* start_inside, Visit visit) const {
    const ConvexCrossings all =
        product.crossings(origin, direction, t0, t1, Tolerances{scale_}.along(t0), scratch.counters.roots.evaluations);
    visit_round(product, all, origin, direction, scratch, start_inside, visit);
}

template <class Visit>
void LocalSolid::sum_crossings(const ProductSum& sum, const Vec3& origin, const Vec3& direction, double t0, double t1,
                               bool coarse, CrossingScratch& scratch, bool* start_inside, Visit visit) const {
    ProductSumRay& ray = scratch.sum;
    ray.set(sum, origin, direction);
    scratch.error = sum.rounds().empty() ? 0 : Tolerances{scale_}.of_round();
    if (start_inside) *start_inside = ray.inside(t0);
    ray.crossings(t0, t1, Tolerances{scale_}.along(t0), coarse, scratch.counters.roots, [&](RootCrossing c) {
        if (coarse) return visit(c.t, c.entering, Vec3(0.0));
        const Vec3 normal = normalized(ray.gradient(c.t));
        // An apex has no normal; the ray's direction stands in.
        return visit(c.t, c.entering, normal == Vec3(0.0) ? direction : normal);
    });
}

template <class Visit>
void LocalSolid::crossings_of(const ConvexDensity& convex, const Vec3& origin, const Vec3& direction, double t0,
                              double t1, CrossingScratch& scratch, bool* start_inside, Visit visit) const {
    const ConvexView view = ConvexView::of(convex);
    const ConvexCrossings all = all_crossings(view, origin, direction, t0, t1, Tolerances{scale_}.along(t0),
                                              scratch.counters.roots.evaluations);
    if (start_inside) *start_inside = all.start_inside;
    for (int i = 0; i < all.count; ++i) {
        const ConvexCrossing& c = all.at[i];
        if (!visit(c.t, c.entering, surface_normal(view, c, origin + direction * c.t))) return;
    }
}

template <class Visit>
void LocalSolid::crossings_of(const SearchedDensity& searched, const Vec3& origin, const Vec3& direction, double t0,
                              double t1, CrossingScratch& scratch, bool* start_inside, Visit visit) const {
    const Span whole[1] = {{t0, t1}};
    const Span *first = whole, *last = whole + 1;
    if (searched.bounded) {
        const auto& found = scratch.spans.between(searched.outer, searched.inner, origin, direction, t0, t1);
        first = found.data();
        last = first + found.size();
        if (first == last && !start_inside) return;
    }
    RayDensity& density = scratch.density;
    density.set(searched.density, origin, direction);
    const auto inside_at = [&](double t) {
        ++scratch.counters.roots.evaluations;
        return density.at(t).value > 0.5;
    };
    const bool has_sharp = searched.density.has_sharp();
    if (start_inside) {
        if (has_sharp) density.fix_sharp(t0);
        *start_inside = inside_at(t0);
    }
    for (const Span* span = first; span != last; ++span) {
        const double lo = span->lo, hi = span->hi == infinity ? last_change(density, scale_, lo) : span->hi;
        const double t_tolerance = Tolerances{scale_}.along(lo);
        Stretch stretch(density, scratch, t_tolerance);
        const auto pass = [&](double t, bool entering) { return visit(t, entering, Vec3(0.0)); };
        if (!has_sharp) {
            if (!stretch.crossings(lo, hi, pass)) return;
            continue;
        }
        const std::vector<double>& cuts = sharp_cuts(density, lo, hi, scratch.sharp);
        bool inside = false;
        for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
            const double a = cuts[k], b = cuts[k + 1];
            if (k > 0 && k + 2 < cuts.size() && b - a <= t_tolerance) continue;  // a gap from rounding
            density.fix_sharp(a + 0.5 * (b - a));
            const bool now = inside_at(a);
            if (k > 0 && now != inside && !visit(a, now, sharp_normal(density, a, t_tolerance))) return;
            inside = now;
            if (searched.all_sharp) continue;
            if (!stretch.crossings(a, b, pass)) return;
            inside = inside_at(b);
        }
    }
}

SurfaceCrossing LocalSolid::first_crossing(const Vec3& origin, const Vec3& direction, double t0, double t1, bool any,
                                           CrossingScratch& scratch) const {
    scratch.error = 0;
    if (nodes_.size() == 1) return first_leaf_crossing(origin, direction, t0, t1, any, scratch);
    find_events(origin, direction, t0, t1, scratch);
    return first_change(direction, scratch);
}

SurfaceCrossing LocalSolid::first_leaf_crossing(const Vec3& origin, const Vec3& direction, double t0, double t1,
                                                bool any, CrossingScratch& scratch) const {
    SurfaceCrossing result;
    const Leaf& leaf = leaves_[0];
    if (leaf.soft < 0) {
        const double rate = glm::dot(leaf.normal, direction);
        const double t = (leaf.offset - glm::dot(leaf.normal, origin)) / rate;
        if (!(t >= t0 && t <= t1)) return result;
        ++scratch.counters.flat;
        return {t, leaf.normal, leaf.material};
    }
    const Soft& soft = softs_[leaf.soft];
    if (const auto* sum = std::get_if<ProductSum>(&soft.form)) {
        sum_crossings(*sum, origin, direction, t0, t1, any, scratch, nullptr,
                      [&](double t, bool entering, Vec3 normal) {
                          result = {t, against(direction, entering, normal), leaf.material, scratch.error};
                          return false;
                      });
        return result;
    }
    soft_crossings(soft, origin, direction, t0, t1, scratch, nullptr, [&](double t, bool entering, Vec3 normal) {
        if (normal == Vec3(0.0)) normal = normalized(scratch.density.gradient(t));
        result = {t, against(direction, entering, normal), leaf.material, scratch.error};
        return false;
    });
    return result;
}

void LocalSolid::find_events(const Vec3& origin, const Vec3& direction, double t0, double t1,
                             CrossingScratch& scratch) const {
    auto& events = scratch.events;
    events.clear();
    scratch.inside.assign(leaves_.size(), false);
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        const Leaf& leaf = leaves_[i];
        if (leaf.soft < 0) {
            const double rate = glm::dot(leaf.normal, direction);
            const double room = leaf.offset - glm::dot(leaf.normal, origin);
            const double t = room / rate;
            if (rate == 0)
                scratch.inside[i] = room >= 0;
            else
                scratch.inside[i] = rate > 0 ? t0 < t : t0 >= t;
            if (rate != 0 && t > t0 && t <= t1) events.push_back({t, int(i), rate < 0, leaf.normal, 0});
            continue;
        }
        bool start = false;
        scratch.error = 0;
        soft_crossings(softs_[leaf.soft], origin, direction, t0, t1, scratch, &start,
                       [&](double t, bool entering, Vec3 normal) {
                           if (normal == Vec3(0.0)) normal = normalized(scratch.density.gradient(t));
                           events.push_back({t, int(i), entering, normal, scratch.error});
                           return true;
                       });
        scratch.inside[i] = start;
    }
    std::sort(events.begin(), events.end(),
              [](const auto& a, const auto& b) { return a.t != b.t ? a.t < b.t : a.leaf < b.leaf; });
}

SurfaceCrossing LocalSolid::first_change(const Vec3& direction, CrossingScratch& scratch) const {
    const auto& events = scratch.events;
    const bool before = evaluate(scratch.state, scratch.inside);
    // Coincident faces are crossed at the same t up to rounding, so only the state after all of them counts.
    for (std::size_t i = 0; i < events.size();) {
        const std::size_t first = i;
        const double same = events[first].t + 2 * Tolerances{scale_}.along(events[first].t);
        std::size_t decisive = first;
        bool now = before;
        for (; i < events.size() && events[i].t <= same; ++i) {
            scratch.inside[events[i].leaf] = events[i].entering;
            const bool after = evaluate(scratch.state, scratch.inside);
            if (after != now) decisive = i;
            now = after;
        }
        if (now == before) continue;
        const auto& event = events[decisive];
        return {event.t, against(direction, now, event.normal), leaves_[event.leaf].material, event.error};
    }
    return {};
}

}  // namespace deburr
