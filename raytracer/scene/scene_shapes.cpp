// Shapes, operators and placements of a scene.
#include <fmt/format.h>

#include <optional>

#include "bounds/density_tree.hpp"
#include "raytracer/scene/convex_hull.hpp"
#include "raytracer/scene/polygon.hpp"
#include "raytracer/scene/round_convolution.hpp"
#include "raytracer/scene/scene_functions.hpp"

namespace deburr {
namespace {

constexpr std::size_t max_hull_points = 100'000;

// Instructions that take as long as finding the hull, for each point: 100,000 points on a sphere
// take 0.8 s.
constexpr std::int64_t work_per_hull_point = 2'500;

// Memory of qhull's for each point of a hull, and ours for its faces, which are twice as many. Points on a sphere take
// it.
constexpr std::size_t bytes_per_hull_point = 1'000;

// Instructions that take as long as laying out a part.
constexpr std::int64_t work_per_round_part = 20;

constexpr std::size_t max_polygon_points = 4'096;  // the check that no sides cross takes its square
constexpr std::size_t max_holes = 4'096;

const Density* as_density(const LuaValue& value) { return as<Density>(as_object(value)); }

bool is_set(const LuaValue& value) {  // something with an inside
    const SceneObject* object = as_object(value);
    return as<Density>(object) || as<Solid>(object) || as<Quadric>(object) || as<PlacedModel>(object);
}

const SceneObject& need_set(const LuaValue& value, const char* location) {
    if (!is_set(value)) expected(location, "a density or a solid", value);
    return *as_object(value);
}

const SceneObject& need_movable(const LuaValue& value, const char* location) {
    const SceneObject* object = as_object(value);
    if (as<Perturbation>(object)) return *object;
    return need_set(value, location);
}

const Density& need_density(const LuaValue& value, const char* location, const char* what = "a density") {
    const Density* density = as_density(value);
    if (!density && as<PlacedModel>(as_object(value)))
        expected(location, "a density; convolved(r, m) rounds a model, sharp(m) leaves it as it is", value);
    if (as<Quadric>(as_object(value)))
        throw BadValue(location,
                       "expected a density, got a quadric, which cannot be rounded with others: write sphere{…}, "
                       "cylinder{ from =, to = } or cone{ from =, to = }, or join it to rounded solids by | & -");
    if (as<Solid>(as_object(value)))
        throw BadValue(
            location,
            "expected a density, got a solid, which is rounded already: join densities first, then round, as "
            "in rounded(r, a | b)");
    if (!density) expected(location, what, value);
    return *density;
}

const std::vector<LuaValue>& need_list(const LuaValue& value, const std::string& location, const char* of_what,
                                       std::size_t most) {
    const LuaTable* table = as_table(value);
    if (!table || !table->fields.empty()) expected(location, std::string("a list of ") + of_what, value);
    if (table->list.size() > most)
        throw BadValue(location, fmt::format("expected at most {} {}, got {}", most, of_what, table->list.size()));
    return table->list;
}

std::string item(const std::string& location, std::size_t index) { return fmt::format("{}[{}]", location, index + 1); }

// Shapes.

SceneResult half_space(SceneCall& call) {
    call.at_most(2);
    const Vec3 given = vector(call.argument(0), call.location("normal"));
    const Vec3 normal = direction(call.argument(0), call.location("normal"));
    const double offset = number(call.argument(1), call.location("d"));
    // The plane is given · x = offset; along an axis this is exact, and no length overflows.
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
    // Each side is compared with each.
    call.builder.spend(2 * std::int64_t(given.size()) * std::int64_t(given.size()));
    call.builder.keep_half_spaces(2 * given.size() + 2);  // and the operators between them
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

SceneResult rounded(SceneCall& call) {
    call.at_most(2);
    const double radius = number_at_least(call.argument(0), call.location("radius"), 0);
    const Density& density = need_density(call.argument(1), call.name);
    if (density.node().has_round) {
        SceneBuilder::check_size(density.node().leaves);
        call.builder.spend(work_per_round_part * std::int64_t(density.node().leaves));
        try {
            flatten(density, radius);
        } catch (const BadRoundPart& error) {
            throw BadValue(call.name, error.what());
        }
    }
    return call.make(Solid::rounded(radius, density, call.line));
}

SceneResult convolved(SceneCall& call) {
    call.at_most(3);
    const double radius = number_above(call.argument(0), call.location("radius"), 0);
    const LuaValue& options = call.argument(2);
    const KeepSharp keep = is_nil(options) ? KeepSharp{} : keep_sharp(options, call.location("options"));
    if (const auto* model = as<PlacedModel>(as_object(call.argument(1))))
        return call.make(call.builder.solid(*model, radius, call.line, keep));
    if (keep.any()) expected(call.name, "a model where something is kept sharp", call.argument(1));
    const Density& density = need_density(call.argument(1), call.name, "a density or a model");
    if (density.has_radius())
        throw BadValue(call.name,
                       "expected a density without radii, got one with :radius(); one ball rounds all of it");
    if (density.node().has_round) {
        try {
            return call.make(convolved_round(radius, density, call.line));
        } catch (const BadRoundPart& error) {
            throw BadValue(call.name, error.what());
        } catch (const NoRoundConvolution& error) {
            throw BadValue(call.name, error.what());
        }
    }
    return call.make(Solid::convolved(radius, density, call.line));
}

SceneResult sharp(SceneCall& call) {
    call.at_most(1);
    if (const auto* model = as<PlacedModel>(as_object(call.argument(0))))
        return call.make(call.builder.solid(*model, 0, call.line));
    return call.make(Solid::sharp(need_density(call.argument(0), call.name, "a density or a model"), call.line));
}

// Operators.

using DensityOperator = Density (*)(Density, Density, int);
using SolidOperator = Solid (*)(Solid, Solid);

// On two densities the first, else, where there is one, the second.
SceneResult combine(SceneCall& call, DensityOperator of_densities, SolidOperator of_solids) {
    const LuaValue &a = call.argument(0), &b = call.argument(1);
    if (as_density(a) && as_density(b)) return call.make(of_densities(*as_density(a), *as_density(b), call.line));
    const LuaValue& wrong = (of_solids ? is_set(a) : as_density(a) != nullptr) ? b : a;
    if (!of_solids) expected(call.name, "densities on both sides (solids have | & -)", wrong);
    if (!is_set(wrong)) expected(call.name, "densities or solids on both sides", wrong);
    return call.make(of_solids(call.builder.solid(*as_object(a)), call.builder.solid(*as_object(b))));
}

SceneResult add(SceneCall& call) { return combine(call, &Density::sum, nullptr); }

SceneResult multiply(SceneCall& call) {
    return combine(call, static_cast<DensityOperator>(&Density::product), nullptr);
}

SceneResult subtract(SceneCall& call) {
    return combine(call, &Density::difference, [](Solid a, Solid b) { return a - b; });
}

SceneResult disjoin(SceneCall& call) {
    return combine(
        call, [](Density a, Density b, int) { return a | b; }, [](Solid a, Solid b) { return a | b; });
}

SceneResult conjoin(SceneCall& call) {
    return combine(
        call, [](Density a, Density b, int) { return a & b; }, [](Solid a, Solid b) { return a & b; });
}

SceneResult complement(SceneCall& call) {
    const Density* density = as_density(call.argument(0));
    if (!density) expected(call.name, "a density", call.argument(0));
    return call.make(~*density);
}

// In Lua a ~ b is an operator, too.
SceneResult complement_of_two(SceneCall& call) {
    throw BadValue(call.name, "expected one density, as in a & ~b, got two, as in a ~ b");
}

// Methods.

SceneResult radius(SceneCall& call) {
    call.at_most(2);
    const Density& density = need_density(call.argument(0), call.name);
    return call.make(density.radius(number_at_least(call.argument(1), call.name, 0)));
}

SceneResult material(SceneCall& call) {
    call.at_most(2);
    const SceneObject& self = need_set(call.argument(0), call.name);
    const SceneObject* given = as_object(call.argument(1));
    if (!as<Material>(given)) expected(call.name, "a material", call.argument(1));
    return call.make(call.builder.solid(self).material(call.builder.index_of(given)), self.name);
}

SceneResult name(SceneCall& call) {
    call.at_most(2);
    const std::string location = call.name;
    const SceneObject& self = need_set(call.argument(0), call.name);
    const std::string& given = text(call.argument(1), location);
    call.builder.memory->take_text(given.size());
    return call.make(call.builder.solid(self), std::make_shared<const std::string>(given));
}

SceneResult transform(SceneCall& call, const Affine& map) {
    const SceneObject& self = need_movable(call.argument(0), call.name);
    if (const auto* density = as<Density>(&self)) {
        if (density->node().has_round && even_scale(map) == 0)
            throw BadValue(call.name,
                           "expected one factor for a density with round parts, got several; scale the "
                           "rounded solid, as in rounded(r, d):scale(x, y, z)");
        return call.make(density->transformed(map));
    }
    if (const auto* quadric = as<Quadric>(&self)) return call.make(ordinary(transformed(*quadric, map), call.name));
    if (const auto* model = as<PlacedModel>(&self))
        return call.make(PlacedModel{model->mesh, compose(map, model->map), model->file});
    if (const auto* p = as<Perturbation>(&self))
        return call.make(Perturbation{p->factor, ordinary(transformed(p->quadric, map), call.name)});
    return call.make(as<Solid>(&self)->transformed(map), self.name);
}

SceneResult translate(SceneCall& call) {
    call.at_most(4);
    need_movable(call.argument(0), call.name);
    Affine map;
    for (int k = 0; k < 3; ++k)
        map.shift[k] = number(call.argument(std::size_t(k) + 1), call.location(&"x\0y\0z"[2 * k]));
    return transform(call, map);
}

SceneResult scale(SceneCall& call) {
    call.at_most(4);
    need_movable(call.argument(0), call.name);
    const bool even = call.arguments.size() <= 2;
    Affine map;
    for (int k = 0; k < 3; ++k) {
        const LuaValue& given = call.argument(even ? 1 : std::size_t(k) + 1);
        const std::string where = even ? call.name : call.location(&"x\0y\0z"[2 * k]);
        const double factor = number(given, where);
        // Products of three of these and their inverses stay far inside the range of a double.
        constexpr double largest = 1e100;
        if (!(std::abs(factor) <= largest && std::abs(factor) >= 1 / largest))
            expected(where, "a factor that leaves a volume, for 0 is singular", given);
        map.linear[k][k] = factor;
    }
    return transform(call, map);
}

// Exact at multiples of 90 degrees about an axis, so that planes stay parallel to axes.
SceneResult rotate(SceneCall& call) {
    call.at_most(3);
    need_movable(call.argument(0), call.name);
    const double degrees = std::fmod(number(call.argument(1), call.location("degrees")), 360.0);
    const Vec3 k = direction(call.argument(2), call.location("axis"));
    const int quarters = int(degrees / 90);
    const bool exact = quarters * 90.0 == degrees;
    constexpr double cosines[4] = {1, 0, -1, 0};
    const double c = exact ? cosines[(quarters + 4) % 4] : std::cos(glm::radians(degrees));
    const double s = exact ? cosines[(quarters + 3) % 4] : std::sin(glm::radians(degrees));
    // Rodrigues' formula: R = k kᵀ + cos (1 − k kᵀ) + sin [k]×
    const Mat3 along = glm::outerProduct(k, k);
    const Mat3 across(Vec3(0, k.z, -k.y), Vec3(-k.z, 0, k.x), Vec3(k.y, -k.x, 0));  // by columns
    Affine map;
    map.linear = along + c * (Mat3(1.0) - along) + s * across;
    return transform(call, map);
}

// In the plane through the origin with this normal.
SceneResult mirror(SceneCall& call) {
    call.at_most(2);
    need_movable(call.argument(0), call.name);
    const Vec3 n = direction(call.argument(1), call.location("normal"));
    Affine map;
    map.linear = Mat3(1.0) - 2.0 * glm::outerProduct(n, n);
    return transform(call, map);
}

SceneResult param(SceneCall& call) {
    call.at_most(2);
    return call.builder.parameter(text(call.argument(0), call.location("name")), call.argument(1));
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
        {Kind::global, "rounded", "", rounded},
        {Kind::global, "convolved", "", convolved},
        {Kind::global, "sharp", "", sharp},
        {Kind::global, "param", "", param},
        {Kind::metamethod, "operator +", "__add", add},
        {Kind::metamethod, "operator *", "__mul", multiply},
        {Kind::metamethod, "operator -", "__sub", subtract},
        {Kind::metamethod, "operator |", "__bor", disjoin},
        {Kind::metamethod, "operator &", "__band", conjoin},
        {Kind::metamethod, "operator ~", "__bnot", complement},
        {Kind::metamethod, "operator ~", "__bxor", complement_of_two},
        {Kind::method, "radius", "", radius},
        {Kind::method, "material", "", material},
        {Kind::method, "name", "", name},
        {Kind::method, "translate", "", translate},
        {Kind::method, "scale", "", scale},
        {Kind::method, "rotate", "", rotate},
        {Kind::method, "mirror", "", mirror},
    };
    return functions;
}

}  // namespace deburr
