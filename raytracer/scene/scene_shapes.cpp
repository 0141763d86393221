// Shapes with flat faces in scenes, as densities: half-spaces, boxes, convex hulls and prisms.
#include <fmt/format.h>

#include <optional>

#include "raytracer/scene/convex_hull.hpp"
#include "raytracer/scene/polygon.hpp"
#include "raytracer/scene/scene_arguments.hpp"

namespace deburr {
namespace {

constexpr std::size_t max_hull_points = 100'000;

// Instructions that take as long as computing the hull, for each point: 100,000 points on a sphere take 0.8 s.
constexpr std::int64_t work_per_hull_point = 2'500;

// Memory of qhull for each point of a hull, and of its faces here, which are twice as many; measured with points on a
// sphere.
constexpr std::size_t bytes_per_hull_point = 1'000;

constexpr std::size_t max_polygon_points = 4'096;  // the check for crossing sides is quadratic
constexpr std::size_t max_holes = 4'096;

SceneResult half_space(SceneCall& call) {
    call.at_most(2);
    const Vec3 given = vector(call.argument(0), call.location("normal"));
    const Vec3 normal = direction(call.argument(0), call.location("normal"));
    const double offset = number(call.argument(1), call.location("d"));
    // The plane given · x = offset; exact along an axis, and without a length that could overflow.
    const double length = glm::dot(given, normal), distance = offset / length;
    if (!(length > 0 && std::isfinite(length) && std::isfinite(distance)))
        throw BadValue(call.name, "expected a normal and a distance of ordinary size, got singular ones");
    return call.make(Density::half_space(normal, distance));
}

SceneResult cube(SceneCall& call) {
    call.at_most(0);
    call.builder.keep_half_spaces(6);
    return call.make(Density::box(Vec3(0), Vec3(1)));
}

SceneResult box(SceneCall& call) {
    call.at_most(2);
    const Vec3 lo = vector(call.argument(0), call.location("lower corner"));
    const Vec3 hi = vector(call.argument(1), call.location("upper corner"));
    for (int k = 0; k < 3; ++k)
        if (!(lo[k] < hi[k]))
            throw BadValue(call.name, fmt::format("expected {0}0 < {0}1, got {1} and {2}", "xyz"[k], lo[k], hi[k]));
    call.builder.keep_half_spaces(6);
    return call.make(Density::box(lo, hi));
}

SceneResult product_of(SceneCall& call, const std::vector<HullFace>& faces) {
    SceneBuilder::check_size(double(faces.size()));
    call.builder.keep_half_spaces(faces.size());
    std::vector<Density> parts;
    for (const HullFace& face : faces) parts.push_back(Density::half_space(face.normal, face.offset));
    return call.make(Density::product(parts));
}

SceneResult convex(SceneCall& call) {
    call.at_most(1);
    const std::vector<LuaValue>& given = need_list(call.argument(0), call.name, "points", max_hull_points);
    call.builder.spend(work_per_hull_point * std::int64_t(given.size()));
    call.builder.borrow(bytes_per_hull_point * given.size());
    std::vector<Vec3> points;
    for (const LuaValue& point : given) points.push_back(vector(point, item(call.name, points.size())));
    return product_of(call, convex_hull(std::move(points)));
}

std::vector<Vec2> polygon_of(SceneCall& call, const LuaValue& value, const std::string& location, PrismAxis axis) {
    const std::vector<LuaValue>& given = need_list(value, location, "points", max_polygon_points);
    // Each side is compared with every other.
    call.builder.spend(2 * std::int64_t(given.size()) * std::int64_t(given.size()));
    call.builder.keep_half_spaces(2 * given.size() + 2);  // with the operators between them
    constexpr const char* pairs[] = {"two numbers {y, z}", "two numbers {x, z}", "two numbers {x, y}"};
    std::vector<Vec2> polygon;
    for (const LuaValue& point : given) {
        const std::string at = item(location, polygon.size());
        const LuaTable* pair = as_table(point);
        if (!pair || !pair->fields.empty() || pair->list.size() != 2) expected(at, pairs[int(axis)], point);
        polygon.emplace_back(number(pair->list[0], at), number(pair->list[1], at));
    }
    return polygon;
}

PrismAxis prism_axis(const LuaValue& value, const std::string& location) {
    const auto* name = std::get_if<std::string>(&value);
    if (name && *name == "x") return PrismAxis::x;
    if (name && *name == "y") return PrismAxis::y;
    if (name && *name == "z") return PrismAxis::z;
    expected(location, "'x', 'y' or 'z'", value);
}

SceneResult make_prism(SceneCall& call) {
    call.at_most(4);
    PrismAxis axis = call.builder.z_up ? PrismAxis::z : PrismAxis::y;
    const LuaValue* holes = nullptr;
    std::optional<Fields> options;
    if (call.arguments.size() > 3)
        options.emplace(call.arguments[3], call.location("options"),
                        std::initializer_list<const char*>{"axis", "holes"});
    const LuaValue* given_axis = options ? options->find("axis") : nullptr;
    if (given_axis)
        axis = prism_axis(*given_axis, options->location("axis"));
    else
        call.builder.up_mattered = true;
    if (options) holes = options->find("holes");

    const std::vector<Vec2> polygon = polygon_of(call, call.argument(0), call.name, axis);
    const double low = number(call.argument(1), call.location("low"));
    const double high = number(call.argument(2), call.location("high"));
    SceneBuilder::check_size(double(polygon.size()) + 2);
    Density body = prism(polygon, low, high, axis);
    if (!holes) return call.make(std::move(body));
    const std::string location = options->location("holes");
    for (std::size_t i = 0; const LuaValue& hole : need_list(*holes, location, "lists of points", max_holes)) {
        const std::string at = item(location, i++);
        const std::vector<Vec2> points = polygon_of(call, hole, at, axis);
        try {
            body = std::move(body) & ~raised_polygon(points, axis);
        } catch (const std::runtime_error& error) {
            throw BadValue(at, error.what());
        }
    }
    return call.make(std::move(body));
}

}  // namespace

const std::vector<SceneFunction>& shape_functions() {
    using Kind = SceneFunction::Kind;
    static const std::vector<SceneFunction> functions = {
        {Kind::global, "halfspace", "", half_space},
        {Kind::global, "cube", "", cube},
        {Kind::global, "box", "", box},
        {Kind::global, "convex", "", convex},
        {Kind::global, "prism", "", make_prism},
    };
    return functions;
}

}  // namespace deburr
