// The contract of Field, tested with a ball and with transformed fields.
#include "bounds/field.hpp"

#include "ball_field.hpp"
#include "bounds/bounding_box.hpp"
#include "bounds/root_finder.hpp"
#include "bounds/solid_range.hpp"
#include "catch.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

FieldPtr placed_ball(Gen& g) {
    const FieldPtr ball = std::make_shared<BallField>();
    // Two nested transforms, as for a solid in a transformed solid.
    return transformed(transformed(ball, g.map()), g.map());
}

}  // namespace

TEST_CASE("a placed field has the values of the original, and the gradient of its own values") {
    for (auto seed : seeds(500)) {
        CAPTURE(seed);
        Gen g(seed);
        const Affine a = g.map(), b = g.map();
        const FieldPtr field = transformed(transformed(std::make_shared<BallField>(), a), b);
        const Vec3 y = g.point();
        CHECK(field->at(b(a(y))).value == Approx(1 - glm::dot(y, y)).epsilon(1e-9).margin(1e-9));
        const Vec3 x = b(a(y)), d = g.direction();
        const double h = 1e-4, slope = (field->at(x + d * h).value - field->at(x - d * h).value) / (2 * h);
        CHECK(glm::dot(field->at(x).gradient, d) == Approx(slope).epsilon(1e-6).margin(1e-6));
    }
}

TEST_CASE("a placed field's ranges hold its values, and its bounding box the set") {
    int inside = 0;
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const FieldPtr field = placed_ball(g);
        Box box{g.point(2), g.point(2)};
        box = hull({box.lo, box.lo}, {box.hi, box.hi});
        const Range range = field->range(box);
        for (int k = 0; k < 10; ++k) {
            Vec3 x;
            for (int i = 0; i < 3; ++i)
                x[i] = g.chance(0.2) ? box.lo[i] : g.chance(0.2) ? box.hi[i] : g.between(box.lo[i], box.hi[i]);
            const double f = field->at(x).value;
            REQUIRE(f >= range.lo - 1e-12 * (1 - range.lo));
            REQUIRE(f <= range.hi + 1e-12 * (1 - range.lo));
            if (f <= 0) continue;
            ++inside;
            REQUIRE(field->bounding_box().contains(x));
        }
    }
    CHECK(inside > 2'000);
}

TEST_CASE("along a ray a placed field is the field at the ray's points, within M, L and G") {
    for (auto seed : seeds(500)) {
        CAPTURE(seed);
        Gen g(seed);
        const FieldPtr field = placed_ball(g);
        const Vec3 o = g.point(3), d = g.direction();
        FieldRay ray;
        ray.set(*field, o, d, 0.5, 6);
        const double t0 = g.between(0.5, 5), t1 = t0 + g.between(0, 1);
        const RayBounds bounds = ray.bounds(t0, t1);
        const double unit = ray.at(1).value / field->at(o + d).value;
        for (int k = 0; k <= 4; ++k) {
            const double t = t0 + (t1 - t0) * k / 4, h = 1e-4;
            const ValueSlope v = ray.at(t);
            CHECK(v.value == Approx(unit * field->at(o + d * t).value).epsilon(1e-7).margin(1e-12));
            CHECK(v.slope == Approx((ray.at(t + h).value - ray.at(t - h).value) / (2 * h)).epsilon(1e-5).margin(1e-9));
            CHECK(std::abs(v.value) <= bounds.M);
            CHECK(std::abs(v.slope) <= bounds.L * (1 + 1e-12));
        }
        if (t1 > t0) CHECK(std::abs(ray.at(t1).slope - ray.at(t0).slope) <= bounds.G * (t1 - t0) * (1 + 1e-9) + 1e-15);
    }
}

TEST_CASE("a placement that is singular to a double is refused") {
    Affine flat;
    flat.linear[1][1] = 1e-200;
    Affine flatter = flat;
    flatter.linear[1][1] = 1e-320;
    const FieldPtr ball = std::make_shared<BallField>();
    CHECK(transformed(ball, flat));
    CHECK_FALSE(transformed(ball, flatter));
    CHECK_THROWS_AS(flatten(Solid::of_field(ball, 7).transformed(flatter)), SingularPlacement);
}

TEST_CASE("a field is a leaf of the CSG tree: contained, bounded, pruned and counted as one") {
    const Solid ball = Solid::of_field(std::make_shared<BallField>());
    Affine aside;
    aside.shift = {1.5, 0, 0};
    const SolidTree tree = flatten(ball | ball.transformed(aside));
    CHECK(tree.contains({0, 0.9, 0}));
    CHECK(tree.contains({2.4, 0, 0}));
    CHECK_FALSE(tree.contains({0.75, 0.9, 0}));
    CHECK(bounding_box(tree).hi.x == Approx(2.5));
    const Box left{{-1, -1, -1}, {0.4, 1, 1}};
    CHECK(prune(tree, left).leaves.size() == 1);
    CHECK(local_size(tree, left).leaves == 1);
    CHECK(prune(tree, {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}).nodes[0].op == SolidOp::everything);
    CHECK(prune(tree, {{3, 3, 3}, {4, 4, 4}}).nodes[0].op == SolidOp::nothing);
}
