// Rays against models and their meshes, held against the definition: a ball's share with all triangles.
#include "bounds/mesh_convolution.hpp"
#include "bounds/mesh_field.hpp"
#include "catch.hpp"
#include "closed_shapes.hpp"
#include "raytracer/mesh/scene_mesh.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

using namespace deburr;
using test::Shape;

namespace {

ClosedMeshPtr shared(const Shape& shape) { return std::make_shared<ClosedMesh>(shape.vertices, shape.triangles); }

Shape random_model(Gen& g, int kind) {
    Shape shape = kind == 0   ? Shape::l_prism()
                  : kind == 1 ? Shape::cavity({-1, -1, -1}, {1, 1, 1}, {-0.6, -0.5, -0.4}, {0.6, 0.5, 0.7})
                  : kind == 2 ? Shape::sphere(1, 4 + g.below(8))
                              : Shape::plate_with_hole(0.3 + 0.4 * g.between(0, 1), 8 + 4 * g.below(6), 0.5);
    if (g.chance(0.5)) shape.rotate(g);
    return shape;
}

Solid rounded(const ClosedMeshPtr& mesh, double r) { return Solid::of_field(std::make_shared<MeshField>(mesh, r)); }

// First t where the share of the ball around the ray's point passes ½, by steps that are small compared with r;
// infinity if none.
double first_half_share(const ClosedMesh& mesh, double r, const Ray& ray, double length) {
    const auto inside = [&](double t) { return ball_share(mesh, ray.origin + t * ray.direction, r).value > 0.5; };
    const double step = r / 24;
    const bool start = inside(0);
    for (double t = step; t < length; t += step) {
        if (inside(t) == start) continue;
        double lo = t - step, hi = t;
        for (int k = 0; k < 60; ++k) (inside(0.5 * (lo + hi)) == start ? lo : hi) = 0.5 * (lo + hi);
        return lo;
    }
    return infinity;
}

}  // namespace

TEST_CASE("rays meet a rounded model where the share of a ball is a half", "[slow]") {
    int hits = 0, misses = 0, grazing = 0;
    for (auto seed : seeds(40)) {
        Gen g(seed);
        const int kind = g.below(4);
        const ClosedMeshPtr mesh = shared(random_model(g, kind));
        const double r = g.between(0.08, 0.3);
        const ImplicitTracer tracer({rounded(mesh, r)});
        TraceCounters counters;
        for (int k = 0; k < 60; ++k) {
            CAPTURE(seed, k, kind, r);
            const Vec3 target = g.point(1), away = 4.0 * g.direction();
            const Ray ray{target + away, glm::normalize(-away)};
            const Hit hit = tracer.closest_hit(ray, infinity, counters);
            const double expected = first_half_share(*mesh, r, ray, 8);
            if (hit && hit.t < expected - 1e-6) {
                // The definition is sampled only at points and stepped over a grazing hit.
                const auto f = [&](double t) {
                    return ball_share(*mesh, ray.origin + t * ray.direction, r).value - 0.5;
                };
                CHECK(std::abs(f(hit.t)) < 1e-9);
                ++grazing;
                continue;
            }
            REQUIRE(bool(hit) == (expected < infinity));
            if (!hit) {
                ++misses;
                continue;
            }
            ++hits;
            CHECK(std::abs(hit.t - expected) < 1e-7);
            const Vec3 down = ball_share(*mesh, ray.origin + expected * ray.direction, r).gradient;
            CHECK(glm::dot(hit.normal, -glm::normalize(down)) > 1 - 1e-6);
        }
    }
    CHECK(hits > 700);
    CHECK(misses > 300);
    CHECK(grazing < 10);
}

TEST_CASE("rays meet a sharp model where its triangles are") {
    int hits = 0, misses = 0;
    for (auto seed : seeds(40)) {
        Gen g(seed);
        const ClosedMeshPtr mesh = shared(random_model(g, g.below(4)));
        const ImplicitTracer tracer({rounded(mesh, 0)});
        TraceCounters counters;
        for (int k = 0; k < 100; ++k) {
            CAPTURE(seed, k);
            const Vec3 target = g.point(1), away = 4.0 * g.direction();
            const Ray ray{target + away, glm::normalize(-away)};
            const Hit hit = tracer.closest_hit(ray, infinity, counters);
            double expected = infinity, nearest_edge = infinity;
            for (int t = 0; t < int(mesh->size()); ++t) {
                const auto& plane = mesh->plane(t);
                const double rate = glm::dot(plane.normal, ray.direction);
                const double at = (plane.offset - glm::dot(plane.normal, ray.origin)) / rate;
                const Vec3 x = ray.origin + at * ray.direction;
                double inside = infinity;
                for (int e = 0; e < 3; ++e) {
                    const Vec3 a = mesh->corner(t, e), b = mesh->corner(t, (e + 1) % 3);
                    inside = std::min(inside, glm::dot(glm::cross(plane.normal, glm::normalize(b - a)), x - a));
                }
                nearest_edge = std::min(nearest_edge, std::abs(inside));
                if (inside > 0) expected = std::min(expected, at);
            }
            if (nearest_edge < 1e-6) continue;
            REQUIRE(bool(hit) == (expected < infinity));
            CAPTURE(hit.t, expected, nearest_edge, hit.normal.x, hit.normal.y, hit.normal.z, mesh->size());
            if (hit) CHECK(std::abs(hit.t - expected) < 1e-7);
            ++(hit ? hits : misses);
        }
    }
    CHECK(hits > 1500);
    CHECK(misses > 500);
}

TEST_CASE("meshes of rounded models are closed, right and near the surface") {
    for (auto seed : seeds(4)) {
        Gen g(seed);
        const int kind = int(seed % 4);
        const ClosedMeshPtr mesh = shared(random_model(g, kind));
        CAPTURE(seed, kind);
        Scene scene;
        scene.file = "test";
        scene.materials.push_back({});
        scene.solids.push_back(rounded(mesh, g.between(0.1, 0.25)));
        scene.names.push_back("");
        MeshSettings settings;
        settings.check = true;
        const SceneMesh made = mesh_scene(scene, settings);
        REQUIRE(made.checks.size() == 1);
        CHECK(made.checks[0].faults() == 0);
        CHECK(made.methods == std::vector{MeshMethod::triage});
        CHECK(topology(made.mesh).manifold());
        // Rounding shrinks a convex solid, by no more than the filter's reach.
        if (kind != 2) continue;
        CHECK(volume(made.mesh) < mesh->volume());
        CHECK(volume(made.mesh) > 0.85 * mesh->volume());
    }
}

TEST_CASE("a sharp model that touches itself in an edge has a mesh that is a manifold") {
    Shape two = Shape::box({0, 0, 0}, {1, 1, 1});
    const Shape other = Shape::box({1, 1, 0}, {2, 2, 1});
    // Both boxes share the edge from (1, 1, 0) to (1, 1, 1).
    std::vector<int> number;
    for (const Vec3& v : other.vertices) {
        const auto at = std::find(two.vertices.begin(), two.vertices.end(), v);
        number.push_back(int(at - two.vertices.begin()));
        if (at == two.vertices.end()) two.vertices.push_back(v);
    }
    for (const auto& t : other.triangles) two.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
    Scene scene;
    scene.file = "test";
    scene.materials.push_back({});
    scene.solids.push_back(rounded(shared(two), 0));
    scene.names.push_back("");
    const SceneMesh made = mesh_scene(scene, {});
    CHECK(topology(made.mesh).manifold());
    CHECK(std::abs(volume(made.mesh) - 2) < 1e-6);
}

TEST_CASE("the mesh of a sharp model is its own") {
    const ClosedMeshPtr mesh = shared(Shape::plate_with_hole(0.5, 16, 0.3));
    Scene scene;
    scene.file = "test";
    scene.materials.push_back({});
    scene.solids.push_back(rounded(mesh, 0).transformed({Mat3(2.0), {1, 2, 3}}));
    scene.names.push_back("");
    for (const auto method : {MeshMethod::triage, MeshMethod::octree, MeshMethod::marching_cubes}) {
        MeshSettings settings;
        settings.method = method;
        settings.check = true;
        const SceneMesh made = mesh_scene(scene, settings);
        CHECK(made.checks[0].faults() == 0);
        CHECK(made.mesh.triangles.size() == mesh->size());
        CHECK(std::abs(volume(made.mesh) - 8 * mesh->volume()) < 1e-12);
    }
}
