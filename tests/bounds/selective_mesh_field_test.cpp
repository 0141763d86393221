// Meshes rounded by a varying radius: gradients, bounds and ranges hold, faces stay flat, and kept edges are sharp.
#include "bounds/selective_mesh_field.hpp"

#include "catch.hpp"
#include "closed_shapes.hpp"

using namespace deburr;
using test::Shape;

namespace {

constexpr double radius = 0.2;

struct KeptCase {
    SelectiveMeshField field;
    Vec3 lo, hi;  // the corners of the box that is sampled
};

// An L-shaped prism, rotated or not, with kept edges, a kept region or both.
KeptCase random_case(Gen& g) {
    Shape shape = Shape::l_prism();
    if (g.chance(0.5)) shape.rotate(g);
    const auto mesh = std::make_shared<const ClosedMesh>(shape.vertices, shape.triangles);
    KeptEdges kept;
    kept.fade = g.between(1.5, 5) * radius;
    const Box box = mesh->bounding_box();
    const bool edges = g.chance(0.6);
    if (edges) kept.edges = g.chance(0.5) ? KeptEdges::Kind::convex : KeptEdges::Kind::concave;
    if (!edges || g.chance(0.5)) {
        Box region{g.point(1) + 0.5 * (box.lo + box.hi), Vec3(0.0)};
        region.hi = region.lo + Vec3(g.between(0.1, 1), g.between(0.1, 1), g.chance(0.3) ? infinity : 0.7);
        kept.regions.push_back(region);
    }
    return {SelectiveMeshField(mesh, radius, kept), box.lo - radius, box.hi + radius};
}

// A random point, in four cases of five near the surface.
Vec3 point(Gen& g, const KeptCase& c) {
    const ClosedMesh& mesh = c.field.full().mesh();
    if (g.chance(0.2)) return c.lo + Vec3(g.number(), g.number(), g.number()) * (c.hi - c.lo);
    const int t = g.below(int(mesh.size()));
    const double u = g.number(), v = g.number() * (1 - u);
    return mesh.corner(t, 0) + u * (mesh.corner(t, 1) - mesh.corner(t, 0)) +
           v * (mesh.corner(t, 2) - mesh.corner(t, 0)) + radius * g.point(1);
}

}  // namespace

TEST_CASE("a radius that varies: the gradient is that of the share") {
    int varying = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const KeptCase c = random_case(g);
        const Vec3 x = point(g, c), u = g.direction();
        const double h = 1e-6, there = c.field.at(x + h * u).value, back = c.field.at(x - h * u).value;
        const double slope = glm::dot(c.field.at(x).gradient, u), found = (there - back) / (2 * h);
        // Steep places are left out: there the radius is so small that the finite difference is not accurate.
        if (std::abs(slope) > 0.02 / h * 1e-3) continue;
        varying += slope != 0;
        CHECK(std::abs(slope - found) < 1e-4 * (1 + std::abs(slope)) + 4e-3);
    }
    CHECK(varying > 1'000);
}

TEST_CASE("a radius that varies: M, L and G hold along rays") {
    double tightest = 0;
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const KeptCase c = random_case(g);
        const Vec3 o = point(g, c), d = g.direction();
        const double length = g.between(0.01, 0.4);
        FieldRay ray;
        ray.set(c.field, o, d, 0, length);
        const RayBounds bounds = ray.bounds(0, length);
        constexpr int steps = 20;
        ValueSlope before = ray.at(0);
        for (int k = 1; k <= steps; ++k) {
            const double step = length / steps;
            const ValueSlope now = ray.at(k * step);
            CHECK(std::abs(now.value) <= bounds.M * (1 + 1e-9));
            CHECK(std::abs(now.slope) <= bounds.L * (1 + 1e-9) + 1e-12);
            CHECK(std::abs(now.slope - before.slope) <= bounds.G * step * (1 + 1e-9) + 1e-10);
            tightest = std::max(tightest, std::abs(now.slope) / (bounds.L + 1e-12));
            before = now;
        }
    }
    CHECK(tightest > 0.5);
}

TEST_CASE("a radius that varies: ranges and rates over boxes hold, and parts are the same field") {
    int narrow = 0;
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const KeptCase c = random_case(g);
        const Vec3 at = point(g, c), size(g.between(0.001, 0.15));
        const Box box{at, at + size};
        const Range f = c.field.range(box);
        const Vec3 u = g.direction();
        const Range rate = c.field.rate_range(box, u);
        const FieldPtr part = c.field.prune(box);
        const auto density = c.field.as_density(box);
        narrow += f.hi - f.lo < 0.9;
        for (int k = 0; k < 8; ++k) {
            const Vec3 x = box.lo + Vec3(g.number(), g.number(), g.number()) * size;
            const ValueGradient v = c.field.at(x);
            CHECK(v.value >= f.lo - 1e-12);
            CHECK(v.value <= f.hi + 1e-12);
            const double along = glm::dot(v.gradient, u);
            CHECK(along >= rate.lo - 1e-9 * (1 + std::abs(along)));
            CHECK(along <= rate.hi + 1e-9 * (1 + std::abs(along)));
            if (part) CHECK(std::abs(part->at(x).value - v.value) < 1e-7);
            if (density && std::abs(v.value) > 1e-6) CHECK((density->at(x) > 0.5) == (v.value > 0));
        }
    }
    CHECK(narrow > 500);
}

TEST_CASE("kept edges are sharp to a thousandth of the radius, others are rounded, and faces are flat") {
    const auto mesh = std::make_shared<const ClosedMesh>(Shape::l_prism().mesh());  // concave along z at (1, 1)
    KeptEdges kept;
    kept.fade = 3 * radius;
    kept.edges = KeptEdges::Kind::concave;
    const SelectiveMeshField convex_only(mesh, radius, kept);
    const double beside = 0.002 * radius;
    CHECK(convex_only.at({1 + beside, 1 + beside, 0.5}).value < 0);  // the concave edge is not filled
    CHECK(convex_only.full().at({1 + beside, 1 + beside, 0.5}).value > 0);
    CHECK(convex_only.at({beside, beside, 0.5}).value < 0);  // a convex edge is rounded off
    kept.edges = KeptEdges::Kind::convex;
    const SelectiveMeshField concave_only(mesh, radius, kept);
    CHECK(concave_only.at({1 + beside, 1 + beside, 0.5}).value > 0);
    CHECK(concave_only.at({beside, beside, 0.5}).value > 0);
    CHECK(concave_only.full().at({beside, beside, 0.5}).value < 0);
    kept.edges = KeptEdges::Kind::none;
    kept.regions = {{{-infinity, -infinity, -infinity}, {infinity, infinity, 0.3}}};
    const SelectiveMeshField upper(mesh, radius, kept);
    CHECK(upper.at({beside, beside, 0.2}).value > 0);
    CHECK(upper.at({beside, beside, 0.95}).value < 0);
    int on_faces = 0;
    for (auto seed : seeds(500)) {
        CAPTURE(seed);
        Gen g(seed);
        // A point on the face y = 0, farther than the radius from its edges.
        const Vec3 x(g.between(radius, 2 - radius), 0, g.between(radius, 1 - radius));
        for (const SelectiveMeshField* field : {&convex_only, &concave_only, &upper}) {
            CHECK(std::abs(field->at(x).value) < 1e-12);
            ++on_faces;
        }
    }
    CHECK(on_faces > 0);
}

TEST_CASE("how an edge is divided does not matter to the radius beside it") {
    // The same L-shaped prism in three slices, which cut its edges in three.
    Shape once = Shape::l_prism(), thrice;
    std::vector<Vec2> outline{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    const std::vector<Shape::Corners> fan{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    KeptEdges kept;
    kept.fade = 3 * radius;
    kept.edges = KeptEdges::Kind::concave;
    for (int k = 0; k < 3; ++k) {
        const Shape part = Shape::prism(outline, fan, k / 3.0, (k + 1) / 3.0);
        const int first = int(thrice.vertices.size());
        thrice.vertices.insert(thrice.vertices.end(), part.vertices.begin(), part.vertices.end());
        for (std::size_t t = 0; t < part.triangles.size(); ++t) {
            const auto& c = part.triangles[t];
            const double z = part.vertices[c[0]].z + part.vertices[c[1]].z + part.vertices[c[2]].z;
            const bool is_end = z == 3 * part.vertices[0].z || z == 3 * part.vertices[outline.size()].z;
            if (is_end && !((k == 0 && z == 0) || (k == 2 && z > 2.5))) continue;
            thrice.triangles.push_back({c[0] + first, c[1] + first, c[2] + first});
        }
    }
    // The vertices between two slices are doubled; join them.
    for (auto& t : thrice.triangles)
        for (int& v : t)
            for (int w = 0; w < v; ++w)
                if (glm::distance(thrice.vertices[w], thrice.vertices[v]) < 1e-12) v = w;
    const auto a = std::make_shared<const ClosedMesh>(once.mesh()),
               b = std::make_shared<const ClosedMesh>(thrice.mesh());
    const SelectiveMeshField one(a, radius, kept), three(b, radius, kept);
    int varying = 0;
    for (auto seed : seeds(500)) {
        CAPTURE(seed);
        Gen g(seed);
        const Vec3 x(g.between(0.5, 1.6), g.between(0.5, 1.6), g.between(-0.1, 1.1));
        const double f = one.at(x).value;
        varying += std::abs(f) < 0.49;
        CHECK(std::abs(f - three.at(x).value) < 1e-6);
    }
    CHECK(varying > 50);
}
