// Models from files: what is read, what is mended and reported, and the errors for what is refused.
#include "raytracer/model/model_file.hpp"

#include <cctype>

#include "catch.hpp"
#include "closed_shapes.hpp"
#include "raytracer/folder.hpp"
#include "raytracer/model/closed_surface.hpp"
#include "raytracer/model/flat_faces.hpp"
#include "raytracer/text.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/scene_error.hpp"

using namespace deburr;
using test::has;
using test::Shape;

namespace {

// Reads a model from a file of this name and these bytes.
Model model_from(const std::string& name, const std::string& bytes) {
    const test::Folder folder;
    test::write_file(folder / name, bytes);
    return read_model(folder / name);
}

// The exit code for the model and the message; "none" if it is read.
std::string refusal_of(const std::string& name, const std::string& bytes) {
    try {
        model_from(name, bytes);
    } catch (const UnsupportedError& error) {
        return std::string("3 ") + error.what();
    } catch (const SceneError& error) {
        return std::string("2 ") + error.what();
    }
    return "none";
}

Shape brick() { return Shape::box({0, 0, 0}, {3, 2, 1}); }

std::string ascii_stl(const Shape& s) {
    std::string text = "solid x\n";
    for (const auto& t : s.triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const int v : t)
            text += "vertex " + std::to_string(s.vertices[v].x) + " " + std::to_string(s.vertices[v].y) + " " +
                    std::to_string(s.vertices[v].z) + "\n";
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid x\n";
}

std::string obj(const Shape& s) {
    std::string text;
    for (const Vec3& v : s.vertices)
        text += "v " + std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
    for (const auto& t : s.triangles)
        text +=
            "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
    return text;
}

std::string off(const Shape& s) {
    std::string text = "OFF\n" + std::to_string(s.vertices.size()) + " " + std::to_string(s.triangles.size()) + " 0\n";
    for (const Vec3& v : s.vertices)
        text += std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
    for (const auto& t : s.triangles)
        text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
    return text;
}

std::string ply(const Shape& s) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(s.vertices.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                       std::to_string(s.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string body = off(s);
    return text + body.substr(body.find('\n', body.find('\n') + 1) + 1);
}

void turn_over(Shape& s, std::size_t t) { std::swap(s.triangles[t][1], s.triangles[t][2]); }

}  // namespace

TEST_CASE("a box is the same from every format") {
    const Shape s = brick();
    std::string capitals = ascii_stl(s);
    for (char& c : capitals) c = char(std::toupper(c));
    const std::pair<const char*, std::string> files[] = {
        {"c.stl", capitals},      {"d.stl", "\xEF\xBB\xBF \r\n" + ascii_stl(s)},
        {"a.stl", s.stl()},       {"b.stl", ascii_stl(s)},
        {"a.obj", obj(s)},        {"a.off", off(s)},
        {"a.ply", ply(s)},        {"no_extension", s.stl()},
        {"wrong.obj.ply", ply(s)}};
    for (const auto& [name, bytes] : files) {
        CAPTURE(name);
        const Model model = model_from(name, bytes);
        CHECK(model.mesh->size() == 12);
        CHECK(model.mesh->planes() == 6);
        CHECK(model.mesh->volume() == 6);
        CHECK(model.mended.empty());
    }
}

TEST_CASE("what is not sound in a file is mended where that is, and said") {
    Shape inverted = brick(), half = brick(), twice = brick();
    for (std::size_t t = 0; t < inverted.triangles.size(); ++t) turn_over(inverted, t);
    for (std::size_t t = 0; t < 5; ++t) turn_over(half, t);
    twice.triangles.push_back(twice.triangles[3]);
    const std::pair<Shape, const char*> cases[] = {
        {inverted, "turned 12 facets"}, {half, "turned 5 facets"}, {twice, "dropped 1 facet that is there twice"}};
    for (const auto& [shape, said] : cases) {
        CAPTURE(said);
        const Model model = model_from("a.stl", shape.stl());
        CHECK(model.mesh->volume() == 6);
        REQUIRE(model.mended.size() == 1);
        CHECK(has(model.mended[0], said));
    }
}

TEST_CASE("vertices that rounding has parted are joined, and said") {
    Shape s = brick();
    s.vertices.push_back(s.vertices[6] + Vec3(1e-6, -1e-6, 0));
    for (auto& t : s.triangles)
        for (int& v : t)
            if (v == 6) {
                v = 8;
                goto done;
            }
done:
    const Model model = model_from("a.stl", s.stl());
    CHECK(std::abs(model.mesh->volume() - 6) < 1e-4);
    REQUIRE(model.mended.size() == 1);
    CHECK(has(model.mended[0], "joined vertices"));
}

TEST_CASE("shells within others are cavities, or nothing") {
    const Shape outer = Shape::box({-2, -2, -2}, {2, 2, 2}), inner = Shape::box({-1, -1, -1}, {1, 1, 1});
    Shape turned = inner;
    for (std::size_t t = 0; t < turned.triangles.size(); ++t) turn_over(turned, t);
    CHECK(model_from("a.stl", together(outer, turned).stl()).mesh->volume() == 64 - 8);
    const Model filled = model_from("a.stl", together(outer, inner).stl());
    CHECK(filled.mesh->volume() == 64);
    REQUIRE(filled.mended.size() == 1);
    CHECK(has(filled.mended[0], "dropped 1 shell within the solid"));
    // A body with a cavity, all of it inside out.
    Shape all = together(outer, turned);
    for (std::size_t t = 0; t < all.triangles.size(); ++t) turn_over(all, t);
    CHECK(model_from("a.stl", all.stl()).mesh->volume() == 64 - 8);
    // Two boxes side by side.
    CHECK(model_from("a.stl", together(outer, Shape::box({3, 0, 0}, {4, 1, 1})).stl()).mesh->volume() == 65);
}

TEST_CASE("bodies of a file that overlap are united, and said") {
    const Model model = model_from("a.stl", together(brick(), Shape::box({1, 0.5, 0.25}, {5, 1, 0.75})).stl());
    CHECK(model.mesh->volume() == 6 + 2 * 0.5 * 0.5);
    REQUIRE(model.mended.size() == 1);
    CHECK(has(model.mended[0], "united 2 shells that overlap"));
}

TEST_CASE("boxes that touch in an edge or in a vertex are one solid") {
    for (const Vec3 shift : {Vec3(1, 1, 0), Vec3(1, 1, 1)}) {
        const Shape a = Shape::box({0, 0, 0}, {1, 1, 1}), b = Shape::box(shift, shift + 1.0);
        CHECK(model_from("a.stl", together(a, b).stl()).mesh->volume() == 2);
    }
}

TEST_CASE("what bounds no solid is refused with a count, a place and a word on how to mend it") {
    Shape open = brick();
    open.triangles.pop_back();
    const std::string hole = refusal_of("a.stl", open.stl());
    CHECK(has(hole, "3 "));
    CHECK(has(hole, "a.stl: expected a closed surface, got one with 3 open edges, one near {"));
    CHECK(has(hole, "close it"));
    Shape inward = Shape::box({1, 0.5, 0.3}, {5, 0.8, 0.6});
    for (std::size_t t = 0; t < inward.triangles.size(); ++t) turn_over(inward, t);
    const std::string crossing = refusal_of("a.stl", together(brick(), inward).stl());
    CHECK(has(crossing, "3 "));
    CHECK(has(crossing, "a.stl: expected bodies that face outward where they overlap"));
    CHECK(has(refusal_of("a.stl", Shape().stl()), "expected facets, got none"));
    Shape nan = brick();
    nan.vertices[2].y = std::nan("");
    CHECK(has(refusal_of("a.stl", nan.stl()), "expected coordinates, got one that is not a number"));
}

TEST_CASE("files that are not what they seem are one line") {
    std::string cut = brick().stl();
    cut.resize(cut.size() - 30);
    CHECK(has(refusal_of("a.stl", cut), "2 "));
    CHECK(has(refusal_of("a.stl", cut), "expected 684 bytes for the 12 facets that it claims, got 654"));
    std::string many = brick().stl();
    many[83] = char(0x7f);
    CHECK(has(refusal_of("a.stl", many), "facets that it claims, got 684"));
    CHECK(has(refusal_of("a.stl", ""), "got an empty file"));
    CHECK(has(refusal_of("a.stl", "hello"), "expected a model (STL"));
    CHECK(has(refusal_of("a.stl", ascii_stl(brick()).substr(0, 300)), "cut off"));
    for (const char* text : {"solid x facet normal a b c outer loop endsolid", "ply\nformat ascii 1.0\nend_header\n",
                             "OFF\n99999999 99999999 0\n", "glTF____________", "PK\x03\x04 nothing"}) {
        CAPTURE(text);
        const std::string said = refusal_of("a.stl", text);
        CHECK((has(said, "2 ") || has(said, "3 ")));
        CHECK(said.find('\n') == std::string::npos);
    }
    std::string claims = ply(brick());
    claims.replace(claims.find("vertex 8"), 8, "vertex 4000000000");
    CHECK(has(refusal_of("a.ply", claims), "expected at most an element a byte, got a claim of 4000000000 in "));
    CHECK_THROWS_AS(read_model("/nowhere/a.stl"), SceneError);
}

TEST_CASE("without the program openscad a .scad is refused in one line") {
    const test::Folder folder;
    test::write_file(folder / "a.scad", "cube(1);");
    const char* const before = std::getenv("PATH");
    const std::string path = before ? before : "";
    setenv("PATH", "/nowhere", 1);
    std::string said;
    try {
        read_model(folder / "a.scad");
    } catch (const UnsupportedError& error) {
        said = error.what();
    }
    setenv("PATH", path.c_str(), 1);
    CHECK(has(said, "expected the program openscad"));
}

TEST_CASE("faces that a float's rounding bent are flat again") {
    int faces = 0;
    for (auto seed : seeds(50)) {
        CAPTURE(seed);
        Gen g(seed);
        Shape s = Shape::plate_with_hole(0.4, 24, 0.3);
        s.rotate(g);
        std::vector<Vec3> rounded;
        for (const Vec3& v : s.vertices) rounded.push_back({float(v.x), float(v.y), float(v.z)});
        std::vector<Vec3> flat = rounded;
        flatten_faces(flat, s.triangles);
        double moved = 0;
        for (std::size_t k = 0; k < flat.size(); ++k) moved = std::max(moved, glm::distance(flat[k], rounded[k]));
        CHECK(moved < 2e-6);
        const ClosedMesh before(rounded, s.triangles), after(flat, s.triangles);
        CHECK(before.planes() > 60);
        CHECK(after.planes() == 2 + 8 + 24);
        faces += int(after.planes());
    }
    CHECK(faces > 0);
}
