#include "raytracer/mesh/wire_frame.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace deburr {
namespace {

// Length of the steps along a line, in pixels; the ends of its visible parts are exact to this.
constexpr double step = 0.5;
// A stroke ends at multiples of this many steps, so that a window costs no more than the lines in and around it.
constexpr std::int64_t stroke_steps = 64;
// A point is tested a little in front of its faces and nearer to the eye, by this fraction of its distance: far above
// Embree's single precision, far below a pixel. With a lens so long that this is more than a pixel, by a pixel.
constexpr double max_lift = 1e-4;
// Two triangles count as lying in one plane if the opposite corner of one is within this fraction of the triangle's
// size of the other's plane. Roots that make a strip are exact to 10⁻¹⁰.
constexpr double flat = 1e-6;

int opposite(const Triangle& t, int a, int b) {
    for (const int v : t.vertex)
        if (v != a && v != b) return v;
    return t.vertex[0];
}

bool in_one_plane(const Mesh& mesh, const MeshEdge& e) {
    const Triangle& s = mesh.triangles[e.left];
    const Triangle& t = mesh.triangles[e.right];
    const Vec3 m = mesh.area_vector(s), n = mesh.area_vector(t);
    if (s.material != t.material || s.solid != t.solid || glm::dot(m, n) <= 0) return false;
    // The larger triangle's plane is used, since that of a sliver is ill-defined.
    const bool first = glm::length(m) > glm::length(n);
    const Vec3 normal = glm::normalize(first ? m : n);
    const auto at = [&](int v) { return mesh.positions[v]; };
    const double size = std::sqrt(glm::length(first ? m : n));
    return std::abs(glm::dot(normal, at(opposite(first ? t : s, e.a, e.b)) - at(e.a))) < flat * size;
}

// A line in space on surfaces.
struct Line3 {
    Vec3 a, b;    // ends
    Vec3 na, nb;  // directions in which the ends are lifted off the surface
};

// Clips the line to what is in front of the camera; false if nothing is.
bool clip(Line3& line, const ProjectiveCamera& camera) {
    // A fraction of the line's length; a nearer point would be projected too far away to be represented.
    const double near = 1e-4 * glm::length(line.b - line.a);
    const double za = glm::dot(line.a - camera.eye(), camera.forward());
    const double zb = glm::dot(line.b - camera.eye(), camera.forward());
    if (za <= near && zb <= near) return false;
    const auto cut = [&](Vec3& hidden, Vec3 seen, double zh, double zs) {
        hidden = glm::mix(hidden, seen, (near - zh) / (zs - zh));
    };
    if (za <= near)
        cut(line.a, line.b, za, zb);
    else if (zb <= near)
        cut(line.b, line.a, zb, za);
    return true;
}

// Parameters of the part of p + t (q − p), t in [0, 1], that is within a margin of the window; false if there is none.
bool clip(Vec2 p, Vec2 q, const Window& window, double& t0, double& t1) {
    constexpr double margin = 8;
    t0 = 0, t1 = 1;
    const double lo[2] = {window.x - margin, window.y - margin};
    const double hi[2] = {window.x + window.width + margin, window.y + window.height + margin};
    for (int k = 0; k < 2; ++k) {
        const double d = q[k] - p[k];
        if (d == 0) {
            if (p[k] < lo[k] || p[k] > hi[k]) return false;
            continue;
        }
        double a = (lo[k] - p[k]) / d, b = (hi[k] - p[k]) / d;
        if (a > b) std::swap(a, b);
        t0 = std::max(t0, a);
        t1 = std::min(t1, b);
    }
    return t0 < t1;
}

// Whether the point x of a surface is visible.
bool seen(Vec3 x, Vec3 normal, const RayTracer& hiding, const ProjectiveCamera& camera) {
    const Vec3 back = camera.to_eye(x);
    const double distance = glm::length(back);
    const Vec3 start = x + (normal + glm::normalize(back)) * std::min(max_lift * distance, camera.pixel(distance));
    const Vec3 to_eye = camera.to_eye(start);
    const double length = glm::length(to_eye);
    TraceCounters unused;
    return !hiding.any_hit({start, to_eye / length}, length, unused);
}

// Appends the visible parts of one line.
void add_visible(Line3 line, const RayTracer* hiding, const ProjectiveCamera& camera, const Window& window,
                 std::vector<Stroke>& out) {
    if (!clip(line, camera)) return;
    const Vec3 p = camera.project(line.a), q = camera.project(line.b);
    const Vec2 from(p), to(q);
    double t0, t1;
    if (!clip(from, to, window, t0, t1)) return;
    // Steps are even in the picture, where 1/z is linear. Their positions do not depend on the window.
    const auto steps = std::max(std::int64_t(2), std::int64_t(std::ceil(glm::length(to - from) / step)));
    const std::int64_t first = std::int64_t(t0 * double(steps)) / stroke_steps * stroke_steps;
    const std::int64_t last = std::min(steps, (std::int64_t(t1 * double(steps)) / stroke_steps + 1) * stroke_steps);
    const auto share = [&](double i) { return i / double(steps); };
    std::int64_t begin = -1;
    for (std::int64_t i = first; i <= last; ++i) {
        bool visible = false;
        if (i < last) {
            const double t = share(double(i) + 0.5);
            const double u = camera.orthographic() ? t : t / q.z / ((1 - t) / p.z + t / q.z);
            visible = !hiding || seen(glm::mix(line.a, line.b, u), glm::mix(line.na, line.nb, u), *hiding, camera);
        }
        if (begin >= 0 && (!visible || i % stroke_steps == 0)) {
            out.push_back({glm::mix(from, to, share(double(begin))), glm::mix(from, to, share(double(i)))});
            begin = -1;
        }
        if (visible && begin < 0) begin = i;
    }
}

template <class LineOf>
std::vector<Stroke> strokes_of(std::size_t lines, LineOf line_of, const RayTracer* hiding,
                               const ProjectiveCamera& camera, const Window& window) {
    std::vector<std::vector<Stroke>> parts(lines);  // in the lines' order, whichever thread computes them
    tbb::parallel_for(std::size_t(0), lines, [&](std::size_t i) {
        Line3 line;
        if (line_of(i, line)) add_visible(line, hiding, camera, window, parts[i]);
    });
    std::vector<Stroke> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace

std::vector<MeshEdge> mesh_edges(const Mesh& mesh, EdgeChoice choice) {
    struct Half {
        int lo, hi, triangle;
    };
    std::vector<Half> halves;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [lo, hi] = std::minmax(mesh.triangles[t].vertex[k], mesh.triangles[t].vertex[(k + 1) % 3]);
            halves.push_back({lo, hi, int(t)});
        }
    std::sort(halves.begin(), halves.end(), [](const Half& x, const Half& y) {
        return std::tie(x.lo, x.hi, x.triangle) < std::tie(y.lo, y.hi, y.triangle);
    });
    std::vector<MeshEdge> edges;
    for (std::size_t k = 0; k < halves.size();) {
        std::size_t end = k + 1;
        while (end < halves.size() && halves[end].lo == halves[k].lo && halves[end].hi == halves[k].hi) ++end;
        const MeshEdge edge{halves[k].lo, halves[k].hi, halves[k].triangle, end == k + 2 ? halves[k + 1].triangle : -1};
        if (choice == EdgeChoice::triangles || edge.right < 0 || !in_one_plane(mesh, edge)) edges.push_back(edge);
        k = end;
    }
    return edges;
}

std::vector<Stroke> wire_frame(const Mesh& mesh, const std::vector<MeshEdge>& edges, const RayTracer& hiding,
                               const ProjectiveCamera& camera, const Window& window, WireMode mode) {
    const auto line_of = [&](std::size_t i, Line3& line) {
        const MeshEdge& e = edges[i];
        line.a = mesh.positions[e.a];
        line.b = mesh.positions[e.b];
        Vec3 normal(0.0);
        bool front = false;
        for (const int t : {e.left, e.right}) {
            if (t < 0) continue;
            const Vec3 area = mesh.area_vector(mesh.triangles[t]);
            const double size = glm::length(area);
            if (size == 0) continue;
            if (glm::dot(area, camera.to_eye(line.a)) <= 0) continue;
            front = true;
            normal += area / size;
        }
        line.na = line.nb = glm::length(normal) > 0 ? glm::normalize(normal) : normal;
        return front;  // an edge between two faces that look away is not visible
    };
    return strokes_of(edges.size(), line_of, mode == WireMode::visible ? &hiding : nullptr, camera, window);
}

std::vector<Stroke> visible_line(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                                 const RayTracer& hiding, const ProjectiveCamera& camera, const Window& window) {
    const auto line_of = [&](std::size_t i, Line3& line) {
        line = {points[i], points[i + 1], normals[i], normals[i + 1]};
        return true;
    };
    return strokes_of(points.empty() ? 0 : points.size() - 1, line_of, &hiding, camera, window);
}

void draw_strokes(Film& film, const std::vector<Stroke>& strokes, Vec3 color, double line_width, bool alpha) {
    if (strokes.empty()) return;
    const Window& w = film.window;
    // The largest share of the pixel that any line covers, so that crossings are not darker.
    std::vector<float> covered(film.pixels.size(), 0);
    const double reach = 0.5 * line_width + 0.5;
    for (const Stroke& s : strokes) {
        const Vec2 d = s.to - s.from;
        const int y1 = std::min(w.y + w.height - 1, int(std::floor(std::max(s.from.y, s.to.y) + reach)));
        for (int y = std::max(w.y, int(std::floor(std::min(s.from.y, s.to.y) - reach))); y <= y1; ++y) {
            // The part of the line near this row.
            double t0 = 0, t1 = 1;
            if (d.y != 0) {
                const double a = (y - reach - s.from.y) / d.y, b = (y + 1 + reach - s.from.y) / d.y;
                t0 = std::clamp(std::min(a, b), 0.0, 1.0);
                t1 = std::clamp(std::max(a, b), 0.0, 1.0);
            }
            const double xa = s.from.x + t0 * d.x, xb = s.from.x + t1 * d.x;
            const double left = std::min(xa, xb), right = std::max(xa, xb);
            const int x1 = std::min(w.x + w.width - 1, int(std::floor(right + reach)));
            for (int x = std::max(w.x, int(std::floor(left - reach))); x <= x1; ++x) {
                const double share = std::clamp(reach - distance_to_segment({x + 0.5, y + 0.5}, s.from, s.to), 0.0,
                                                std::min(1.0, line_width));
                float& c = covered[std::size_t(y - w.y) * std::size_t(w.width) + std::size_t(x - w.x)];
                c = std::max(c, float(share));
            }
        }
    }
    for (std::size_t i = 0; i < covered.size(); ++i) {
        if (!(covered[i] > 0)) continue;
        film.pixels[i].color = glm::mix(film.pixels[i].color, color, double(covered[i]));
        if (alpha) film.pixels[i].alpha = glm::mix(film.pixels[i].alpha, 1.0, double(covered[i]));
    }
}

Mesh flat_shaded(Mesh mesh) {
    std::vector<Vec3> normals;
    for (Triangle& t : mesh.triangles) {
        const Vec3 area = mesh.area_vector(t);
        const double size = glm::length(area);
        const int n = int(normals.size());
        normals.push_back(size > 0 ? area / size : mesh.normals[t.normal[0]]);
        t.normal = {n, n, n};
    }
    mesh.normals = std::move(normals);
    return mesh;
}

}  // namespace deburr
