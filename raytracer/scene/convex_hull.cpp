#include "raytracer/scene/convex_hull.hpp"

#include <fmt/format.h>
#include <libqhull_r/libqhull_r.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <tuple>

namespace deburr {
namespace {

// Relative to the size of the body: a thinner body has no volume, and closer planes are one. Chosen: points computed in
// a scene have errors of some 10⁻¹⁵, and nobody means features as small as 10⁻⁹ of the whole.
constexpr double hull_flatness = 1e-9;

bool lexically_before(Vec3 a, Vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

Vec3 without_negative_zero(Vec3 v) { return v + Vec3(0.0); }

// The point for which `measure` is largest.
template <class Measure>
Vec3 farthest(const std::vector<Vec3>& points, Measure measure) {
    return *std::max_element(points.begin(), points.end(), [&](Vec3 a, Vec3 b) { return measure(a) < measure(b); });
}

// Three points far from each other: the plane through them is as accurate as the points.
struct HullTriangle {
    Vec3 a, b, c;

    explicit HullTriangle(const std::vector<Vec3>& points)
        : a(points[0]),
          b(farthest(points, [&](Vec3 p) { return glm::distance(p, a); })),
          c(farthest(points, [&](Vec3 p) { return glm::length(glm::cross(b - a, p - a)); })) {}

    Vec3 normal() const { return glm::cross(b - a, c - a); }  // not of unit length
};

double size_of(const std::vector<Vec3>& points) {
    Vec3 lo(infinity), hi(-infinity);
    for (Vec3 p : points) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    return glm::distance(lo, hi);
}

void check_volume(const std::vector<Vec3>& points) {
    if (points.size() < 4)
        throw std::runtime_error(fmt::format("expected at least 4 different points, got {}", points.size()));
    const double size = size_of(points);
    const HullTriangle base(points);
    const Vec3 normal = base.normal();
    const double area = glm::length(normal);
    const Vec3 top = farthest(points, [&](Vec3 p) { return std::abs(glm::dot(normal, p - base.a)); });
    if (!(area > hull_flatness * size * size) ||
        !(std::abs(glm::dot(normal / area, top - base.a)) > hull_flatness * size))
        throw std::runtime_error("expected points that span a volume, got points in one plane");
}

struct Hull {
    std::unique_ptr<qhT> qh = std::make_unique<qhT>();
    std::FILE* log = std::fopen("/dev/null", "w");

    Hull() { qh_zero(qh.get(), log); }
    Hull(const Hull&) = delete;
    Hull& operator=(const Hull&) = delete;
    ~Hull() {
        int blocks = 0, bytes = 0;
        qh_freeqhull(qh.get(), !qh_ALL);
        qh_memfreeshort(qh.get(), &blocks, &bytes);
        if (log) std::fclose(log);
    }
};

// The unit vector, without rounding if it is parallel to an axis.
Vec3 unit(Vec3 v) {
    v /= glm::max(std::abs(v.x), glm::max(std::abs(v.y), std::abs(v.z)));
    return without_negative_zero(v / glm::length(v));
}

HullFace touching(Vec3 normal, const std::vector<Vec3>& points) {
    double offset = -infinity;
    for (Vec3 p : points) offset = glm::max(offset, glm::dot(normal, p));
    return {normal, offset + 0.0};
}

}  // namespace

std::vector<HullFace> convex_hull(std::vector<Vec3> points) {
    for (Vec3& p : points) p = without_negative_zero(p);
    std::sort(points.begin(), points.end(), lexically_before);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    check_volume(points);
    const double size = size_of(points);

    std::vector<double> coordinates;
    for (Vec3 p : points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
    Hull hull;
    qhT* qh = hull.qh.get();  // the name that qhull's macros use
    char command[] = "qhull";
    if (qh_new_qhull(qh, 3, int(points.size()), coordinates.data(), False, command, nullptr, hull.log))
        throw std::runtime_error("expected points that span a volume, got points too nearly in one plane");

    std::vector<HullFace> faces;
    const facetT* facet = nullptr;
    FORALLfacets {
        std::vector<Vec3> corners;
        vertexT *vertex = nullptr, **vertexp = nullptr;
        FOREACHvertex_(facet->vertices) { corners.push_back(points[qh_pointid(qh, vertex->point)]); }
        std::sort(corners.begin(), corners.end(), lexically_before);
        const Vec3 outward(facet->normal[0], facet->normal[1], facet->normal[2]);
        const Vec3 normal = HullTriangle(corners).normal();
        if (glm::length(normal) == 0) continue;
        faces.push_back(touching(unit(glm::dot(normal, outward) < 0 ? -normal : normal), corners));
    }
    std::sort(faces.begin(), faces.end(), [](const HullFace& a, const HullFace& b) {
        return a.normal != b.normal ? lexically_before(a.normal, b.normal) : a.offset < b.offset;
    });
    std::vector<HullFace> merged;
    for (const HullFace& face : faces) {
        const auto same = [&](const HullFace& other) {
            return glm::distance(face.normal, other.normal) < hull_flatness &&
                   std::abs(face.offset - other.offset) < hull_flatness * size;
        };
        // Faces are sorted by x first, so only the latest ones can be near.
        auto other = merged.rbegin();
        while (other != merged.rend() && face.normal.x - other->normal.x < hull_flatness && !same(*other)) ++other;
        if (other == merged.rend() || !same(*other)) merged.push_back(face);
    }
    return merged;
}

}  // namespace deburr
