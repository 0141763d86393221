// Convolution of closed meshes with a ball: values, gradients, bounds, ranges and pruning against polyhedra and
// formulas.
#include "bounds/mesh_convolution.hpp"

#include <array>
#include <map>

#include "bounds/mesh_field.hpp"
#include "bounds/root_finder.hpp"
#include "catch.hpp"
#include "closed_shapes.hpp"
#include "random_case.hpp"

using namespace deburr;
using test::Shape;

namespace {

using Corners = ClosedMesh::Corners;
constexpr double pi = test::pi;

Density l_density() { return Density::box({0, 0, 0}, {2, 1, 1}) | Density::box({0, 0, 0}, {1, 2, 1}); }

// A point that is not in general position: on a vertex, edge or face, or where the ball's sphere touches one.
Vec3 adversarial(Gen& g, const ClosedMesh& mesh, double r) {
    const int t = g.below(int(mesh.size()));
    const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2), n = mesh.plane(t).normal;
    const double u = g.between(0, 1), v = g.between(0, 1 - u);
    Vec3 x = g.chance(0.3) ? a : g.chance(0.4) ? a + u * (b - a) : a + u * (b - a) + v * (c - a);
    switch (g.below(5)) {
        case 0: x += g.chance(0.5) ? r * n : -r * n; break;
        case 1: x += r * n + r * g.normal() * std::pow(10.0, g.between(-12, -3)); break;
        case 2: x += r * g.normal() * std::pow(10.0, g.between(-16, 0)); break;
        case 3: x += r * g.between(-1, 1) * n; break;
        default: break;
    }
    return x;
}

// The signed area of the disc of radius r around the origin within the triangle of the origin, a and b.
double area_in_disc(Vec2 a, Vec2 b, double r) {
    const auto angle = [](Vec2 p, Vec2 q) { return std::atan2(p.x * q.y - p.y * q.x, glm::dot(p, q)); };
    const Vec2 d = b - a;
    const double dd = glm::dot(d, d), ad = glm::dot(a, d), root = ad * ad - dd * (glm::dot(a, a) - r * r);
    if (root <= 0) return 0.5 * r * r * angle(a, b);
    const double from = std::clamp((-ad - std::sqrt(root)) / dd, 0.0, 1.0),
                 to = std::clamp((-ad + std::sqrt(root)) / dd, 0.0, 1.0);
    const Vec2 p = a + from * d, q = a + to * d;
    return 0.5 * (r * r * (angle(a, p) + angle(q, b)) + p.x * q.y - p.y * q.x);
}

}  // namespace

TEST_CASE("the areas of faces in two balls are those of their given triangles in two discs") {
    const ClosedMesh meshes[] = {Shape::l_prism().mesh(), Shape::sphere(1, 12).mesh()};
    int partial = 0, missing = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const ClosedMesh& mesh = meshes[g.below(2)];
        const double least = g.chance(0.1) ? 0 : std::pow(10.0, g.between(-1, 0.3)), greatest = least + g.between(0, 1);
        // The definition by sectors is not sure where the centre's foot is on an edge's line.
        const Vec3 x = g.chance(0.5) ? adversarial(g, mesh, greatest) + 1e-3 * g.direction()
                                     : Vec3(g.between(-1, 2), g.between(-1, 2), g.between(-1, 2));
        std::vector<int> given;
        mesh.near({x, x}, greatest, given);
        const std::size_t all = given.size();
        if (g.chance(0.3)) std::erase_if(given, [&](int) { return g.chance(0.2); });
        missing += given.size() < all;
        std::map<int, std::array<double, 2>> expected;  // by plane
        for (const int t : given) {
            const ClosedMesh::Plane& plane = mesh.plane(t);
            const Vec3 u = glm::normalize(mesh.corner(t, 1) - mesh.corner(t, 0)), v = glm::cross(plane.normal, u);
            const double h = plane.offset - glm::dot(plane.normal, x);
            for (int ball = 0; ball < 2; ++ball) {
                const double r = ball == 0 ? least : greatest, disc = std::sqrt(std::max(0.0, r * r - h * h));
                for (int k = 0; k < 3 && disc > 0; ++k) {
                    const Vec3 a = mesh.corner(t, k) - x, b = mesh.corner(t, (k + 1) % 3) - x;
                    expected[plane.id][std::size_t(ball)] +=
                        area_in_disc({glm::dot(u, a), glm::dot(v, a)}, {glm::dot(u, b), glm::dot(v, b)}, disc);
                }
            }
        }
        std::vector<FaceAreas> found;
        face_areas(mesh, given, x, least, greatest, found);
        for (const FaceAreas& f : found) {
            const std::array<double, 2> areas = expected[mesh.plane(f.triangle).id];
            CHECK(std::abs(f.in_least - areas[0]) <= 1e-9);
            CHECK(std::abs(f.in_greatest - areas[1]) <= 1e-9);
            partial += f.in_least > 0 && f.in_least < f.in_greatest;
            expected.erase(mesh.plane(f.triangle).id);
        }
        for (const auto& [plane, areas] : expected) CHECK(areas[1] <= 1e-9);
    }
    CHECK(partial > 3'000);
    CHECK(missing > 500);
}

TEST_CASE("the share of a ball in a mesh is the convolution of the polyhedron that it bounds") {
    int varied = 0;
    for (auto seed : seeds(20'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const bool bent = g.chance(0.5), special = g.chance(0.5);
        const Shape shape = bent ? Shape::l_prism() : Shape::box({0, 0, 0}, {2, 1, 1});
        const Density density = bent ? l_density() : Density::box({0, 0, 0}, {2, 1, 1});
        const ClosedMesh mesh = shape.mesh();
        const double r = std::pow(10.0, special ? g.between(-6, 0.7) : g.between(-1, 0.7));
        const Vec3 x = special ? adversarial(g, mesh, r) : Vec3(g.between(-1, 3), g.between(-1, 3), g.between(-1, 2));
        const ValueGradient expected = flatten_convolved(density, r).gradient_at(x), got = ball_share(mesh, x, r);
        CAPTURE(x.x, x.y, x.z, r, got.value, expected.value);
        // Where the sphere touches an edge or a plane, a rounding error of 10⁻¹⁶ becomes a chord of length 10⁻⁸.
        CHECK(std::abs(got.value - expected.value) <= (special ? 2e-8 : 1e-12));
        CHECK(r * largest(got.gradient - expected.gradient) <= (special ? 1e-7 : 1e-11));
        varied += expected.value > 0 && expected.value < 1;
    }
    CHECK(varied > 10'000);
}

TEST_CASE("the share does not depend on how a solid's faces are triangulated") {
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        Shape coarse = Shape::l_prism(), fine = coarse;
        // Each triangle is split at a point inside it, or on an edge whose other triangle is split at the same point.
        for (int k = 0; k < 30; ++k) {
            const std::size_t t = std::size_t(g.below(int(fine.triangles.size())));
            const Corners c = fine.triangles[t];
            const double u = g.between(0.05, 0.9), v = g.between(0.05, 0.95 - u);
            const int m = int(fine.vertices.size());
            fine.vertices.push_back(fine.vertices[c[0]] * (1 - u - v) + fine.vertices[c[1]] * u +
                                    fine.vertices[c[2]] * v);
            fine.triangles[t] = {c[0], c[1], m};
            fine.triangles.push_back({c[1], c[2], m});
            fine.triangles.push_back({c[2], c[0], m});
        }
        const ClosedMesh a = coarse.mesh(), b = fine.mesh();
        CHECK(a.planes() == 8);
        CHECK(b.planes() == 8);
        const double r = std::pow(10.0, g.between(-1, 0.5));
        const Vec3 x = g.near(flatten_convolved(l_density(), r), r);
        CHECK(std::abs(ball_share(a, x, r).value - ball_share(b, x, r).value) <= 1e-12);
    }
}

TEST_CASE("the share near a finely tessellated sphere is that of two balls") {
    const double radius = 1;
    const ClosedMesh mesh = Shape::sphere(radius, 200).mesh();
    int inside = 0;
    for (auto seed : seeds(300)) {
        CAPTURE(seed);
        Gen g(seed);
        const double r = g.between(0.05, 0.95), k = r / radius, a = g.between(-1, 1);
        const Vec3 x = g.normal() * (radius + a * r);
        const double expected = (1 - a) * (1 - a) * (4 * (2 + a) - k * (1 - a) * (3 + a)) / (16 * (1 + k * a));
        if (radius + a * r < 0) continue;
        CHECK(std::abs(ball_share(mesh, x, r).value - expected) <= 4e-4 / r);
        ++inside;
    }
    CHECK(inside > 200);
}

TEST_CASE("a fan of a thousand triangles around a vertex has the share of its solid") {
    // A right cone of height 1 over a polygon of a thousand sides, close to a circle of radius 1.
    Shape cone;
    const int sides = 1000;
    cone.vertices = {{0, 0, 1}, {0, 0, 0}};
    for (int k = 0; k < sides; ++k)
        cone.vertices.push_back({std::cos(2 * pi * k / sides), std::sin(2 * pi * k / sides), 0});
    for (int k = 0; k < sides; ++k) {
        const int a = 2 + k, b = 2 + (k + 1) % sides;
        cone.triangles.push_back({0, a, b});
        cone.triangles.push_back({1, b, a});
    }
    const ClosedMesh mesh = cone.mesh();
    // A ball around the apex, no larger than the height: the cone's share is that of a sector of half-angle 45°.
    const double sector = (1 - std::sqrt(0.5)) / 2;
    for (const double r : {0.1, 0.3, 0.7}) CHECK(std::abs(ball_share(mesh, {0, 0, 1}, r).value - sector) < 1e-5);
    // A ball that holds the whole cone: its share is the ratio of the volumes.
    const double volume = 0.5 * sides * std::sin(2 * pi / sides) / 3;
    CHECK(std::abs(ball_share(mesh, {0, 0, 0}, 5).value - volume / (4 * pi / 3 * 125)) < 1e-14);
    CHECK(std::abs(mesh.volume() - volume) < 1e-12);
}

TEST_CASE("shares of a cavity and of what fills it add up") {
    Shape outer = Shape::box({-1, -1, -1}, {1, 1, 1}), inner = Shape::box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3});
    Shape shell = outer;
    for (const Corners& t : inner.triangles) shell.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
    shell.vertices.insert(shell.vertices.end(), inner.vertices.begin(), inner.vertices.end());
    const ClosedMesh a = outer.mesh(), b = inner.mesh(), c = shell.mesh();
    for (auto seed : seeds(5'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const double r = std::pow(10.0, g.between(-1.5, 0.5));
        const Vec3 x = g.chance(0.3) ? adversarial(g, c, r) : g.point(1.3);
        CHECK(std::abs(ball_share(c, x, r).value + ball_share(b, x, r).value - ball_share(a, x, r).value) <= 3e-8);
    }
}

namespace {

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

TEST_CASE("a share is right where a triangle that the sphere cuts is not among those that are given") {
    const ClosedMesh mesh = Shape::l_prism().mesh();
    int cut = 0;
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const double r = g.between(0.1, 1);
        const Vec3 x = adversarial(g, mesh, r);
        std::vector<int> near;
        mesh.near({x, x}, r, near);
        if (near.size() < 2) continue;
        const ValueGradient all = ball_share(mesh, x, r);
        // The sphere cuts the border of the missing triangle: some of its corners are inside the sphere and some
        // outside.
        const int missing = near[std::size_t(g.below(int(near.size())))];
        int corners = 0;
        for (int k = 0; k < 3; ++k) corners += glm::distance(mesh.corner(missing, k), x) < 0.99 * r;
        bool far = false;
        for (int k = 0; k < 3; ++k) far |= glm::distance(mesh.corner(missing, k), x) > 1.01 * r;
        if (corners == 0 || !far) continue;
        std::erase(near, missing);
        CHECK(std::abs(ball_share(mesh, near, x, r).value - all.value) <= 1e-12);
        ++cut;
    }
    CHECK(cut > 300);
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

TEST_CASE("an open mesh is told with the number of its open edges, and where one is") {
    Shape box = Shape::box({0, 0, 0}, {1, 1, 1});
    box.triangles.pop_back();
    try {
        box.mesh();
        CHECK(false);
    } catch (const NotClosed& error) {
        CHECK(error.count == 3);
    }
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
