// Rays against meshes through Embree, also with huge triangles and from far away.
#include "raytracer/mesh/mesh_tracer.hpp"

#include <random>

#include "catch.hpp"
#include "raytracer/mesh/split_distant_triangles.hpp"

using namespace deburr;

namespace {

// A square in the plane through the origin with this normal, as two triangles; `size` is half of its side.
Mesh floor_of(Vec3 normal, double size) {
    const Vec3 a = glm::normalize(glm::cross(normal, Vec3(0.3, 0.1, 1))), b = glm::cross(normal, a);
    Mesh mesh;
    for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        mesh.positions.push_back(size * (double(u) * a + double(v) * b));
    mesh.normals = {normal};
    for (const auto& [j, k] : {std::pair{1, 2}, {2, 3}}) {
        Triangle t;
        t.vertex = {0, j, k};
        t.normal = {0, 0, 0};
        mesh.triangles.push_back(t);
    }
    return mesh;
}

}  // namespace

// A floor's mesh ends at ten thousand times the size of what stands on it, so its triangles are huge.
TEST_CASE("Hits lie in their triangle's plane, and leave it, however large the triangle is") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    double farthest = 0;
    int missed = 0, shadowed = 0, rays = 0;
    TraceCounters counters;
    for (int k = 0; k < 20; ++k) {
        const Vec3 normal = glm::normalize(Vec3(unit(random), unit(random), unit(random)));
        const MeshTracer tracer(floor_of(normal, 3e4), {Vec3(-3.0), Vec3(3.0)});
        for (int i = 0; i < 500; ++i, ++rays) {
            const Vec3 target = 3.0 * Vec3(unit(random), unit(random), unit(random));
            const Vec3 on_floor = target - normal * glm::dot(normal, target);
            const Vec3 eye = on_floor + 2.0 * normal + Vec3(unit(random), unit(random), unit(random));
            const Hit hit = tracer.closest_hit({eye, glm::normalize(on_floor - eye)}, infinity, counters);
            missed += !hit;
            if (!hit) continue;
            farthest = std::max(farthest, glm::distance(hit.position, on_floor));
            const Vec3 up =
                glm::normalize(normal + 0.9 * glm::normalize(Vec3(unit(random), unit(random), unit(random))));
            shadowed += tracer.any_hit(leave(hit, up), infinity, counters);
        }
    }
    CHECK(rays == 10000);
    CHECK(missed == 0);
    CHECK(shadowed == 0);
    CHECK(farthest < 1e-9);
}

TEST_CASE("Splitting far triangles keeps surface, normals and closedness") {
    for (const Vec3 at : {Vec3(0.0), Vec3(1e4, 0, 0), Vec3(-7e3, 9e3, 20)}) {
        // A tetrahedron of size 10⁴, whose triangles are split as seen from around `at`.
        Mesh mesh;
        mesh.positions = {Vec3(-1e4, -1e4, -1e4), Vec3(2e4, 0, 0), Vec3(0, 2e4, 0), Vec3(0, 0, 2e4)};
        for (const std::array<int, 3>& v : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
            Triangle t;
            t.vertex = v;
            mesh.normals.push_back(glm::normalize(Mesh{mesh.positions, {}, {}}.area_vector(t)));
            t.normal.fill(int(mesh.normals.size()) - 1);
            mesh.triangles.push_back(t);
        }
        const Box near{at - Vec3(2.0), at + Vec3(3.0)};
        const Mesh split = split_distant_triangles(mesh, near);
        CHECK(topology(split).manifold());
        CHECK(split.triangles.size() > 60);
        CHECK(split.triangles.size() < 6000);
        CHECK(volume(split) == Approx(volume(mesh)).epsilon(1e-12));
        std::size_t turned = 0, too_long = 0;
        for (const Triangle& t : split.triangles) {
            turned += glm::distance(glm::normalize(split.area_vector(t)), split.normals[t.normal[0]]) > 1e-9;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 a = split.positions[t.vertex[k]], b = split.positions[t.vertex[(k + 1) % 3]];
                too_long += glm::distance(a, b) > glm::distance(0.5 * (near.lo + near.hi), 0.5 * (a + b)) + 10;
            }
        }
        CHECK(turned == 0);
        CHECK(too_long == 0);
        CHECK(split_distant_triangles(mesh, Box{}).triangles.size() == 4);
    }
}

TEST_CASE("From any distance a ray meets the mesh where double precision knows it to") {
    const MeshTracer tracer(floor_of({0, 0, 1}, 1));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-0.9, 0.9);
    TraceCounters counters;
    int missed = 0, unseen = 0, rays = 0;
    double farthest = 0;
    for (const double distance : {10.0, 1e3, 1e5, 1e7, 1e9})
        for (int k = 0; k < 300; ++k, ++rays) {
            const Vec3 at(0.7 * unit(random), 0.7 * unit(random), 0);  // within the square, however it is rotated
            const Vec3 eye = at + glm::normalize(Vec3(unit(random), unit(random), 1)) * distance;
            const Vec3 direction = glm::normalize(at - eye);
            const Hit hit = tracer.closest_hit({eye, direction}, infinity, counters);
            if (!hit) {
                ++missed;
                continue;
            }
            farthest = std::max(farthest, glm::distance(hit.position, at) / (1e-9 + 1e-15 * distance));
            // Shadow rays back to a light at the eye, to beyond the mesh, and to halfway.
            unseen += tracer.any_hit({hit.position + Vec3(0, 0, hit.offset), -direction}, distance, counters);
            unseen += !tracer.any_hit({eye, direction}, 2 * distance, counters);
            unseen += tracer.any_hit({eye, direction}, 0.5 * distance, counters);
        }
    CHECK(rays == 1500);
    CHECK(missed == 0);
    CHECK(unseen == 0);
    CHECK(farthest < 10);
}
