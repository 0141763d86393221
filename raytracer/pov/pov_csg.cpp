#include "raytracer/pov/pov_csg.hpp"

#include <fmt/format.h>

#include <iterator>
#include <optional>

#include "bounds/polyhedron_box.hpp"
#include "raytracer/pov/pov_text.hpp"

namespace deburr {
namespace {

// Tolerances for equal planes, as for families of parallel planes (bounds/decision_diagram.cpp).
constexpr double same_direction = 1e-9, same_offset = 1e-12;
// Three normals whose parallelepiped has less volume than this do not make a box.
constexpr double min_volume = 1e-6;

bool parallel(Vec3 a, Vec3 b) { return glm::length(a - b) <= same_direction; }

// Keeps the innermost of the planes that face the same way.
std::vector<BoundPlane> least(const std::vector<BoundPlane>& planes) {
    std::vector<BoundPlane> kept;
    for (const BoundPlane& p : planes) {
        bool is_new = true;
        for (BoundPlane& k : kept)
            if (parallel(k.normal, p.normal)) {
                k.offset = std::min(k.offset, p.offset);
                is_new = false;
            }
        if (is_new) kept.push_back(p);
    }
    return kept;
}

bool axis_parallel(Vec3 n) { return (n.x != 0) + (n.y != 0) + (n.z != 0) == 1; }

const char* const empty = "intersection {\n  plane { <1, 0, 0>, 0 }\n  plane { <-1, 0, 0>, -1 }\n}";

struct Slab {
    std::size_t low, high;  // indices of planes; the slab's normal is that of `high`
};

std::string box_of(const std::vector<BoundPlane>& planes, const Slab (&slabs)[3]) {
    Mat3 normals;  // columns
    Vec3 lo(0.0), hi(0.0);
    for (int k = 0; k < 3; ++k) {
        normals[k] = planes[slabs[k].high].normal;
        hi[k] = planes[slabs[k].high].offset;
        lo[k] = -planes[slabs[k].low].offset;
    }
    if (axis_parallel(normals[0]) && axis_parallel(normals[1]) && axis_parallel(normals[2])) {
        Vec3 from(0.0), to(0.0);
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j)
                if (normals[k][j] != 0) {
                    const double a = lo[k] * normals[k][j], b = hi[k] * normals[k][j];
                    from[j] = std::min(a, b);
                    to[j] = std::max(a, b);
                }
        return fmt::format("box {{ {}, {} }}", pov_vector(from), pov_vector(to));
    }
    // A box in the coordinates uᵢ = nᵢ·x, transformed to x.
    const Mat3 back = glm::inverse(glm::transpose(normals));
    std::string rows;
    for (int i = 0; i < 3; ++i) rows += fmt::format("{}, {}, {}, ", back[i].x, back[i].y, back[i].z);
    return fmt::format("box {{ {}, {} matrix <{}0, 0, 0> }}", pov_vector(lo), pov_vector(hi), rows);
}

// Removes three independent slabs from the planes and returns them as a box, if there are three.
std::optional<std::string> take_box(std::vector<BoundPlane>& planes) {
    std::vector<Slab> slabs;
    for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t j = i + 1; j < planes.size(); ++j)
            if (parallel(planes[i].normal, -planes[j].normal)) slabs.push_back({j, i});
    for (std::size_t a = 0; a < slabs.size(); ++a)
        for (std::size_t b = a + 1; b < slabs.size(); ++b)
            for (std::size_t c = b + 1; c < slabs.size(); ++c) {
                const auto n = [&](std::size_t s) { return planes[slabs[s].high].normal; };
                if (std::abs(glm::dot(n(a), glm::cross(n(b), n(c)))) < min_volume) continue;
                const std::string text = box_of(planes, {slabs[a], slabs[b], slabs[c]});
                std::vector<BoundPlane> rest;
                for (std::size_t i = 0; i < planes.size(); ++i) {
                    bool used = false;
                    for (const std::size_t s : {a, b, c}) used |= i == slabs[s].low || i == slabs[s].high;
                    if (!used) rest.push_back(planes[i]);
                }
                planes = std::move(rest);
                return text;
            }
    return std::nullopt;
}

std::string braces(const char* keyword, const std::vector<std::string>& parts, const std::string& modifiers) {
    std::string text = fmt::format("{} {{\n", keyword);
    for (const std::string& part : parts) text += fmt::format("{}\n", pov_indented(part));
    if (!modifiers.empty()) text += fmt::format("{}\n", pov_indented(modifiers));
    text += '}';
    return text;
}

std::string with(const std::string& object, const std::string& modifiers) {
    if (modifiers.empty()) return object;
    const std::string head = object.substr(0, object.rfind('}'));
    if (head.find('\n') == std::string::npos) return fmt::format("{}{} }}", head, modifiers);
    return fmt::format("{}{}\n}}", head, pov_indented(modifiers));
}

}  // namespace

PovCsg PovCsg::plane(BoundPlane plane) {
    PovCsg csg(Kind::intersect);
    csg.planes_.push_back(plane);
    return csg;
}

PovCsg PovCsg::object(std::string text) {
    PovCsg csg(Kind::intersect);
    csg.objects_.push_back(std::move(text));
    return csg;
}

// This object as one of the given kind, to which operands can be added.
PovCsg PovCsg::as(Kind kind) && {
    if (kind_ == kind) return std::move(*this);
    PovCsg csg(kind);
    csg.objects_.push_back(text());
    return csg;
}

namespace {

template <class T>
void append(std::vector<T>& to, std::vector<T>&& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

PovCsg PovCsg::unite(PovCsg a, PovCsg b) {
    if (a.kind_ == Kind::nothing || b.kind_ == Kind::everything) return b;
    if (b.kind_ == Kind::nothing || a.kind_ == Kind::everything) return a;
    a = std::move(a).as(Kind::unite);
    b = std::move(b).as(Kind::unite);
    append(a.objects_, std::move(b.objects_));
    return a;
}

PovCsg PovCsg::intersect(PovCsg a, PovCsg b) {
    if (a.kind_ == Kind::nothing || b.kind_ == Kind::everything) return a;
    if (b.kind_ == Kind::nothing || a.kind_ == Kind::everything) return b;
    a = std::move(a).as(Kind::intersect);
    b = std::move(b).as(Kind::intersect);
    append(a.planes_, std::move(b.planes_));
    append(a.objects_, std::move(b.objects_));
    append(a.taken_, std::move(b.taken_));
    return a;
}

PovCsg PovCsg::subtract(PovCsg a, PovCsg b) {
    if (a.kind_ == Kind::nothing || b.kind_ == Kind::nothing) return a;
    if (b.kind_ == Kind::everything) return nothing();
    if (a.kind_ == Kind::everything) a = PovCsg(Kind::intersect);
    a = std::move(a).as(Kind::intersect);
    a.taken_.push_back(std::move(b));
    return a;
}

// This object without the planes that it shares with `whole`; within `whole` both are the same.
PovCsg PovCsg::without_planes_of(const PovCsg& whole) const {
    PovCsg rest = *this;
    if (kind_ != Kind::intersect) return rest;
    std::erase_if(rest.planes_, [&](const BoundPlane& p) {
        for (const BoundPlane& w : whole.planes_)
            if (parallel(w.normal, p.normal) && std::abs(w.offset - p.offset) <= same_offset * std::abs(w.offset))
                return true;
        return false;
    });
    if (rest.planes_.empty() && rest.objects_.empty() && rest.taken_.empty()) rest.kind_ = Kind::everything;
    return rest;
}

std::string PovCsg::text(const std::string& modifiers) const {
    if (kind_ == Kind::nothing) return with(empty, modifiers);
    if (kind_ == Kind::everything) return with(with(empty, "inverse"), modifiers);
    if (kind_ == Kind::unite) return braces("union", objects_, modifiers);

    std::vector<BoundPlane> planes = least(planes_);
    const Box bounds = planes.size() > 1 ? polyhedron_box(planes) : Box::everything();
    if (bounds.empty()) return with(empty, modifiers);
    std::vector<std::string> parts;
    if (auto box = take_box(planes)) parts.push_back(*box);
    // POV-Ray finds no bounding box for planes that are not parallel to the axes.
    const bool bounded = parts.empty() && objects_.empty() && bounds.finite();
    for (const BoundPlane& p : planes)
        parts.push_back(fmt::format("plane {{ {}, {} }}", pov_vector(p.normal), p.offset));
    parts.insert(parts.end(), objects_.begin(), objects_.end());
    std::vector<std::string> taken;
    for (const PovCsg& t : taken_) taken.push_back(t.without_planes_of(*this).text());
    if (parts.empty()) {
        for (const std::string& t : taken) parts.push_back(with(t, "inverse"));
        taken.clear();
    }
    std::string whole = parts[0];
    if (parts.size() > 1)
        whole = braces(
            "intersection", parts,
            bounded ? fmt::format("bounded_by {{ box {{ {}, {} }} }}", pov_vector(bounds.lo), pov_vector(bounds.hi))
                    : "");
    if (taken.empty()) return with(whole, modifiers);
    taken.insert(taken.begin(), whole);
    return braces("difference", taken, modifiers);
}

}  // namespace deburr
