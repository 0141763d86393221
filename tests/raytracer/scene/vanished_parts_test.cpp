// Parts of a scene that vanish by rounding or by operators, and how they are reported.
#include "raytracer/scene/vanished_parts.hpp"

#include <cmath>

#include "bounds/emptiness.hpp"
#include "catch.hpp"
#include "closed_shapes.hpp"
#include "raytracer/program.hpp"
#include "raytracer/scene/scene_reader.hpp"
#include "raytracer/scene/thin_walls.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

VanishedParts vanished_of(const std::string& solids) {
    return vanished_parts(read_scene_text("return {\n solids = { " + solids + " } }", "s.lua"));
}

// The number after "up to " in the line.
double radius_in(const std::string& line) {
    const std::size_t at = line.find("up to ");
    REQUIRE(at != std::string::npos);
    return std::stod(line.substr(at + 6));
}

}  // namespace

TEST_CASE("a solid that rounding leaves nothing of is told with the largest radius that keeps it") {
    const VanishedParts found = vanished_of("cube(), rounded(0.9, box({0, 0, 0}, {10, 0.5, 10})):name('lid')");
    REQUIRE(found.rounded_away.size() == 1);
    CHECK(found.rounded_away[0].find("s.lua:2: solid 2 (lid): it vanishes at radius 0.9; up to ") == 0);
    // The product of two half-spaces whose planes are t apart is ½ in its middle where F(−t/2r)² = ½: at t = 0.5675 r.
    const double radius = radius_in(found.rounded_away[0]);
    CHECK(radius < 0.5 / 0.5674);
    CHECK(radius > 0.99 * 0.5 / 0.5675);
    CHECK(vanished_of("rounded(0.88, box({0, 0, 0}, {10, 0.5, 10}))").rounded_away.empty());
}

namespace {

std::vector<std::string> of_model(const Shape& shape, double radius, const Affine& map = {}) {
    Scene scene;
    scene.file = "part.stl";
    const Solid solid =
        Solid::of_field(std::make_shared<MeshField>(std::make_shared<ClosedMesh>(shape.mesh()), radius));
    scene.solids.push_back(solid.transformed(map));
    scene.names.push_back("part");
    return vanished_parts(scene).rounded_away;
}

}  // namespace

TEST_CASE("walls of a model that its radius leaves nothing of are told with the largest radius that keeps them") {
    const Shape plate = Shape::box({0, 0, 0}, {10, 10, 0.5});
    // A wall of thickness 0.6946 r contains half of a ball of radius r around its middle.
    const std::vector<std::string> found = of_model(plate, 0.75);
    REQUIRE(found.size() == 1);
    CHECK(found[0].find("solid 1 (part): walls behind 4 facets vanish at radius 0.75, the thinnest 0.5 thick near (") !=
          std::string::npos);
    CHECK(radius_in(found[0]) <= 0.5 / vanishing_thickness);
    CHECK(radius_in(found[0]) > 0.99 * 0.5 / vanishing_thickness);
    CHECK(of_model(plate, 0.71).empty());
    // Edges of thick parts are not walls, however much of them rounding removes.
    CHECK(of_model(Shape::l_prism(), 0.9).empty());
    CHECK(of_model(Shape::box({0, 0, 0}, {1, 1, 1}), 0).empty());
    Affine twice;
    twice.linear = Mat3(2.0);
    const std::vector<std::string> larger = of_model(plate, 0.75, twice);
    REQUIRE(larger.size() == 1);
    CHECK(larger[0].find("at radius 1.5, the thinnest 1 thick") != std::string::npos);
}

TEST_CASE("the search for the largest radius that keeps one part leaves time for the others") {
    // Near that radius nothing can be proved, however much time is spent.
    const VanishedParts found =
        vanished_of("rounded(0.9, box({0, 0, 0}, {10, 0.5, 10})), rounded(0.9, box({0, 0, 0}, {9, 0.5, 10}))");
    CHECK(found.rounded_away.size() == 2);
}

TEST_CASE("a part of a union that vanishes is told by its place, unless its neighbours hold it", "[slow]") {
    const std::string plate = "box({0, 0, 0}, {10, 2, 10})", fin = "box({4, 2, 0}, {4.1, 6, 10})";
    for (const char* op : {" | ", " + "}) {
        CAPTURE(op);
        const VanishedParts found = vanished_of("rounded(0.3, " + plate + op + fin + ")");
        REQUIRE(found.rounded_away.size() == 1);
        CHECK(found.rounded_away[0].find(
                  "s.lua:2: solid 1: a part in [4, 4.1] x [2, 6] x [0, 10] vanishes at radius 0.3; up "
                  "to ") == 0);
        CHECK(radius_in(found.rounded_away[0]) < 0.1 / 0.5675);
        CHECK(radius_in(found.rounded_away[0]) > 0.1 / 0.75);
    }
    // Each of these slices would vanish if it were alone.
    CHECK(
        vanished_of(
            "rounded(0.3, box({0, 0, 0}, {9, 0.1, 9}) | box({0, 0.1, 0}, {9, 0.2, 9}) | box({0, 0.2, 0}, {9, 0.3, 9}))")
            .rounded_away.empty());
    CHECK(vanished_of("rounded(0.3, " + plate + " | box({1, 1, 1}, {1.1, 1.5, 2}))").rounded_away.empty());
}

TEST_CASE("what a true convolution leaves nothing of is told with the largest radius that keeps it") {
    // A plate of thickness t contains half of a ball of radius r around its middle where 3u − u³ = 1, u = t/2r.
    const double u = 2 * std::sin(pi / 18);
    const VanishedParts plates = vanished_of("convolved(0.9, box({0, 0, 0}, {10, 0.5, 10}))");
    REQUIRE(plates.rounded_away.size() == 1);
    CHECK(plates.empty.empty());
    CHECK(plates.rounded_away[0].find("s.lua:2: solid 1: it vanishes at radius 0.9; up to ") == 0);
    CHECK(radius_in(plates.rounded_away[0]) < 0.25 / u);
    CHECK(radius_in(plates.rounded_away[0]) > 0.98 * 0.25 / u);
    CHECK(vanished_of("convolved(0.7, box({0, 0, 0}, {10, 0.5, 10}))").rounded_away.empty());

    const std::string plate = "box({0, 0, 0}, {10, 2, 10})";
    const VanishedParts found = vanished_of("convolved(0.3, " + plate + " | box({4, 2, 0}, {4.1, 6, 10}))");
    REQUIRE(found.rounded_away.size() == 1);
    CHECK(found.rounded_away[0].find("a part in [4, 4.1] x [2, 6] x [0, 10] vanishes at radius 0.3; up to ") !=
          std::string::npos);
    CHECK(radius_in(found.rounded_away[0]) < 0.05 / u);
    CHECK(vanished_of("convolved(0.3, box({0, 0, 0}, {9, 0.1, 9}) | box({0, 0.1, 0}, {9, 0.4, 9}))")
              .rounded_away.empty());
}

TEST_CASE("a solid that an operator leaves nothing of is told") {
    const VanishedParts found =
        vanished_of("cube() & cube():translate(5, 0, 0), rounded(0.1, cube()) - box({-1, -1, -1}, {2, 2, 2})");
    REQUIRE(found.empty.size() == 2);
    CHECK(found.empty[0] == "s.lua:2: solid 1: it is empty: & or - leaves nothing of it");
    CHECK(found.empty[1] == "s.lua:2: solid 2: it is empty: & or - leaves nothing of it");
    CHECK(vanished_of("halfspace({0, 1, 0}, 0), ellipsoid{}, cube()").empty.empty());
}

TEST_CASE("nothing is left of a scene where every solid is empty, and not before") {
    const auto left = [](const std::string& solids) {
        return !nothing_is_left(read_scene_text("return { solids = { " + solids + " } }", "s.lua"));
    };
    CHECK_FALSE(left("rounded(0.9, box({0, 0, 0}, {10, 0.5, 10}))"));
    CHECK_FALSE(left("rounded(0.9, box({0, 0, 0}, {10, 0.5, 10})), cube() & cube():translate(5, 0, 0)"));
    CHECK(left("rounded(0.9, box({0, 0, 0}, {10, 0.5, 10})), cube()"));
    CHECK(left("halfspace({0, 1, 0}, 0), cube() & cube():translate(5, 0, 0)"));
}

TEST_CASE("whether a set is empty is proved either way, or not said") {
    std::int64_t nodes = 1'000'000;
    const Box box{Vec3(0), Vec3(1)};
    const auto rounded = [](double r) { return flatten(Density::box(Vec3(0), Vec3(1)), r); };
    CHECK(emptiness(rounded(0.1), box, nodes) == Emptiness::not_empty);
    CHECK(emptiness(rounded(3), box, nodes) == Emptiness::empty);
    CHECK(emptiness(rounded(0.1), {Vec3(2), Vec3(3)}, nodes) == Emptiness::empty);
    CHECK(emptiness(rounded(0.1), Box{}, nodes) == Emptiness::empty);
    CHECK(nodes > 0);
    // This box holds only a corner of the sharp box, away from the middles that the search tries.
    CHECK(emptiness(rounded(0), {Vec3(0.999), Vec3(1.7)}, nodes) == Emptiness::not_empty);
    nodes = 1;
    CHECK(emptiness(rounded(1), box, nodes) == Emptiness::unknown);
}

TEST_CASE("where nothing is left, mesh and render end with exit code 1 and write nothing", "[slow]") {
    const Folder folder;
    const std::string scene = folder / "s.lua";
    write_file(scene, "return { solids = { rounded(0.9, box({0, 0, 0}, {10, 0.5, 10})) } }");
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"mesh", scene, "-o", folder / "a.stl"}, {"render", scene, "-o", folder / "a.png"}}) {
        const Outcome outcome = run(words);
        INFO(outcome.err);
        CHECK(outcome.code == 1);
        CHECK(outcome.err.find("solid 1: it vanishes at radius 0.9; up to 0.8") != std::string::npos);
    }
    CHECK(folder.names() == std::vector<std::string>{"s.lua"});
    CHECK(run({"info", scene}).out.find("warning") != std::string::npos);
}
