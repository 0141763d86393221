// What the scene reader makes of correct scenes.
#include "raytracer/scene/scene_reader.hpp"

#include "bounds/bounding_box.hpp"
#include "bounds/canonical_solids.hpp"
#include "catch.hpp"
#include "raytracer/render/lights.hpp"
#include "raytracer/scene/scene_text.hpp"

using namespace deburr;

namespace {

Scene scene_with(const std::string& solid) { return scene_of("return { solids = { " + solid + " } }"); }

const SolidNode& only_solid(const Scene& scene) {
    REQUIRE(scene.solids.size() == 1);
    return scene.solids[0].node();
}

// The density of a scene's only solid, which must be a rounded density.
const DensityNode& density_of(const Scene& scene) {
    const SolidNode& node = only_solid(scene);
    REQUIRE(node.kind == SolidNode::Kind::rounded);
    return node.density().node();
}

bool same_map(const Affine& a, const Affine& b) { return a.linear == b.linear && a.shift == b.shift; }

void check_face(const DensityNode& face, Vec3 normal, double offset) {
    REQUIRE(face.kind == DensityNode::Kind::half_space);
    CAPTURE(face.normal().x, face.normal().y, face.normal().z, face.offset());
    CHECK(face.normal() == normal);
    CHECK(face.offset() == offset);
}

bool has_face(const DensityNode& body, Vec3 normal, double offset) {
    for (const Density& face : body.children())
        if (face.node().normal() == normal && face.node().offset() == offset) return true;
    return false;
}

}  // namespace

TEST_CASE("shapes are products of their half-spaces") {
    check_face(density_of(scene_with("halfspace({0, 2, 0}, 3)")), Vec3(0, 1, 0), 1.5);
    check_face(density_of(scene_with("halfspace({0, 0, -1e-200}, 1e-200)")), Vec3(0, 0, -1), 1);
    const Scene scene = scene_with("box({-1, 0, 2}, {1, 3, 4})");
    const DensityNode& box = density_of(scene);
    CHECK(box.kind == DensityNode::Kind::product);
    REQUIRE(box.children().size() == 6);
    CHECK(has_face(box, Vec3(-1, 0, 0), 1));
    CHECK(has_face(box, Vec3(0, 1, 0), 3));
    CHECK(has_face(box, Vec3(0, 0, -1), -2));
    CHECK(density_of(scene_with("cube()")).children().size() == 6);
}

TEST_CASE("a convex hull has one exact half-space a face, whatever the order of the points") {
    const std::string corners[8] = {"{0,0,0}",     "{0.1,0,0}",   "{0,0.3,0}",   "{0,0,0.7}",
                                    "{0.1,0.3,0}", "{0.1,0,0.7}", "{0,0.3,0.7}", "{0.1,0.3,0.7}"};
    for (const std::size_t step : {1, 3, 5}) {
        std::string points;
        for (std::size_t i = 0; i < 8; ++i) points += corners[i * step % 8] + ", ";
        // Points inside the box, in faces, on edges and given twice change nothing.
        points += "{0.05, 0.1, 0.1}, {0.05, 0.1, 0}, {0.1, 0.1, 0}, {0.05, 0.3, 0.35}, {0, 0, 0}";
        const Scene scene = scene_with("convex{ " + points + " }");
        const DensityNode& box = density_of(scene);
        REQUIRE(box.children().size() == 6);
        check_face(box.children()[0].node(), Vec3(-1, 0, 0), 0);
        check_face(box.children()[1].node(), Vec3(0, -1, 0), 0);
        check_face(box.children()[2].node(), Vec3(0, 0, -1), 0);
        check_face(box.children()[3].node(), Vec3(0, 0, 1), 0.7);
        check_face(box.children()[4].node(), Vec3(0, 1, 0), 0.3);
        check_face(box.children()[5].node(), Vec3(1, 0, 0), 0.1);
    }
}

TEST_CASE("the hull of points on a sphere touches every one of them") {
    const Scene scene = scene_of(
        "local p = {} for i = 1, 200 do\n"
        "  local z, a = 2 * math.random() - 1, 2 * math.pi * math.random()\n"
        "  local s = math.sqrt(1 - z * z) p[i] = { s * math.cos(a), s * math.sin(a), z } end\n"
        "return { solids = { convex(p) } }");
    const DensityNode& ball = density_of(scene);
    CHECK(ball.children().size() == 2 * 200 - 4);  // triangles, by Euler's formula
    for (const Density& face : ball.children()) {
        CHECK(face.node().offset() < 1);
        CHECK(face.node().offset() > 0.8);
    }
}

TEST_CASE("twelve pentagons: faces in one plane are merged though their corners are rounded") {
    const Scene scene = scene_of(
        "local g, p = (1 + math.sqrt(5)) / 2, {}\n"
        "for _, i in ipairs{-1, 1} do for _, j in ipairs{-1, 1} do\n"
        "  for _, k in ipairs{-1, 1} do p[#p + 1] = {i, j, k} end\n"
        "  p[#p + 1] = {0, i * g, j / g} p[#p + 1] = {i / g, 0, j * g} p[#p + 1] = {i * g, j / g, "
        "0}\n"
        "end end return { solids = { convex(p) } }");
    CHECK(density_of(scene).children().size() == 12);
}

TEST_CASE("a prism takes either winding, and points along its sides") {
    for (const char* polygon : {"{0,0}, {2,0}, {2,1}, {0,1}", "{0,1}, {2,1}, {2,0}, {0,0}",
                                "{1,0}, {2,0}, {2,0}, {2,0.5}, {2,1}, {0,1}, {0,0}, {0.5,0}, {1,0}"}) {
        const Scene scene = scene_with(std::string("prism({ ") + polygon + " }, -1, 3)");
        const DensityNode& prism = density_of(scene);
        REQUIRE(prism.children().size() == 6);
        CHECK(has_face(prism, Vec3(0, 1, 0), 3));
        CHECK(has_face(prism, Vec3(0, -1, 0), 1));
        CHECK(has_face(prism, Vec3(1, 0, 0), 2));
        CHECK(has_face(prism, Vec3(-1, 0, 0), 0));
        CHECK(has_face(prism, Vec3(0, 0, 1), 1));
        CHECK(has_face(prism, Vec3(0, 0, -1), 0));
    }
}

TEST_CASE("a prism along y has points {x, z}, along z {x, y} and along x {y, z}, and without a word the scene's up") {
    const std::string points = "{ {0,0}, {2,0}, {2,1}, {0,1} }";
    const auto box_of = [](const Scene& scene) { return bounding_box(flatten(scene.solids.at(0))); };
    const auto near = [](Vec3 a, Vec3 b) { return glm::distance(a, b) < 1e-6; };
    const auto body = [&](const std::string& rest, const std::string& up = "") {
        return box_of(scene_of("return { " + up + " solids = { prism(" + points + ", 5, 6" + rest + ") } }"));
    };
    CHECK(near(body("").hi, {2, 6, 1}));
    CHECK(near(body(", { axis = 'y' }").hi, {2, 6, 1}));
    CHECK(near(body(", { axis = 'z' }").hi, {2, 1, 6}));
    CHECK(near(body(", { axis = 'x' }").hi, {6, 2, 1}));
    CHECK(near(body("", "up = 'z',").hi, {2, 1, 6}));
    CHECK(near(body(", { axis = 'y' }", "up = 'z',").hi, {2, 6, 1}));
    CHECK(near(body("", "up = 'y',").hi, {2, 6, 1}));
    // `up` may be computed, or stand where it is meaningless.
    CHECK(near(body("", "up = string.char(122),").hi, {2, 1, 6}));
    CHECK(near(body("", "up = ({ up = 'z', y = 'y' }).y,").hi, {2, 6, 1}));
    // A description printed while the scene runs takes `up` into account.
    CHECK(
        scene_of("local p = prism(" + points + ", 5, 6)\nreturn { up = \"z\", solids = { cube():name(tostring(p)) } }")
            .names.at(0) == "density of 6 half-spaces, [0, 2] x [0, 1] x [5, 6]");
}

TEST_CASE("with z up the sky, the camera and a frame turn") {
    const Scene scene = scene_of("return { up = 'z', background = sky{}, camera = frame{}, solids = { cube() } }");
    CHECK(scene.background.towards({0, 0, 1}) == scene.background.zenith);
    CHECK(scene.background.towards({0, 1, 0}) == scene.background.horizon);
    CHECK(SkyLight(scene.background).mean({0, 0, 1}) ==
          SkyLight(scene_of("return { background = sky{}, solids = { cube() } "
                            "}")
                       .background)
              .mean({0, 1, 0}));
    CHECK(scene.camera.up == Vec3(0, 0, 1));
    CHECK(scene.framing->from == Vec3(3, -4, 2));
    CHECK(scene_of("return { up = 'z', solids = { cube() } }").framing->from == Vec3(3, -4, 2));
    CHECK(scene_of("return { up = 'z', camera = { target = {9, 9, 9} }, solids = { cube() } }").camera.up ==
          Vec3(0, 0, 1));
}

TEST_CASE("operators on densities build densities and remember the line") {
    const auto built = [](const char* expression, DensityNode::Kind kind, int line) {
        CAPTURE(expression);
        const Scene scene = scene_of(std::string("local a, b = cube(), halfspace({1, 0, 0}, 0)\nlocal c =\n") +
                                     expression + "\nreturn { solids = { c } }");
        const DensityNode& node = density_of(scene);
        CHECK(node.kind == kind);
        CHECK(node.line == line);
        CHECK(node.children()[0].node().kind == DensityNode::Kind::product);
        if (kind != DensityNode::Kind::complement)
            CHECK(node.children()[1].node().kind == DensityNode::Kind::half_space);
    };
    built("a + b", DensityNode::Kind::sum, 3);
    built("a * b", DensityNode::Kind::product, 3);
    built("a - b", DensityNode::Kind::difference, 3);
    built("a | b", DensityNode::Kind::disjunction, 0);
    built("a & b", DensityNode::Kind::conjunction, 0);
    built("~a", DensityNode::Kind::complement, 0);
}

TEST_CASE("solids are combined, and a density among them is a sharp solid") {
    const auto kinds = [](const char* expression) {
        const Scene scene = scene_of(std::string("local s, d = rounded(0.5, cube()), cube()\n"
                                                 "return { solids = { ") +
                                     expression + " } }");
        const SolidNode& node = only_solid(scene);
        REQUIRE(node.children().size() == 2);
        return std::tuple(node.kind, node.children()[0].node().radius(), node.children()[1].node().radius());
    };
    using S = SolidNode::Kind;
    CHECK(kinds("s | s") == std::tuple(S::unite, 0.5, 0.5));
    CHECK(kinds("s & d") == std::tuple(S::intersect, 0.5, 0.0));
    CHECK(kinds("d - s") == std::tuple(S::subtract, 0.0, 0.5));
    const Scene scene = scene_of("local a = cube()\nlocal b = rounded(0.25, a)\nreturn { solids = { a, b } }");
    CHECK(scene.solids[0].node().radius() == 0.0);
    CHECK(scene.solids[0].node().line == 1);
    CHECK(scene.solids[1].node().radius() == 0.25);
    CHECK(scene.solids[1].node().line == 2);
}

TEST_CASE("radius is a step of the density") {
    const Scene scene = scene_with("cube():radius(0.25)");
    CHECK(density_of(scene).kind == DensityNode::Kind::radius);
    CHECK(density_of(scene).radius() == 0.25);
}

TEST_CASE("placements of densities and solids are exact along the axes") {
    const auto map_of = [](const std::string& call) {
        const Scene of_density = scene_with("cube():" + call);
        const Scene of_solid = scene_with("sharp(cube()):" + call);
        CHECK(density_of(of_density).kind == DensityNode::Kind::transform);
        CHECK(only_solid(of_solid).kind == SolidNode::Kind::transform);
        CHECK(same_map(density_of(of_density).map(), only_solid(of_solid).map()));
        return density_of(of_density).map();
    };
    const auto diagonal = [](double x, double y, double z) {
        return Mat3(Vec3(x, 0, 0), Vec3(0, y, 0), Vec3(0, 0, z));
    };
    CHECK(same_map(map_of("translate(1, 2, 3)"), {Mat3(1.0), Vec3(1, 2, 3)}));
    CHECK(same_map(map_of("scale(2)"), {diagonal(2, 2, 2), Vec3(0)}));
    CHECK(same_map(map_of("scale(1, -2, 3)"), {diagonal(1, -2, 3), Vec3(0)}));
    CHECK(same_map(map_of("mirror({0, 0.1, 0})"), {diagonal(1, -1, 1), Vec3(0)}));
    CHECK(same_map(map_of("rotate(180, {0, 0, 3})"), {diagonal(-1, -1, 1), Vec3(0)}));
    CHECK(same_map(map_of("rotate(720, {1, 2, 3})"), {Mat3(1.0), Vec3(0)}));
    for (const char* quarter : {"rotate(90, {0, 0, 1})", "rotate(-270, {0, 0, 1})", "rotate(90, {0, 0, 0.3})",
                                "rotate(-90, {0, 0, -1})", "rotate(450, {0, 0, 1})"}) {
        CAPTURE(quarter);
        const Affine map = map_of(quarter);
        CHECK(map(Vec3(1, 0, 0)) == Vec3(0, 1, 0));
        CHECK(map(Vec3(0, 1, 0)) == Vec3(-1, 0, 0));
        CHECK(map(Vec3(0, 0, 1)) == Vec3(0, 0, 1));
    }
    CHECK(map_of("rotate(90, {1, 0, 0})")(Vec3(0, 1, 0)) == Vec3(0, 0, 1));
    CHECK(map_of("rotate(90, {0, 1, 0})")(Vec3(0, 0, 1)) == Vec3(1, 0, 0));
    const Vec3 turned = map_of("rotate(120, {1, 1, 1})")(Vec3(1, 2, 3));
    CHECK(glm::distance(turned, Vec3(3, 1, 2)) < 1e-15 * 10);
}

TEST_CASE("a material is stored once, and solids without one have index 0") {
    const Scene scene = scene_of(
        "local red = plastic{ color = {1, 0, 0}, roughness = 0.5, ior = 1.4 }\n"
        "return { solids = { cube():material(red), cube(), cube():material(glass()), "
        "cube():material(red) } }");
    REQUIRE(scene.materials.size() == 3);
    CHECK(scene.materials[0].kind == Material::Kind::matte);
    CHECK(scene.materials[1].kind == Material::Kind::plastic);
    CHECK(scene.materials[1].color.a == Vec3(1, 0, 0));
    CHECK(scene.materials[1].roughness == 0.5);
    CHECK(scene.materials[1].ior == 1.4);
    CHECK(scene.materials[2].kind == Material::Kind::glass);
    CHECK(scene.solids[0].node().kind == SolidNode::Kind::material);
    CHECK(scene.solids[0].node().material() == 1);
    CHECK(scene.solids[1].node().kind == SolidNode::Kind::rounded);
    CHECK(scene.solids[2].node().material() == 2);
    CHECK(scene.solids[3].node().material() == 1);
}

TEST_CASE("textures") {
    const Scene scene = scene_of(
        "return { solids = { cube():material(matte{ color = checker{ a = 1, b = {0, 0, 1}, scale = "
        "2 } }),\n"
        "cube():material(metal{ color = wood{ axis = {0, 3, 0}, origin = {1, 2, 3} } }) } }");
    const Texture &checker = scene.materials[1].color, &wood = scene.materials[2].color;
    CHECK(checker.kind == Texture::Kind::checker);
    CHECK(checker.a == Vec3(1));
    CHECK(checker.b == Vec3(0, 0, 1));
    CHECK(checker.scale == 2);
    CHECK(wood.kind == Texture::Kind::wood);
    CHECK(wood.axis == Vec3(0, 1, 0));
    CHECK(wood.origin == Vec3(1, 2, 3));
}

TEST_CASE("picture, camera, lights and background") {
    const Scene scene = scene_of(R"(return {
        image = { width = 20, height = 10, spp = 4, bounces = 2 },
        camera = { eye = {0, 0, 5}, target = {0, 0, 1}, up = {0, 2, 0}, fov = 60 },
        lights = { point_light{ position = {1, 2, 3}, color = {1, 0.5, 0}, power = 7 },
                   directional_light{ direction = {0, -2, 0} },
                   area_light{ position = {0, 3, 0}, u = {1, 0, 0}, v = {0, 0, 2}, samples = 16 } },
        background = sky{ zenith = {0, 0, 2} }, ambient = 0.25, solids = { cube():name("lid"), cube() } })");
    CHECK(scene.file == "s.lua");
    CHECK(scene.width == 20);
    CHECK(scene.height == 10);
    CHECK(scene.spp == 4);
    CHECK(scene.bounces == 2);
    CHECK(scene.camera.eye == Vec3(0, 0, 5));
    CHECK(scene.camera.up == Vec3(0, 1, 0));
    CHECK(scene.camera.fov == 60);
    REQUIRE(scene.lights.size() == 3);
    CHECK(scene.lights[0].color == Vec3(1, 0.5, 0));
    CHECK(scene.lights[0].power == 7);
    CHECK(scene.lights[1].kind == Light::Kind::directional);
    CHECK(scene.lights[1].direction == Vec3(0, -1, 0));
    CHECK(scene.lights[2].kind == Light::Kind::area);
    CHECK(scene.lights[2].samples == 16);
    CHECK(scene.background.sky);
    CHECK(scene.background.zenith == Vec3(0, 0, 2));
    CHECK(scene.ambient == Vec3(0.25));
    CHECK(scene.names == std::vector<std::string>{"lid", ""});
}

TEST_CASE("a scene of solids alone has a camera and a light") {
    const Scene scene = scene_with("cube()");
    CHECK(scene.camera.fov == Camera{}.fov);
    CHECK(scene.framing);
    CHECK(scene.lights.size() == 1);
    CHECK(scene.background.sky);
    CHECK(scene_of("return { lights = {}, solids = { cube() } }").lights.empty());
}

TEST_CASE(
    "the default light shows white surfaces that face lamp and sky as 0.9, or keeps a third of it beside a bright "
    "sky") {
    const auto shown = [](const std::string& fields) {
        const Scene scene = scene_of("return { " + fields + " solids = { cube() } }");
        REQUIRE(scene.lights.size() == 1);
        const SkyLight sky(scene.background);
        const Vec3 up = scene.ambient + sky.mean({0, 1, 0});
        return std::pair(scene.lights[0].power / pi, max_component(up));
    };
    for (const char* fields : {"", "background = 0.3,", "background = 0,", "background = sky{},",
                               "background = sky{ horizon = 0.1, zenith = {0.2, 0.3, 0.4} },"}) {
        CAPTURE(fields);
        const auto [lamp, fill] = shown(fields);
        CHECK(lamp + fill == Approx(0.9).epsilon(1e-3));
        CHECK(fill > 0.05);
        CHECK(lamp >= 0.27);
    }
    CHECK(shown("background = 5,").first == Approx(0.27));
    CHECK(scene_of("return { ambient = 0.1, solids = { cube() } }").lights.empty());
    CHECK_FALSE(scene_of("return { lights = {}, solids = { cube() } }").background.sky);
}

TEST_CASE("parameters take the command line's value in the default's type") {
    const std::string text =
        "local n, r, on, s = param('n', 3), param('r', 0.1), param('on', true), param('s', 'a')\n"
        "assert(math.type(n) == 'integer' and (on == true) == (s == 'a'))\n"
        "return { solids = { rounded(r * n, cube()) } }";
    const Scene plain = scene_of(text);
    CHECK(only_solid(plain).radius() == 3 * 0.1);
    CHECK(plain.parameters == std::map<std::string, std::string>{{"n", "3"}, {"r", "0.1"}, {"on", "true"}, {"s", "a"}});
    const Scene given = scene_of(text, {{"n", "2"}, {"r", "2.5e-1"}, {"on", "false"}, {"s", ""}});
    CHECK(only_solid(given).radius() == 0.5);
    CHECK(given.parameters.at("r") == "2.5e-1");
}

TEST_CASE("a hundred thousand parts in one expression are read and freed without recursion") {
    const Scene scene = scene_of(
        "local a, s = cube(), sharp(cube())\n"
        "for i = 1, 100000 do local h = halfspace({1, 0, 0}, i) a = a | h s = s - h end\n"
        "return { solids = { a, s } }");
    CHECK(scene.solids[0].node().leaves == 100'006);
    CHECK(scene.solids[1].node().leaves == 100'006);
}

TEST_CASE("half-spaces of what is placed again and again count once") {
    const Scene scene = scene_of(
        "local s = sharp(cube())\n"
        "for i = 1, 40 do s = s | s:translate(2 ^ i, 0, 0) end\n"
        "return { solids = { s } }");
    CHECK(scene.solids[0].node().leaves == 6 * std::pow(2.0, 40));
    CHECK(half_spaces_to_lay_out(scene.solids) == 6);
}

TEST_CASE("a first line for the shell and a byte order mark are passed over") {
    const std::string scene = "return { solids = { cube() } }";
    CHECK(scene_of("#!/usr/bin/env deburr\n" + scene).solids.size() == 1);
    CHECK(scene_of("\xEF\xBB\xBF" + scene).solids.size() == 1);
}

TEST_CASE("the first scene") {
    const Scene scene = read_scene(DEBURR_SOURCE_DIR "/scenes/first.lua", {{"r", "0.2"}});
    REQUIRE(scene.solids.size() == 2);
    const SolidNode& body = scene.solids[0].node();
    REQUIRE(body.kind == SolidNode::Kind::material);
    CHECK(body.children()[0].node().radius() == 0.2);
    CHECK(body.children()[0].node().density().node().kind == DensityNode::Kind::difference);
    CHECK(body.leaves == 13);
    CHECK(scene.materials.size() == 3);
}
