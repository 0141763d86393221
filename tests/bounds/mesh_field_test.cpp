// Closed meshes as fields: values, bounds along rays, ranges over boxes, pruning, and what is simpler in a box.
#include "bounds/mesh_field.hpp"

#include "bounds/root_finder.hpp"
#include "catch.hpp"
#include "closed_shapes.hpp"
#include "random_case.hpp"

using namespace deburr;
using test::Shape;

namespace {

using Corners = ClosedMesh::Corners;

Shape random_shape(Gen& g) {
    Shape shape = g.chance(0.4)   ? Shape::l_prism()
                  : g.chance(0.5) ? Shape::box({0, 0, 0}, {g.between(0.1, 2), 1, 1})
                                  : Shape::sphere(1, 3 + g.below(6));
    if (g.chance(0.7)) shape.rotate(g);
    return shape;
}

}  // namespace

TEST_CASE("the gradient is that of the share, and M, L and G bound it along every ray") {
    int varied = 0;
    double tightest = 0;
    for (auto seed : seeds(4'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const auto mesh = std::make_shared<ClosedMesh>(random_shape(g).mesh());
        const double r = std::pow(10.0, g.between(-1, 0.3));
        const MeshField field(mesh, r);
        const int t = g.below(int(mesh->size()));
        const Vec3 on = (mesh->corner(t, 0) + mesh->corner(t, 1) + mesh->corner(t, 2)) / 3.0;
        const Vec3 start = on + r * g.between(0, 1) * g.normal(), u = g.normal() * g.between(0.5, 2);
        const double length = r * std::pow(10.0, g.between(-2, 0.3));
        FieldRay ray;
        ray.set(field, start, u, 0, length);
        const RayBounds b = ray.bounds(0, length);
        const double unit = ray.noise_scale;
        constexpr int steps = 24;
        double before = 0, slope_before = 0;
        for (int i = 0; i <= steps; ++i) {
            const double at = length * i / steps, h = length / steps;
            const ValueSlope v = ray.at(at);
            const ValueGradient w = field.at(start + at * u);
            CHECK(std::abs(v.value * unit - w.value) <= 1e-12);
            CHECK(std::abs(v.slope * unit - glm::dot(w.gradient, u)) <= 1e-10 / r);
            CHECK(std::abs(v.value) <= b.M * (1 + 1e-12));
            CHECK(std::abs(v.slope) <= b.L * (1 + 1e-9) + 1e-14);
            if (i > 0) {
                // Values and slopes change between samples by no more than the bounds allow.
                CHECK(std::abs(v.value - before) <= b.L * h * (1 + 1e-9) + 1e-14);
                CHECK(std::abs(v.slope - slope_before) <= b.G * h * (1 + 1e-9) + 1e-12 / r);
                CHECK(std::abs(v.value - before - 0.5 * h * (v.slope + slope_before)) <= 0.25 * b.G * h * h + 1e-12);
                if (b.G > 0) tightest = std::max(tightest, std::abs(v.slope - slope_before) / (b.G * h));
                varied += v.value != before;
            }
            before = v.value;
            slope_before = v.slope;
        }
    }
    CHECK(varied > 30'000);
    CHECK(tightest > 0.5);
}

TEST_CASE("ranges over boxes hold the share and its rate, and what is pruned to a box is the same there") {
    int straddling = 0, decided = 0, dense = 0, falling = 0;
    for (auto seed : seeds(6'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const auto mesh = std::make_shared<ClosedMesh>(random_shape(g).mesh());
        const double r = std::pow(10.0, g.between(-1, 0));
        FieldPtr field = std::make_shared<MeshField>(mesh, r);
        Affine map;
        if (g.chance(0.3)) {
            map = g.map();
            field = transformed(field, map);
        }
        const int t = g.below(int(mesh->size()));
        Vec3 center = map((mesh->corner(t, 0) + mesh->corner(t, 1) + mesh->corner(t, 2)) / 3.0);
        center += r * g.between(0, 1.5) * g.normal();
        const Vec3 half =
            r * std::pow(10.0, g.between(-2, 0.5)) * Vec3(g.between(0.1, 1), g.between(0.1, 1), g.between(0.1, 1));
        const Box box{center - half, center + half};
        const FieldPtr local = field->prune(box) ? field->prune(box) : field;
        const Box inner{center - 0.7 * half, center + 0.6 * half};
        const Range range = local->range(inner), wide = field->range(box);
        const Vec3 n = g.normal();
        const Range rates = local->rate_range(inner, n);
        const auto density = local->as_density(inner);
        const std::optional<LocalDensity> as_density = density ? std::optional<LocalDensity>(*density) : std::nullopt;
        dense += density.has_value();
        falling += rates.hi < 0 || rates.lo > 0;
        (classify_field(range) == Side::straddling ? straddling : decided) += 1;
        for (int k = 0; k < 12; ++k) {
            const Vec3 x = inner.lo + Vec3(g.between(0, 1), g.between(0, 1), g.between(0, 1)) * (inner.hi - inner.lo);
            const ValueGradient v = field->at(x), w = local->at(x);
            CHECK(std::abs(v.value - w.value) <= 1e-9);
            CHECK(v.value >= range.lo - 1e-9);
            CHECK(v.value <= range.hi + 1e-9);
            CHECK(v.value >= wide.lo - 1e-9);
            CHECK(v.value <= wide.hi + 1e-9);
            CHECK(glm::dot(v.gradient, n) >= rates.lo - 1e-7 / r);
            CHECK(glm::dot(v.gradient, n) <= rates.hi + 1e-7 / r);
            if (as_density) CHECK(std::abs(as_density->at(x) - 0.5 - v.value) <= 1e-8);
        }
    }
    CHECK(straddling > 500);
    CHECK(decided > 500);
    CHECK(dense > 500);
    CHECK(falling > 300);
}

TEST_CASE("what is pruned to a box tells inside from outside where none of its triangles is near") {
    // The box reaches from the middle of a cavity through its far wall to where the outer face is near. The outer face
    // is nearer to the cavity's middle than that wall is, but the cavity's side between the two is farther from the box
    // than the radius.
    Shape shell = Shape::prism({{-5, -5}, {10, -5}, {10, 0.4}, {-5, 4.4}}, {{0, 1, 2}, {0, 2, 3}}, -5, 5);
    const Shape cavity = Shape::box({-2, -2, -3}, {4, 1.5, 3});
    const int before = int(shell.vertices.size());
    for (const Corners& t : cavity.triangles) shell.triangles.push_back({t[0] + before, t[2] + before, t[1] + before});
    shell.vertices.insert(shell.vertices.end(), cavity.vertices.begin(), cavity.vertices.end());
    const MeshField field(std::make_shared<ClosedMesh>(shell.mesh()), 0.5);
    const Box box{{0, 0, 0}, {10.2, 0.05, 0.05}};
    const FieldPtr local = field.prune(box);
    REQUIRE(local);
    CHECK(field.at(box.lo).value == -0.5);
    CHECK(local->at(box.lo).value == -0.5);
    CHECK(local->at({6, 0, 0}).value == 0.5);
}

TEST_CASE("a share falls in every direction that all triangles face, however large the box") {
    const MeshField field(std::make_shared<ClosedMesh>(Shape::sphere(1, 12).mesh()), 0.05);
    const Box cap{{-0.4, -0.4, 0.85}, {0.4, 0.4, 1.1}};
    CHECK(field.rate_range(cap, {0, 0, 1}).hi <= 0);
    CHECK(field.rate_range(cap, {0, 0, -1}).lo >= 0);
    CHECK(field.rate_range(cap, {1, 0, 0}).hi > 0);
}

TEST_CASE(
    "where all planes that reach a box have a direction in common the share does not change along it, and the field "
    "knows it") {
    int swept = 0, along_prism = 0, other = 0;
    for (auto seed : seeds(500)) {
        CAPTURE(seed);
        Gen g(seed);
        const Mat3 turn = g.map(false).linear;
        Shape prism = Shape::l_prism();
        for (Vec3& v : prism.vertices) v = turn * (v * Vec3(1, 1, 5));
        const double r = g.between(0.2, 0.6);
        const MeshField field(std::make_shared<ClosedMesh>(prism.mesh()), r);
        CHECK(!field.swept_along());
        const Vec3 center = turn * Vec3(g.between(0, 2), g.between(0, 2), g.between(-1, 6));
        const Box box = inflated(Box{center, center}, 0.1);
        const FieldPtr part = field.prune(box);
        if (!part) continue;
        const std::optional<Vec3> along = part->swept_along();
        if (!along) {
            ++other;
            continue;
        }
        ++swept;
        along_prism += std::abs(glm::dot(*along, turn[2])) > 1 - 1e-12;
        for (const double t : {-0.1, 0.05, 0.1})
            CHECK(std::abs(part->at(center + t * *along).value - part->at(center).value) <= 1e-12);
    }
    CHECK(swept > along_prism);
    CHECK(along_prism > 100);
    CHECK(other > 50);
}

TEST_CASE("a cell without an end holds no more of a mesh than its finite part") {
    const MeshField field(std::make_shared<ClosedMesh>(Shape::sphere(1, 40).mesh()), 0.01);
    const Box left{{-infinity, -infinity, -infinity}, {-0.2, infinity, infinity}},
        cap{{-infinity, -infinity, -infinity}, {-0.98, infinity, infinity}};
    const FieldPtr local = field.prune(left);
    REQUIRE(local);
    CHECK(local->local_size(cap).half_spaces < field.size() / 20);
    CHECK(local->local_size({{-infinity, -infinity, 2}, {-0.2, infinity, infinity}}).range.hi <= 0);
    // For a large box with many triangles the number is only an upper bound.
    CHECK(local->local_size({{-1.1, -1.1, -1.1}, {-0.5, 1.1, 1.1}}).half_spaces >= field.size() / 8);
}

TEST_CASE("facets of a face that is bent by rounding make no wedge") {
    // The cube's top face has a vertex in its middle, which is off the plane by `off`.
    for (const double off : {1e-11, -1e-11}) {
        std::vector<Vec3> v;
        for (int i = 0; i < 8; ++i) v.push_back(Vec3(i & 1, i >> 1 & 1, i >> 2));
        v.push_back({0.4, 0.3, 1 + off});
        std::vector<ClosedMesh::Corners> t{{0, 2, 1}, {1, 2, 3}, {0, 1, 4}, {1, 5, 4}, {1, 3, 5}, {3, 7, 5}, {3, 2, 7},
                                           {2, 6, 7}, {2, 0, 6}, {0, 4, 6}, {4, 5, 8}, {5, 7, 8}, {7, 6, 8}, {6, 4, 8}};
        const MeshField field(std::make_shared<ClosedMesh>(v, t), 0.05);
        CHECK(field.mesh().planes() == 9);
        int known = 0;
        for (auto seed : seeds(500)) {
            CAPTURE(off, seed);
            Gen g(seed);
            const Vec3 x(g.between(0.1, 0.9), g.between(0.1, 0.9), 1);
            const auto density = field.as_density(inflated({x, x}, 0.01));
            if (!density) continue;
            ++known;
            CHECK(density->half_spaces.size() == 1);
            CHECK(density->at(x) == Approx(0.5).margin(1e-9));
        }
        CHECK(known > 100);
    }
}
