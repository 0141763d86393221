#include "raytracer/pov/pov_round.hpp"

#include <fmt/format.h>

#include "bounds/free_form.hpp"
#include "bounds/torus.hpp"
#include "raytracer/pov/pov_text.hpp"

namespace deburr {
namespace {

// "(x-0.5)", or "x" if c is 0.
std::string minus(const char* name, double c) { return c == 0 ? name : fmt::format("({}{:+})", name, -c); }

std::string pov_torus(Vec3 center, Vec3 axis, double radius, double tube) {
    // POV-Ray's torus lies around the y axis; the matrix's rows are the images of the axes.
    const Vec3 side = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
    const Vec3 other = glm::cross(side, axis);
    std::string rows;
    for (const Vec3 v : {side, axis, other, center})
        rows += fmt::format("{}{}, {}, {}", rows.empty() ? "" : ", ", v.x, v.y, v.z);
    return fmt::format("torus {{ {}, {} sturm matrix <{}> }}", radius, tube, rows);
}

}  // namespace

std::string pov_coordinate(const RoundCoordinate& c) {
    const std::string x = minus("x", c.center.x), y = minus("y", c.center.y), z = minus("z", c.center.z);
    if (c.kind == RoundCoordinate::Kind::point) return fmt::format("sqrt({0}*{0}+{1}*{1}+{2}*{2})", x, y, z);
    const auto product = [](double k, const std::string& of) { return fmt::format("{}*{}", k, of); };
    const auto difference = [&](double a, const std::string& of, double b, const std::string& from) {
        return fmt::format("pow({}-({}),2)", product(a, of), product(b, from));
    };
    // |axis × y|, which stays accurate near the axis.
    const Vec3 a = c.axis;
    const std::string s = fmt::format("sqrt({}+{}+{})", difference(a.y, z, a.z, y), difference(a.z, x, a.x, z),
                                      difference(a.x, y, a.y, x));
    const std::string t = fmt::format("({}*{}+{}*{}+{}*{})", a.x, x, a.y, y, a.z, z);
    if (c.kind == RoundCoordinate::Kind::circle) return fmt::format("sqrt(pow({}{:+},2)+pow({},2))", s, -c.ring, t);
    return c.along == 0 ? s : fmt::format("({}*{}{:+}*{})", c.across, s, c.along, t);
}

std::string pov_round_part(const RoundCoordinate& c, double offset, const Box& as_far_as) {
    if (c.kind == RoundCoordinate::Kind::point) return fmt::format("sphere {{ {}, {} }}", pov_vector(c.center), offset);
    if (c.kind == RoundCoordinate::Kind::circle) return pov_torus(c.center, c.axis, c.ring, offset);
    const double reach = 2 * (glm::distance(as_far_as.lo, as_far_as.hi) + largest(as_far_as.lo) +
                              largest(as_far_as.hi) + largest(c.center) + std::abs(offset));
    const auto at = [&](double t) { return c.center + c.axis * t; };
    if (!c.is_cone())
        return fmt::format("cylinder {{ {}, {}, {} }}", pov_vector(at(-reach)), pov_vector(at(reach)), offset);
    const double apex = offset / c.along, end = apex - std::copysign(reach, c.along);
    return fmt::format("cone {{ {}, 0, {}, {} }}", pov_vector(at(apex)), pov_vector(at(end)),
                       reach * std::abs(c.along) / c.across);
}

std::string pov_smooth(const Field& field) {
    if (const auto* torus = dynamic_cast<const Torus*>(&field))
        return pov_torus(torus->center(), torus->axis(), torus->radius(), torus->tube());
    const auto* form = dynamic_cast<const FreeForm*>(&field);
    if (!form || !form->perturbations().empty()) return "";
    // Written around its own center, where its coefficients are smallest; POV-Ray's inside is where a quadric is
    // negative.
    const Quadric& q = form->base();
    return fmt::format("quadric {{ {}, {}, {}, {} translate {} }}", pov_vector({-q.A[0][0], -q.A[1][1], -q.A[2][2]}),
                       pov_vector({-2 * q.A[0][1], -2 * q.A[0][2], -2 * q.A[1][2]}), pov_vector(-q.b), -q.k + 0.0,
                       pov_vector(q.center));
}

}  // namespace deburr
