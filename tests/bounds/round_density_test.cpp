// Densities with round parts against their plain definition.
#include "bounds/round_density.hpp"

#include "bounds/bounding_box.hpp"
#include "bounds/solid_tree.hpp"
#include "bounds/torus.hpp"
#include "catch.hpp"
#include "plain_round.hpp"

using namespace deburr;
using test::round_case;
using test::RoundCase;

namespace {

RoundDensity field_of(const RoundCase& c) { return RoundDensity(flatten(c.density, c.radius)); }

// A line through the center or along the axis of a round part, slightly beside it, or anywhere.
struct Line {
    Vec3 origin, direction;
};
Line adversarial_line(Gen& g, const DensityTree& tree) {
    Line line{g.point(1.5), g.direction()};
    if (tree.half_spaces.empty() || !tree.rounds) return line;
    const RoundCoordinate& c = (*tree.rounds)[std::size_t(g.below(int(tree.rounds->size())))];
    const Vec3 beside = g.chance(0.5) ? Vec3(0.0) : g.direction() * std::pow(10.0, g.between(-12, -1));
    switch (g.below(4)) {
        case 0: return {c.center + beside - 2.0 * line.direction, line.direction};
        case 1: return {c.center + beside - 2.0 * c.axis, c.axis};
        case 2: {  // through a point of the axis
            const Vec3 on = c.center + c.axis * g.between(-1, 1) + beside;
            return {on - 2.0 * line.direction, line.direction};
        }
        default: return line;
    }
}

Box box_of_any_size(Gen& g) {
    const Vec3 lo = g.point(1.2);
    const double size = std::pow(10.0, g.between(-4, 0.3));
    return {lo, lo + size * Vec3(g.number(), g.number(), g.number())};
}

Vec3 in(const Box& box, Gen& g) { return glm::mix(box.lo, box.hi, Vec3(g.number(), g.number(), g.number())); }

}  // namespace

TEST_CASE("a density with round parts is the probability that its function is true") {
    int varied = 0;
    for (auto seed : seeds(4'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const RoundCase c = round_case(g, 1 + g.below(4));
        const bool moved = g.chance(0.3);
        Affine map;
        if (moved) map = g.map(false);
        const double scale = moved ? g.between(0.5, 2) : 1;
        map.linear = map.linear * scale;
        const RoundDensity field(flatten(moved ? c.density.transformed(map) : c.density, scale * c.radius));
        for (int k = 0; k < 10; ++k) {
            const Vec3 x = g.point(1.3);
            const double expected = c.plain.density(x, c.radius);
            CHECK(field.at(map(x)).value + 0.5 == Approx(expected).margin(1e-9));
            varied += expected > 0.01 && expected < 0.99;
        }
    }
    CHECK(varied > 4'000);
}

TEST_CASE("the gradient of a density with round parts is that of its definition") {
    int steep = 0;
    for (auto seed : seeds(1'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const RoundCase c = round_case(g, 1 + g.below(3));
        const RoundDensity field = field_of(c);
        const Vec3 x = g.point(1), d = g.direction();
        const double h = 1e-4 * c.radius;
        const double expected = (c.plain.density(x + h * d, c.radius) - c.plain.density(x - h * d, c.radius)) / (2 * h);
        CHECK(c.radius * glm::dot(field.at(x).gradient, d) == Approx(c.radius * expected).margin(2e-3));
        steep += std::abs(c.radius * expected) > 0.05;
    }
    CHECK(steep > 100);
}

TEST_CASE("ranges and rates over boxes hold what is in them") {
    int straddling = 0, steady = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const RoundCase c = round_case(g, 1 + g.below(4));
        const RoundDensity field = field_of(c);
        const Box box = box_of_any_size(g);
        const Range r = field.range(box);
        const Vec3 direction = g.direction();
        const Range rate = field.rate_range(box, direction);
        const FieldPtr pruned = field.prune(box);
        const std::optional<DensityTree> flat = field.as_density(box);
        straddling += r.lo < 0 && r.hi > 0;
        steady += rate.hi <= 0 || rate.lo >= 0;
        for (int k = 0; k < 10; ++k) {
            const Vec3 x = in(box, g);
            const ValueGradient v = field.at(x);
            CHECK(v.value >= r.lo - 1e-12);
            CHECK(v.value <= r.hi + 1e-12);
            const double slope = glm::dot(v.gradient, direction), slack = 1e-9 / c.radius;
            CHECK(slope >= rate.lo - slack);
            CHECK(slope <= rate.hi + slack);
            if (pruned) CHECK(pruned->at(x).value == Approx(v.value).margin(1e-12));
            if (flat) CHECK(flat->at(x) - 0.5 == Approx(v.value).margin(1e-12));
        }
    }
    CHECK(straddling > 100);
    CHECK(steady > 100);
}

TEST_CASE("a coordinate's range over a box is the least and the greatest value in it") {
    // The range is exact for spheres, cylinders and cones in any pose, and for circles about a coordinate axis.
    for (auto seed : seeds(400)) {
        CAPTURE(seed);
        Gen g(seed);
        const Vec3 axis = g.chance(0.5) ? Vec3(0, 0, 1) : g.direction();
        const bool is_along = axis == Vec3(0, 0, 1);
        const RoundCoordinate all[] = {RoundCoordinate::distance_from_point(g.point(1)),
                                       RoundCoordinate::distance_from_axis(g.point(1), axis),
                                       RoundCoordinate::across_cone(g.point(1), axis, 0.8, 0.6),
                                       RoundCoordinate::across_cone(g.point(1), axis, -0.8, 0.6),
                                       RoundCoordinate::distance_from_circle(g.point(1), axis, 0.7)};
        const Box box = box_of_any_size(g);
        for (int i = 0; i < 5; ++i) {
            const Range r = all[i].range(box);
            double least = infinity, greatest = -infinity;
            constexpr int n = 12;
            for (int k = 0; k < n * n * n; ++k) {
                const double u = all[i].at(glm::mix(box.lo, box.hi, Vec3(k % n, k / n % n, k / n / n) / double(n - 1)));
                least = std::min(least, u);
                greatest = std::max(greatest, u);
            }
            CAPTURE(i);
            CHECK(r.lo <= least + 1e-12);
            CHECK(r.hi >= greatest - 1e-12);
            if (!is_along && i >= 4) continue;
            const double grain = glm::distance(box.lo, box.hi) / (n - 1);
            CHECK(r.lo >= least - grain);
            CHECK(r.hi <= greatest + grain);
        }
    }
}

TEST_CASE("M, L and G hold along rays through axes, apexes and centers") {
    int bent = 0;
    for (auto seed : seeds(6'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const RoundCase c = round_case(g, 1 + g.below(3));
        const RoundDensity field = field_of(c);
        const auto [o, d] = adversarial_line(g, field.tree());
        const double t0 = g.between(0, 3.5), t1 = t0 + std::pow(10.0, g.between(-4, 0));
        FieldRay ray;
        ray.set(field, o, d, t0, t1);
        const RayBounds b = ray.bounds(t0, t1);
        constexpr int n = 40;
        ValueSlope before = ray.at(t0);
        for (int k = 1; k <= n; ++k) {
            const double h = (t1 - t0) / n, t = t0 + h * k;
            const ValueSlope v = ray.at(t);
            CHECK(std::abs(v.value) <= b.M + 1e-12);
            CHECK(std::abs(v.slope) <= b.L * (1 + 1e-9) + 1e-9);
            CHECK(std::abs(v.value - before.value) <= b.L * h * (1 + 1e-9) + 1e-12);
            CHECK(std::abs(v.slope - before.slope) <= b.G * h * (1 + 1e-6) + 1e-6 / c.radius / ray.noise_scale);
            bent += std::abs(v.slope - before.slope) > 0.2 * b.G * h && b.G * h > 0.01;
            before = v;
            const Vec3 x = o + t * d;
            CHECK(v.value * ray.noise_scale + 0.5 == Approx(c.plain.density(x, c.radius)).margin(1e-8));
        }
    }
    CHECK(bent > 1'000);
}

TEST_CASE("the bounding box holds all of a density with round parts, and no more than it must of one part") {
    for (auto seed : seeds(300)) {
        CAPTURE(seed);
        Gen g(seed);
        const RoundCase c = round_case(g, 1 + g.below(4));
        const RoundDensity field = field_of(c);
        const Box box = field.bounding_box();
        for (int k = 0; k < 300; ++k) {
            const Vec3 x = g.point(2);
            if (c.plain.density(x, c.radius) > 0.5 + 1e-9) CHECK(inflated(box, 1e-9).contains(x));
        }
    }
    const Box ball = RoundDensity(flatten(Density::sphere({1, 2, 3}, 2), 0.25)).bounding_box();
    CHECK(largest(ball.lo - Vec3(-1, 0, 1)) < 1e-4);
    CHECK(largest(ball.hi - Vec3(3, 4, 5)) < 1e-4);
    const Vec3 axis = glm::normalize(Vec3(1, 2, 2));
    const Box rod = RoundDensity(flatten(Density::cylinder(Vec3(0.0), 3.0 * axis, 0.5), 0.1)).bounding_box();
    for (int k = 0; k < 3; ++k) {
        const double reach = 0.5 * std::sqrt(1 - axis[k] * axis[k]);
        CHECK(rod.hi[k] >= 3 * axis[k] + reach - 0.2);  // the rim is rounded
        CHECK(rod.hi[k] <= 3 * axis[k] + reach + 1e-4);
    }
}

TEST_CASE("sharp densities with round parts are the sets that they name") {
    int inside = 0, fields = 0;
    for (auto seed : seeds(400)) {
        CAPTURE(seed);
        Gen g(seed);
        RoundCase c = test::RoundGen(g, 1e-9).make(1 + g.below(4));
        const SolidTree tree = flatten(Solid::sharp(c.density));
        for (const SolidLeaf& leaf : tree.leaves) fields += leaf.field != nullptr;
        for (int k = 0; k < 100; ++k) {
            const Vec3 x = g.point(1.2);
            // Points so near a surface that rounding decides are left out.
            const double rho = c.plain.density(x, 1e-7);
            if (rho > 0 && rho < 1) continue;
            CHECK(tree.contains(x) == c.plain.contains(x));
            inside += c.plain.contains(x);
        }
    }
    CHECK(inside > 5'000);
    CHECK(fields > 300);
}

TEST_CASE("sharp slanted cylinders and cones have a box that holds them and is near") {
    const Vec3 from(1, 2, 3), axis = glm::normalize(Vec3(1, 2, 2)), to = from + 3.0 * axis;
    const Density rod = Density::cylinder(from, to, 0.5), spike = Density::cone(from, to, 0.5, 0),
                  stump = Density::cone(from, to, 0.5, 0.2);
    for (const Density& d : {rod, spike, stump, rod | Density::sphere(to, 0.5), rod & ~stump}) {
        const Box box = bounding_box(flatten(Solid::sharp(d)));
        REQUIRE(box.finite());
        for (int k = 0; k < 3; ++k) {
            const double reach = 0.5 * std::sqrt(1 - axis[k] * axis[k]);
            CHECK(box.lo[k] <= from[k] - reach);
            CHECK(box.lo[k] >= from[k] - reach - 0.1);
            CHECK(box.hi[k] >= to[k]);
            CHECK(box.hi[k] <= to[k] + 0.5 + 0.1);
        }
    }
}

TEST_CASE("a torus' field holds its range, and its bounds along rays") {
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const double R = g.between(0.3, 2), a = R * g.between(0.05, 1);
        const Torus torus(g.point(1), g.chance(0.5) ? Vec3(0, 1, 0) : g.direction(), R, a);
        const Box box = box_of_any_size(g);
        const Range r = torus.range(box);
        FieldRay ray;
        const double t0 = g.between(0, 3), t1 = t0 + g.between(0.001, 3);
        const Vec3 o = g.point(2), d = g.direction();
        ray.set(torus, o, d, t0, t1);
        const RayBounds b = ray.bounds(t0, t1);
        ValueSlope before = ray.at(t0);
        for (int k = 1; k <= 10; ++k) {
            const double f = torus.at(in(box, g)).value;
            CHECK(f >= r.lo - 1e-12);
            CHECK(f <= r.hi + 1e-12);
            const double t = t0 + (t1 - t0) * k / 10, h = (t1 - t0) / 10;
            const ValueSlope v = ray.at(t);
            CHECK(v.value * ray.noise_scale == Approx(torus.at(o + t * d).value).margin(1e-11));
            CHECK(std::abs(v.value) <= b.M);
            CHECK(std::abs(v.slope) <= b.L);
            CHECK(std::abs(v.slope - before.slope) <= b.G * h + 1e-12);
            before = v;
        }
        // The torus is where the distance from the circle is less than the tube's radius.
        const Vec3 x = g.point(2), y = x - torus.center();
        const double t = glm::dot(y, torus.axis()), q = std::hypot(glm::length(y - t * torus.axis()) - R, t);
        CHECK((torus.at(x).value > 0) == (q < a));
    }
}

TEST_CASE("what has no density is refused") {
    CHECK_THROWS_AS(flatten(Density::torus(Vec3(0.0), {0, 1, 0}, 1, 0.6), 0.5), BadRoundPart);
    CHECK_NOTHROW(flatten(Density::torus(Vec3(0.0), {0, 1, 0}, 1, 0.5), 0.5));
    Affine longer;
    longer.linear[1][1] = 2;
    CHECK_THROWS_AS(flatten(Density::sphere(Vec3(0.0), 1).transformed(longer), 0.1), BadRoundPart);
    // A solid's field accepts any map, since the field is transformed as a whole.
    const SolidTree tree = flatten(Solid::rounded(0.1, Density::sphere(Vec3(0.0), 1)).transformed(longer));
    CHECK(tree.contains({0, 1.99, 0}));
    CHECK(!tree.contains({1.01, 0, 0}));
}
