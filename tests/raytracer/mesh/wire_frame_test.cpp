// Wire frames: which edges are seen, how lines are drawn, and the options --wire, --flat and --edges.
#include "raytracer/mesh/wire_frame.hpp"

#include "bounds/solid_tree.hpp"
#include "catch.hpp"
#include "polygonizer/triage/triage.hpp"
#include "raytracer/mesh/mesh_tracer.hpp"
#include "raytracer/program.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

Mesh mesh_of(const Density& density, double r) {
    const SolidTree tree = flatten(Solid::rounded(r, density));
    return triage(tree, polygonization_box(tree));
}

double total_length(const std::vector<Stroke>& strokes) {
    double sum = 0;
    for (const Stroke& s : strokes) sum += glm::length(s.to - s.from);
    return sum;
}

constexpr int drawing_width = 400, drawing_height = 300;

std::vector<Stroke> strokes_of(const Mesh& mesh, WireMode mode, Camera camera) {
    return wire_frame(mesh, mesh_edges(mesh, EdgeChoice::polygons), MeshTracer(mesh),
                      ProjectiveCamera(camera, drawing_width, drawing_height), {0, 0, drawing_width, drawing_height},
                      mode);
}

}  // namespace

TEST_CASE("A point is seen where the ray through it starts") {
    const ProjectiveCamera camera({.eye = {3, 2, 5}, .target = {0.2, 0.1, -1}, .up = {0.1, 1, 0}, .fov = 35},
                                  drawing_width, drawing_height);
    for (const Vec2 at : {Vec2(0.5, 0.5), Vec2(200, 150), Vec2(399, 12)}) {
        const Ray ray = camera.ray(at.x, at.y);
        const Vec3 seen = camera.project(ray.origin + 7.0 * ray.direction);
        CHECK(seen.x == Approx(at.x));
        CHECK(seen.y == Approx(at.y));
        CHECK(seen.z == Approx(7 * glm::dot(ray.direction, camera.forward())));
    }
}

TEST_CASE("A box has 12 edges of polygons and 18 of triangles") {
    const Mesh mesh = mesh_of(Density::box({0, 0, 0}, {1, 2, 3}), 0);
    CHECK(mesh_edges(mesh, EdgeChoice::polygons).size() == 12);
    CHECK(mesh_edges(mesh, EdgeChoice::triangles).size() == 18);
}

TEST_CASE("Of a box seen from a corner's side nine edges are seen, and all of their length") {
    const Mesh mesh = mesh_of(Density::box({0, 0, 0}, {1, 1, 1}), 0);
    const Camera camera{.eye = {4, 3, 5}, .target = {0.5, 0.5, 0.5}, .fov = 25};
    const ProjectiveCamera view(camera, drawing_width, drawing_height);
    double expected = 0;
    int seen = 0;
    for (const MeshEdge& e : mesh_edges(mesh, EdgeChoice::polygons)) {
        const Vec3 a = mesh.positions[e.a], b = mesh.positions[e.b];
        // An edge is hidden if it lies in two of the hidden faces x = 0, y = 0 and z = 0.
        const Vec3 far = glm::max(a, b);
        if ((far.x < 1e-9) + (far.y < 1e-9) + (far.z < 1e-9) >= 2) continue;
        ++seen;
        expected += glm::length(Vec2(view.project(a)) - Vec2(view.project(b)));
    }
    REQUIRE(seen == 9);
    CHECK(total_length(strokes_of(mesh, WireMode::visible, camera)) == Approx(expected).margin(9 * 0.5));
    CHECK(total_length(strokes_of(mesh, WireMode::front, camera)) == Approx(expected));
}

TEST_CASE("What stands behind is drawn only with its hidden lines left in") {
    Mesh mesh = mesh_of(Density::box({-2, -2, 0}, {2, 2, 1}), 0);
    const Camera camera{.eye = {0, 0, 20}, .target = {0, 0, 0}, .fov = 25};
    const double alone = total_length(strokes_of(mesh, WireMode::visible, camera));
    mesh.append(mesh_of(Density::box({-0.5, -0.5, -3}, {0.5, 0.5, -2}), 0.1), 1);
    CHECK(total_length(strokes_of(mesh, WireMode::visible, camera)) == Approx(alone));
    CHECK(total_length(strokes_of(mesh, WireMode::front, camera)) > alone + 40);
}

TEST_CASE("A line behind the camera is not drawn, and one that reaches there is cut") {
    const Mesh floor = mesh_of(Density::box({-50, -1, -50}, {50, 0, 50}), 0);
    const Camera camera{.eye = {0, 2, 0}, .target = {0, 1.5, -5}, .fov = 60};
    for (const Stroke& s : strokes_of(floor, WireMode::visible, camera))
        for (const Vec2 p : {s.from, s.to}) {
            CHECK(std::isfinite(p.x + p.y));
            CHECK(p.y > 0.3 * drawing_height);  // below the horizon
        }
}

TEST_CASE("A stroke covers its width across and blends only what it covers") {
    for (const double line_width : {0.5, 1.0, 2.5}) {
        Film film(20, 20, {0, 0, 20, 20});
        for (Pixel& p : film.pixels) p.color = Vec3(1.0);
        draw_strokes(film, {{{-5, 3.2}, {25, 16.7}}}, Vec3(0.0), line_width);
        double covered = 0;
        for (int y = 0; y < 20; ++y) covered += 1 - film.at(10, y).color.x;
        // Along a column the line's width grows with its slope; the box filter approximates that.
        CHECK(covered == Approx(line_width * std::hypot(1, 13.5 / 30)).epsilon(0.12));
        CHECK(film.at(2, 18).color.x == 1);
    }
}

TEST_CASE("render draws wire frames and flat facets of meshes, and of nothing else") {
    const Folder folder;
    write_file(folder / "s.lua", cube_scene());
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"--wire", "visible"}, {"--wire", "front"}, {"--flat"}, {"--edges"}}) {
        std::vector<std::string> call{"render", folder / "s.lua", "-q", "-o", folder / "a.png", "--via", "triage"};
        call.insert(call.end(), words.begin(), words.end());
        CHECK(run(call).code == 0);
        call[6] = "implicit";
        CHECK(run(call).code == 2);
    }
    const Outcome outcome =
        run({"render", folder / "s.lua", "--via", "triage", "--wire", "all", "-o", folder / "a.png"});
    CHECK(outcome.err == "deburr: --wire: expected visible or front, got 'all'\n");
}

TEST_CASE("The lines of crops are those of the whole picture, to the bit, and cost no more than what is in them") {
    const Mesh mesh = mesh_of(Density::box({0, 0, 0}, {1, 1, 1}), 0.2);
    const Camera camera{.eye = {2, 1.4, 2.2}, .target = {0.5, 0.5, 0.5}, .fov = 30};
    const auto edges = mesh_edges(mesh, EdgeChoice::polygons);
    const MeshTracer tracer(mesh);
    const auto lines_of = [&](const Window& window, WireMode mode, int scale) {
        const ProjectiveCamera view(camera, scale * drawing_width, scale * drawing_height);
        return wire_frame(mesh, edges, tracer, view, window, mode);
    };
    const auto picture = [&](const Window& window, WireMode mode) {
        Film film(drawing_width, drawing_height, window);
        draw_strokes(film, lines_of(window, mode, 1), Vec3(1.0), 1.5);
        return film;
    };
    for (const WireMode mode : {WireMode::visible, WireMode::front}) {
        const Film whole = picture({0, 0, drawing_width, drawing_height}, mode);
        int lines = 0;
        for (const Window& window : {Window{0, 0, 200, 150}, Window{133, 71, 120, 99}, Window{399, 0, 1, 300}}) {
            const Film part = picture(window, mode);
            for (int y = window.y; y < window.y + window.height; ++y)
                for (int x = window.x; x < window.x + window.width; ++x) {
                    lines += part.at(x, y).color.x > 0;
                    REQUIRE(part.at(x, y).color == whole.at(x, y).color);
                }
        }
        CHECK(lines > 500);
    }
    const double all = total_length(lines_of({0, 0, 100 * drawing_width, 100 * drawing_height}, WireMode::front, 100));
    CHECK(total_length(lines_of({20000, 15000, 400, 300}, WireMode::front, 100)) < 0.01 * all);
}
