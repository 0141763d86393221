// Quadrics and free forms: values, ranges, bounding boxes, pruning and bounds along rays against Vyatkin's equations.
#include "bounds/free_form.hpp"

#include "bounds/bounding_box.hpp"
#include "bounds/root_finder.hpp"
#include "catch.hpp"
#include "plain_definition.hpp"
#include "random_free_form.hpp"

using namespace deburr;

namespace {

Box any_box(Gen& g, double reach = 1.5) {
    const Vec3 a = g.point(reach), b = g.chance(0.5) ? g.point(reach) : a + g.point(0.2);
    return {glm::min(a, b), glm::max(a, b)};
}

Vec3 within(Gen& g, const Box& box) {
    Vec3 x;
    for (int k = 0; k < 3; ++k) {
        const int where = g.below(6);  // on a side of the box in a third of the cases
        x[k] = where == 0 ? box.lo[k] : where == 1 ? box.hi[k] : g.between(box.lo[k], box.hi[k]);
    }
    return x;
}

// Rounding error of a sum of terms whose magnitudes add up to `size`.
double noise(double size) { return 1e-13 * (1 + size); }

}  // namespace

TEST_CASE("quadrics: a range holds what is in the box, and is attained but for mixed terms") {
    for (auto seed : seeds(5'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Quadric q = random_quadric(g);
        const Box box = any_box(g);
        const Range r = q.range(box);
        double lo = infinity, hi = -infinity;
        for (int k = 0; k < 30; ++k) {
            const double v = double(plain::quadric(q, within(g, box)));
            lo = std::min(lo, v);
            hi = std::max(hi, v);
        }
        REQUIRE(r.lo <= lo);
        REQUIRE(r.hi >= hi);
        // Without mixed terms the maximum over the box is the sum of the maxima along each axis.
        const bool mixed = q.A[0][1] != 0 || q.A[0][2] != 0 || q.A[1][2] != 0;
        if (mixed) continue;
        double want = q.k;
        for (int k = 0; k < 3; ++k)
            want += parabola_range(q.b[k], q.A[k][k], box.lo[k] - q.center[k], box.hi[k] - q.center[k]).hi;
        REQUIRE(r.hi == Approx(want).epsilon(1e-9).margin(1e-9));
    }
}

TEST_CASE("quadrics: the range over all of space is that of the squares that they are made of") {
    int bounded = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        Quadric q;
        Range want{};
        want.lo = want.hi = q.k = g.chance(0.3) ? 0 : g.between(-1, 1);
        for (int k = 0; k < 3; ++k) {  // a term a·(y − p)² or b·y
            const int kind = g.below(4);
            const double a = kind < 2 ? (kind ? 1 : -1) * g.between(0.2, 3) : 0, p = g.between(-1, 1);
            q.A[k][k] = a;
            q.b[k] = kind == 3 && g.chance(0.2) ? p : -2 * a * p;
            q.k += a * p * p;
            if (a > 0 || (a == 0 && q.b[k] != 0)) want.hi = infinity;
            if (a < 0 || (a == 0 && q.b[k] != 0)) want.lo = -infinity;
        }
        q = transformed(q, g.map());
        const Range got = q.range_everywhere();
        for (const auto& [value, truth] : {std::pair{got.lo, want.lo}, {got.hi, want.hi}}) {
            bounded += std::isfinite(truth);
            if (truth == 0 || !std::isfinite(truth))
                REQUIRE(value == truth);
            else
                REQUIRE(value == Approx(truth).margin(1e-9));
        }
    }
    CHECK(bounded > 1'000);
}

TEST_CASE("quadrics: ranges over infinite boxes hold what is in them") {
    int decided = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Quadric q = random_quadric(g);
        Box box = any_box(g);
        for (int k = 0; k < 3; ++k) {
            if (g.chance(0.4)) box.lo[k] = -infinity;
            if (g.chance(0.4)) box.hi[k] = infinity;
        }
        const Range r = q.range(box);
        decided += std::isfinite(r.lo) || std::isfinite(r.hi);
        const Box seen = intersection(box, Box{Vec3(-1e6), Vec3(1e6)});
        for (int k = 0; k < 20; ++k) {
            Vec3 x = within(g, seen);
            for (int i = 0; i < 3; ++i)
                if (g.chance(0.3)) x[i] = std::clamp(g.between(-3, 3), seen.lo[i], seen.hi[i]);
            const double v = double(plain::quadric(q, x));
            REQUIRE(v >= r.lo - noise(std::abs(v)));
            REQUIRE(v <= r.hi + noise(std::abs(v)));
        }
    }
    CHECK(decided > 1'000);
}

TEST_CASE("quadrics: the bounding box holds the set, and touches ellipsoids") {
    int inside = 0, boxes = 0;
    for (auto seed : seeds(4'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Quadric q = random_quadric(g);
        const Box box = q.bounding_box();
        boxes += box.lo.x > -infinity || box.lo.y > -infinity || box.hi.z < infinity;
        for (int k = 0; k < 20; ++k) {
            const Vec3 x = g.point(g.chance(0.5) ? 2 : 30);
            if (plain::quadric(q, x) <= 0) continue;
            ++inside;
            REQUIRE(box.contains(x));
        }
        const Quadric e = random_ellipsoid(g, 0.01, 2, 50);
        const Box around = e.bounding_box();
        REQUIRE(around.finite());
        for (int k = 0; k < 3; ++k) {
            // The box touches the ellipsoid in one point of each side, where Q's gradient is along the axis.
            Vec3 n(0.0);
            n[k] = 1;
            const Vec3 to = glm::inverse(-e.A) * n;
            const Vec3 touch = e.center + to / std::sqrt(glm::dot(n, to));
            REQUIRE(around.hi[k] == Approx(touch[k]).epsilon(1e-6));
        }
    }
    CHECK(inside > 10'000);
    CHECK(boxes > 1'000);
}

TEST_CASE("free forms: value and gradient are those of Vyatkin's equations 2 and 3") {
    for (auto seed : seeds(300)) {
        CAPTURE(seed);
        Gen g(seed);
        const auto form = random_free_form(g, g.below(30));
        for (int k = 0; k < 10; ++k) {
            const Vec3 x = g.point(1.3), d = g.direction();
            const double want = plain::field(*form, x), h = 1e-5;
            const ValueGradient v = form->at(x);
            REQUIRE(v.value == Approx(want).epsilon(1e-11).margin(1e-11));
            const double slope = (plain::field(*form, x + d * h) - plain::field(*form, x - d * h)) / (2 * h);
            REQUIRE(glm::dot(v.gradient, d) == Approx(slope).epsilon(1e-4).margin(1e-4));
        }
    }
}

TEST_CASE("free forms: coefficients of any size give the same set") {
    for (auto seed : seeds(200)) {
        CAPTURE(seed);
        Gen g(seed);
        const auto form = random_free_form(g, 5);
        const double size = std::pow(10, g.between(-30, 30)), own = std::pow(10, g.between(-8, 8));
        std::vector<Perturbation> scaled;
        for (const Perturbation& p : form->perturbations())
            scaled.push_back({p.factor * size / own / own / own, p.quadric.scaled(own)});
        const FreeForm same(form->base().scaled(size), scaled);
        for (int k = 0; k < 10; ++k) {
            const Vec3 x = g.point(1);
            if (std::abs(form->at(x).value) < 1e-9) continue;
            REQUIRE((same.at(x).value > 0) == (form->at(x).value > 0));
        }
        REQUIRE(same.bounding_box().hi.x == Approx(form->bounding_box().hi.x).epsilon(1e-6));
    }
}

TEST_CASE("free forms: ranges hold what is in the box, the bounding box what is inside") {
    int inside = 0;
    for (auto seed : seeds(1'500)) {
        CAPTURE(seed);
        Gen g(seed);
        const auto form = random_free_form(g, g.below(g.chance(0.2) ? 80 : 12));
        for (int b = 0; b < 4; ++b) {
            const Box box = any_box(g);
            const Range r = form->range(box);
            for (int k = 0; k < 15; ++k) {
                const Vec3 x = within(g, box);
                const double v = plain::field(*form, x);
                REQUIRE(v >= r.lo);
                REQUIRE(v <= r.hi);
                if (v <= 0) continue;
                ++inside;
                REQUIRE(form->bounding_box().contains(x));
            }
        }
    }
    CHECK(inside > 4'000);
}

TEST_CASE("free forms: what a range has too much falls with the square of the box's size") {
    double excess[3] = {0, 0, 0};
    for (auto seed : seeds(300)) {
        Gen g(seed);
        const auto form = random_free_form(g, 12);
        const Vec3 x = g.point(0.8);
        for (int level = 0; level < 3; ++level) {
            const double h = 0.08 / (1 << level);
            const Box box{x - Vec3(h), x + Vec3(h)};
            Range seen{infinity, -infinity};
            for (int i = 0; i < 7 * 7 * 7; ++i) {
                const Vec3 at = x + h * (Vec3(i % 7, i / 7 % 7, i / 49) / 3.0 - 1.0);
                const double v = form->at(at).value;
                seen = {std::min(seen.lo, v), std::max(seen.hi, v)};
            }
            const Range r = form->range(box);
            excess[level] += (seen.lo - r.lo) + (r.hi - seen.hi);
        }
    }
    CHECK(excess[1] < 0.3 * excess[0]);
    CHECK(excess[2] < 0.3 * excess[1]);
}

TEST_CASE("free forms: pruned to a box they are the same there, and only what reaches there is left") {
    double whole = 0, left = 0;
    for (auto seed : seeds(300)) {
        CAPTURE(seed);
        Gen g(seed);
        const auto form = random_free_form(g, 80);
        const Vec3 corner = g.point(1);
        const Box box{corner, corner + Vec3(0.1)};
        const FieldPtr pruned = form->prune(box);
        if (!pruned) continue;
        whole += form->size();
        left += pruned->size();
        REQUIRE(form->local_size(box).half_spaces == pruned->size());
        for (int k = 0; k < 20; ++k) {
            const Vec3 x = within(g, box);
            REQUIRE(pruned->at(x).value == Approx(form->at(x).value).epsilon(1e-12).margin(1e-12));
        }
    }
    CHECK(left < 0.15 * whole);
}

TEST_CASE("free forms: carried along by a map, they are the form at the map's origin") {
    for (auto seed : seeds(300)) {
        CAPTURE(seed);
        Gen g(seed);
        const auto form = random_free_form(g, g.below(12));
        const Affine map = g.map();
        const FieldPtr there = transformed(form, map);
        const double unit = there->at(map(form->base().center)).value / form->at(form->base().center).value;
        for (int k = 0; k < 10; ++k) {
            const Vec3 x = g.point(1);
            REQUIRE(there->at(map(x)).value == Approx(unit * form->at(x).value).epsilon(1e-8).margin(1e-8 * unit));
        }
    }
}

TEST_CASE("free forms: along a ray the same values, within M, L and G, which are tight") {
    double tight = 0;
    int segments = 0;
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const auto form = random_free_form(g, g.below(g.chance(0.2) ? 80 : 12));
        const Vec3 o = g.point(3), d = glm::normalize(g.point(0.8) - o);
        FieldRay ray;
        ray.set(*form, o, d, 0, 6);
        const Vec3 far = o + d * 6.0;
        const double unit = ray.at(6).value / plain::field(*form, far);
        const double t0 = g.between(0, 5), t1 = t0 + (g.chance(0.5) ? g.between(0, 1) : g.between(0, 0.1));
        const RayBounds b = ray.bounds(t0, t1);
        constexpr int steps = 40;
        double second = 0, last = 0;
        for (int k = 0; k <= steps; ++k) {
            const double t = t0 + (t1 - t0) * k / steps;
            const ValueSlope v = ray.at(t);
            REQUIRE(v.value == Approx(unit * plain::field(*form, o + d * t)).margin(RootFinder::rounding));
            REQUIRE(std::abs(v.value) <= b.M + 1e-15);
            REQUIRE(std::abs(v.slope) <= b.L + 1e-15);
            if (k > 0) second = std::max(second, std::abs(v.slope - last) / ((t1 - t0) / steps));
            last = v.slope;
        }
        REQUIRE(second <= b.G * (1 + 1e-6) + 1e-9);
        if (t1 - t0 > 0.1 || second < 1e-6) continue;
        tight += b.G / second;
        ++segments;
    }
    CHECK(segments > 500);
    CHECK(tight / segments < 2);
}

TEST_CASE("free forms: beyond where it is settled, a ray crosses nothing") {
    for (auto seed : seeds(1'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const FreeForm form(random_quadric(g),
                            {{g.between(-1, 1), random_quadric(g)}, {g.between(-1, 1), random_quadric(g)}});
        const Vec3 o = g.point(3), d = g.direction();
        const double t = form.last_sign_change_bound(o, d);
        REQUIRE(t >= 0);
        if (!(t < 1e6)) continue;
        const bool side = plain::field(form, o + d * (1.001 * t + 1e-6)) > 0;
        for (int k = 0; k < 30; ++k)
            REQUIRE((plain::field(form, o + d * ((t + 1e-6) * std::pow(10, g.between(0.001, 4)))) > 0) == side);
    }
}

TEST_CASE("bounding boxes: what CSG leaves of an infinite form is bounded, if it is") {
    const auto solid = [](const Quadric& q) {
        return Solid::of_field(std::make_shared<FreeForm>(q, std::vector<Perturbation>{}));
    };
    const auto slab = [](double lo, double hi) {
        return Solid::sharp(Density::half_space({0, 1, 0}, hi) * Density::half_space({0, -1, 0}, -lo));
    };
    // At half of its height a cone with a base of radius 3 has radius 1.5.
    const Solid cone = solid(revolved({0, 0, 1, -1}, {5, 2, -1}, {0, 1, 0}, 3, 2));
    const Box box = bounding_box(flatten(cone & slab(1, 1.9)));
    CHECK(box.lo.y == Approx(1));
    CHECK(box.hi.y == Approx(1.9));
    for (const double side : {box.hi.x - 5, 5 - box.lo.x, box.hi.z + 1, -1 - box.lo.z}) {
        CHECK(side >= 1.5);
        CHECK(side < 1.6);
    }
    const Box open = bounding_box(flatten(cone & Solid::sharp(Density::half_space({0, 1, 0}, 1))));
    CHECK(open.hi.y == Approx(1));
    CHECK(open.lo.y == -infinity);
    CHECK(open.hi.x == infinity);
    // The bounding box holds every sampled point inside of intersections of random quadrics, too.
    int inside = 0;
    for (auto seed : seeds(300)) {
        CAPTURE(seed);
        Gen g(seed);
        const SolidTree tree =
            flatten(solid(random_quadric(g)) & (g.chance(0.5) ? solid(random_quadric(g)) : slab(-1, 1)));
        const Box around = bounding_box(tree);
        for (int k = 0; k < 40; ++k) {
            const Vec3 x = g.point(g.chance(0.5) ? 2 : 200);
            if (!tree.contains(x)) continue;
            ++inside;
            REQUIRE(around.contains(x));
        }
    }
    CHECK(inside > 500);
}
