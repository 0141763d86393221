// Convolution of closed meshes with a ball, and areas of faces in balls, against polyhedra and formulas.
#include "bounds/mesh_convolution.hpp"

#include <array>
#include <map>

#include "catch.hpp"
#include "closed_shapes.hpp"
#include "random_case.hpp"

using namespace deburr;
using test::Shape;

namespace {

using Corners = ClosedMesh::Corners;

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
