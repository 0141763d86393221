// Quadrics, perturbations and free forms in scenes [Vyatkin §3.1].
#include <fmt/format.h>

#include <algorithm>

#include "raytracer/scene/scene_functions.hpp"

namespace deburr {
namespace {

// Largest coefficient, with which cubes of quadrics stay far inside the range of a double.
constexpr double largest_coefficient = 1e50;

constexpr std::size_t max_perturbations = 100'000;

// Instructions that take as long as bounding a free form, for each perturbation.
constexpr std::int64_t work_per_perturbation = 20'000;

const LuaValue& only_argument(const SceneCall& call, const char* what) {
    call.at_most(1);
    if (!as_table(call.argument(0))) expected(call.name, what, call.argument(0));
    return call.argument(0);
}

double coefficient(const LuaValue& value, const std::string& location) {
    const double c = number(value, location);
    if (!(std::abs(c) <= largest_coefficient))
        expected(location, fmt::format("a coefficient of at most {:g}", largest_coefficient), value);
    return c;
}

SceneResult checked(SceneCall& call, const Quadric& quadric) { return call.make(ordinary(quadric, call.name)); }

SceneResult quadric(SceneCall& call) {
    static constexpr const char* names[10] = {"xx", "yy", "zz", "xy", "xz", "yz", "x", "y", "z", "c"};
    const LuaValue& given = only_argument(call, "coefficients { xx = … } or a list of ten");
    double c[10] = {};
    const LuaTable& table = *as_table(given);
    if (!table.list.empty()) {
        if (table.list.size() != 10 || !table.fields.empty())
            throw BadValue(call.name, fmt::format("expected ten coefficients (xx yy zz xy xz yz x y z c), got {}{}",
                                                  table.list.size(), table.fields.empty() ? "" : " and names"));
        for (std::size_t i = 0; i < 10; ++i)
            c[i] = coefficient(table.list[i], fmt::format("{}: {}", call.name, names[i]));
    } else {
        const Fields fields(given, call.name, {"xx", "yy", "zz", "xy", "xz", "yz", "x", "y", "z", "c"});
        for (int i = 0; i < 10; ++i)
            if (const LuaValue* value = fields.find(names[i])) c[i] = coefficient(*value, fields.location(names[i]));
    }
    const Quadric result = quadric_from(c);
    if (result.is_constant())
        throw BadValue(
            call.name,
            fmt::format("expected a surface: a coefficient besides c that is not 0, got only c = {:g}", c[9]));
    return call.make(result);
}

// The fields that all quadrics with an axis have.
struct Placed {
    explicit Placed(const SceneCall& call, const char* at, std::initializer_list<const char*> known)
        : fields(only_argument(call, "a table of fields"), call.name, known) {
        if (const LuaValue* given = fields.find(at)) center = vector(*given, fields.location(at));
        if (const LuaValue* given = fields.find("axis")) axis = direction(*given, fields.location("axis"));
        radius = length("radius", radius);
        height = length("height", height);
    }
    double length(const char* name, double otherwise) const {
        const LuaValue* given = fields.find(name);
        return given ? number_above(*given, fields.location(name), 0) : otherwise;
    }
    Quadric revolved(const Revolution& revolution) const {
        return deburr::revolved(revolution, center, axis, radius, height);
    }

    Fields fields;
    Vec3 center{0.0}, axis{0, 1, 0};
    double radius = 1, height = 1;
};

SceneResult ellipsoid(SceneCall& call) {
    const Fields fields(only_argument(call, "a table of fields"), call.name, {"center", "radius", "radii"});
    Quadric q;
    q.k = 1;
    if (const LuaValue* given = fields.find("center")) q.center = vector(*given, fields.location("center"));
    Vec3 radii(1.0);
    if (const LuaValue* given = fields.find("radius")) radii = Vec3(number_above(*given, fields.location("radius"), 0));
    if (const LuaValue* given = fields.find("radii")) {
        if (fields.find("radius")) throw BadValue(call.name, "expected radius or radii, got both");
        radii = vector(*given, fields.location("radii"));
        for (int k = 0; k < 3; ++k)
            if (!(radii[k] > 0)) expected(fields.location("radii"), "three numbers > 0", *given);
    }
    for (int k = 0; k < 3; ++k) q.A[k][k] = -1 / (radii[k] * radii[k]);
    return checked(call, q);
}

bool has_any(const SceneCall& call, std::initializer_list<const char*> names) {
    const LuaTable* table = as_table(call.argument(0));
    return table &&
           std::any_of(names.begin(), names.end(), [&](const char* name) { return table->fields.contains(name); });
}

// Whether the fields are those of a round part, which has ends; OpenSCAD's names count, too.
bool is_round(const SceneCall& call) {
    return has_any(call, {"from", "to", "h", "r", "r1", "r2", "d", "d1", "d2", "diameter"});
}

SceneResult cylinder(SceneCall& call) {
    if (is_round(call) || has_any(call, {"height"})) return round_cylinder(call);
    const Placed p(call, "center", {"center", "axis", "radius"});
    return checked(call, p.revolved({1, 0, 0, -1}));
}

SceneResult cone(SceneCall& call) {
    if (is_round(call)) return round_cone(call);
    const Placed p(call, "apex", {"apex", "axis", "radius", "height"});
    return checked(call, p.revolved({0, 0, 1, -1}));
}

SceneResult paraboloid(SceneCall& call) {
    const Placed p(call, "apex", {"apex", "axis", "radius", "height"});
    return checked(call, p.revolved({0, 1, 0, -1}));
}

SceneResult hyperboloid(SceneCall& call) {
    const Placed p(call, "center", {"center", "axis", "radius", "height", "sheets"});
    int sheets = 1;
    if (const LuaValue* given = p.fields.find("sheets")) sheets = integer(*given, p.fields.location("sheets"), 1, 2);
    return checked(call, p.revolved({sheets == 1 ? 1.0 : -1.0, 0, 1, -1}));
}

const Quadric& need_quadric(const SceneCall& call, std::size_t index) {
    const auto* quadric = as<Quadric>(as_object(call.argument(index)));
    if (!quadric) expected(call.name, "a quadric", call.argument(index));
    return *quadric;
}

SceneResult perturbation(SceneCall& call) {
    call.at_most(2);
    const double factor = coefficient(call.argument(0), call.location("factor"));
    const Quadric& quadric = need_quadric(call, 1);
    if (quadric.range_everywhere().hi <= 0)
        throw BadValue(call.name, "expected a quadric that is positive somewhere, got one that is <= 0 everywhere");
    return call.make(Perturbation{factor, quadric});
}

SceneResult freeform(SceneCall& call) {
    call.at_most(2);
    const Quadric& base = need_quadric(call, 0);
    const LuaTable* given = as_table(call.argument(1));
    if (!given || !given->fields.empty()) expected(call.name, "a list of perturbations", call.argument(1));
    if (given->list.size() > max_perturbations)
        throw BadValue(call.name,
                       fmt::format("expected at most {} perturbations, got {}", max_perturbations, given->list.size()));
    call.builder.spend(work_per_perturbation * std::int64_t(given->list.size()));
    std::vector<Perturbation> perturbations;
    for (const LuaValue& item : given->list) {
        const auto* perturbation = as<Perturbation>(as_object(item));
        if (!perturbation) expected(fmt::format("{}[{}]", call.name, perturbations.size() + 1), "a perturbation", item);
        perturbations.push_back(*perturbation);
    }
    call.builder.keep_parts(perturbations.size() * sizeof(Perturbation));
    return call.make(solid_of_free_form(call.name, base, std::move(perturbations), call.line));
}

}  // namespace

Solid solid_of_free_form(const std::string& function, const Quadric& base, std::vector<Perturbation> perturbations,
                         int line) {
    const Range q = base.range_everywhere();
    const auto some = [&](double sign) {
        return std::any_of(perturbations.begin(), perturbations.end(),
                           [&](const Perturbation& p) { return sign * p.factor > 0; });
    };
    if (q.hi <= 0 && !some(1)) throw BadValue(function, "expected a surface, got a quadric that is <= 0 everywhere");
    if (q.lo >= 0 && !some(-1)) throw BadValue(function, "expected a surface, got a quadric that is >= 0 everywhere");
    return Solid::of_field(std::make_shared<FreeForm>(base, std::move(perturbations)), line);
}

const Quadric& ordinary(const Quadric& quadric, const char* function) {
    bool good = std::isfinite(quadric.k) && quadric.largest() <= largest_coefficient;
    for (int i = 0; i < 3; ++i) {
        good &= std::isfinite(quadric.b[i]) && std::isfinite(quadric.center[i]);
        for (int j = 0; j < 3; ++j) good &= std::isfinite(quadric.A[i][j]);
    }
    if (!good) throw BadValue(function, "expected lengths of ordinary size, got such that coefficients overflow");
    return quadric;
}

const std::vector<SceneFunction>& free_form_functions() {
    using Kind = SceneFunction::Kind;
    static const std::vector<SceneFunction> functions = {
        {Kind::global, "quadric", "", quadric},           {Kind::global, "ellipsoid", "", ellipsoid},
        {Kind::global, "cylinder", "", cylinder},         {Kind::global, "cone", "", cone},
        {Kind::global, "paraboloid", "", paraboloid},     {Kind::global, "hyperboloid", "", hyperboloid},
        {Kind::global, "perturbation", "", perturbation}, {Kind::global, "freeform", "", freeform},
    };
    return functions;
}

}  // namespace deburr
