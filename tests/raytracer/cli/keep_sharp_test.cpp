// --keep-sharp, and convolved(r, model, { … }): which edges stay sharp, and the errors for wrong values.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

#include "catch.hpp"
#include "closed_shapes.hpp"
#include "raytracer/cli/option_values.hpp"
#include "raytracer/folder.hpp"
#include "raytracer/program.hpp"
#include "raytracer/text.hpp"
#include "raytracer/util/errors.hpp"

using namespace deburr;
using test::has;
using test::Outcome;
using test::run;
using test::Shape;

namespace {

double volume_of(const std::string& said) {
    const std::string key = "mesh volume";
    const std::size_t at = said.find(key);
    return at == std::string::npos ? 0 : std::stod(said.substr(at + key.size()));
}

}  // namespace

TEST_CASE("--keep-sharp takes kinds of edges, heights and boxes, and refuses all else") {
    KeepSharp keep;
    parse_keep_sharp("--keep-sharp", "concave", keep);
    parse_keep_sharp("--keep-sharp", "below=2.5", keep);
    parse_keep_sharp("--keep-sharp", "above=9", keep);
    parse_keep_sharp("--keep-sharp", "box=3,2,1,0,-1,5", keep);
    CHECK(keep.edges == KeptEdges::Kind::concave);
    CHECK(keep.below == 2.5);
    CHECK(keep.above == 9);
    REQUIRE(keep.boxes.size() == 1);
    CHECK(keep.boxes[0].lo == Vec3(0, -1, 1));
    CHECK(keep.boxes[0].hi == Vec3(3, 2, 5));
    for (const char* wrong : {"", "all", "below", "below=", "below=nan", "above=x", "box=1,2,3", "box=1,2,3,4,5,inf"}) {
        CAPTURE(wrong);
        CHECK_THROWS_AS(parse_keep_sharp("--keep-sharp", wrong, keep), UsageError);
    }
}

TEST_CASE("meshes of a box that is rounded in part lose what is rounded there", "[slow]") {
    const test::Folder folder;
    const std::string part = folder / "part.stl", mesh = folder / "mesh.stl";
    test::write_file(part, Shape::box({0, 0, 0}, {10, 10, 10}).stl());
    const auto volume = [&](const std::vector<std::string>& more) {
        std::vector<std::string> call = {"mesh", part, "-o", mesh, "--stats", "-q"};
        call.insert(call.end(), more.begin(), more.end());
        const Outcome o = run(call);
        CAPTURE(o.err);
        CHECK(o.code == 0);
        return volume_of(o.out + o.err);
    };
    const double sharp = volume({}), round = volume({"--round", "1"});
    // The octree's mesh without decimation.
    const auto fine_volume = [&](const std::string& kept, const std::string& fade) {
        return volume({"--round", "1", "--keep-sharp", kept, "--fade", fade, "--tolerance", "inf"});
    };
    const double upper = fine_volume("below=5", "2"), none = fine_volume("convex", "3"),
                 all = fine_volume("concave", "3");
    CHECK(sharp == Approx(1000));
    CHECK(none == Approx(1000).epsilon(1e-4));
    CHECK(all == Approx(round).epsilon(6e-3));  // the octree's cells follow a rounded edge less finely
    // Four of the twelve edges are rounded whole, and four less than half of their length.
    const double lost = 1000 - round, of_upper = 1000 - upper;
    CHECK(of_upper > lost * (4 + 0.5) / 12);
    CHECK(of_upper < lost * (4 + 2) / 12);
}

TEST_CASE("a model whose radius varies is thinned out within the tolerance, and triage says why it cannot take it",
          "[slow]") {
    const test::Folder folder;
    const std::string part = folder / "part.stl", mesh = folder / "mesh.stl";
    test::write_file(part, Shape::box({0, 0, 0}, {10, 10, 10}).stl());
    const std::vector<std::string> call = {"mesh", part, "--round", "1", "--keep-sharp", "convex", "-o", mesh, "-q"};
    const auto with = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = call;
        all.insert(all.end(), more.begin(), more.end());
        return run(all);
    };
    const Outcome usual = with({"--stats-json", folder / "a.json"}),
                  fine = with({"--tolerance", "inf", "--stats-json", folder / "b.json"});
    REQUIRE(usual.code == 0);
    REQUIRE(fine.code == 0);
    const auto of = [&](const char* file) { return nlohmann::json::parse(test::read_file(folder / file))["mesh"]; };
    CHECK(of("a.json")["triangles"] < 100);
    CHECK(of("b.json")["triangles"] > 10'000);
    CHECK(double(of("a.json")["volume"]) == Approx(1000).epsilon(1e-3));
    const Outcome refused = with({"--method", "triage"});
    CHECK(refused.code == 3);
    CHECK(has(refused.err, "got a model with a radius that varies (keep_sharp) in solid 1"));
}

TEST_CASE("--fade without --keep-sharp is refused") {
    const test::Folder folder;
    test::write_file(folder / "part.stl", Shape::l_prism().stl());
    for (const char* command : {"render", "mesh"}) {
        const Outcome o = run({command, folder / "part.stl", "--round", "0.1", "--fade", "1", "-o",
                               folder / (command == std::string("mesh") ? "out.stl" : "out.png")});
        CHECK(o.code == 2);
        CHECK(has(o.err, "--fade: expected --keep-sharp with it"));
        CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    }
}

TEST_CASE("a scene says what stays sharp, and wrong fields are told") {
    const test::Folder folder;
    test::write_file(folder / "part.stl", Shape::l_prism().stl());
    const auto info = [&](const std::string& options) {
        test::write_file(folder / "s.lua",
                         "return { solids = { convolved(0.1, model(\"part.stl\"), " + options + ") } }");
        return run({"info", folder / "s.lua"});
    };
    CHECK(info("{ edges = \"convex\" }").code == 0);
    CHECK(info("{ keep_sharp = { below = 0.5, above = 3, box = {{0, 0, 0}, {1, 1, 1}} }, fade = 0.2 }").code == 0);
    const std::pair<const char*, const char*> wrong[] = {
        {"{ edges = \"sharp\" }", "edges: expected 'convex', 'concave' or 'all'"},
        {"{ keep_sharp = { under = 1 } }", "under"},
        {"{ keep_sharp = { box = {1, 2, 3} } }", "expected two corners"},
        {"{ fade = 0 }", "fade: expected a number > 0"},
        {"{ fade = 1 }", "fade: expected edges or keep_sharp beside it"}};
    for (const auto& [options, said] : wrong) {
        const Outcome o = info(options);
        CAPTURE(o.err);
        CHECK(o.code == 2);
        CHECK(has(o.err, said));
    }
    test::write_file(folder / "s.lua", "return { solids = { convolved(0.1, cube(), { edges = \"convex\" }) } }");
    CHECK(has(run({"info", folder / "s.lua"}).err, "expected a model where something is kept sharp"));
}
