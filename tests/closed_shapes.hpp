// Closed meshes for tests: prisms, tessellated spheres, boxes with a cavity and plates with a hole.
#pragma once
#include <cstdint>
#include <string>

#include "bounds/closed_mesh.hpp"
#include "random_case.hpp"

namespace deburr::test {

struct Shape {
    using Corners = ClosedMesh::Corners;
    std::vector<Vec3> vertices;
    std::vector<Corners> triangles;

    ClosedMesh mesh() const { return {vertices, triangles}; }
    // A prism over the counter-clockwise polygon `outline` from z0 to z1; `fan` triangulates the outline.
    static Shape prism(const std::vector<Vec2>& outline, const std::vector<Corners>& fan, double z0, double z1) {
        Shape s;
        const int n = int(outline.size());
        for (const double z : {z0, z1})
            for (const Vec2 p : outline) s.vertices.push_back({p.x, p.y, z});
        for (const Corners& t : fan) {
            s.triangles.push_back({t[2], t[1], t[0]});
            s.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
        }
        for (int i = 0; i < n; ++i) {
            const int j = (i + 1) % n;
            s.triangles.push_back({i, j, j + n});
            s.triangles.push_back({i, j + n, i + n});
        }
        return s;
    }
    static Shape box(Vec3 lo, Vec3 hi) {
        return prism({{lo.x, lo.y}, {hi.x, lo.y}, {hi.x, hi.y}, {lo.x, hi.y}}, {{0, 1, 2}, {0, 2, 3}}, lo.z, hi.z);
    }
    static Shape l_prism() {
        return prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}, 0,
                     1);
    }
    // A sphere around the origin with `rings` rings of 2·rings facets each: quadrilaterals, triangles at the poles.
    static Shape sphere(double radius, int rings) {
        Shape s;
        const int sides = 2 * rings;
        s.vertices.push_back({0, 0, radius});
        for (int i = 1; i < rings; ++i)
            for (int k = 0; k < sides; ++k) {
                const double u = pi * i / rings, v = 2 * pi * k / sides;
                s.vertices.push_back(radius * Vec3(std::sin(u) * std::cos(v), std::sin(u) * std::sin(v), std::cos(u)));
            }
        s.vertices.push_back({0, 0, -radius});
        const int last = int(s.vertices.size()) - 1;
        for (int k = 0; k < sides; ++k) {
            const int l = (k + 1) % sides;
            s.triangles.push_back({0, 1 + k, 1 + l});
            s.triangles.push_back({last, last - sides + l, last - sides + k});
            for (int i = 0; i + 2 < rings; ++i) {
                const int a = 1 + i * sides, b = a + sides;
                s.triangles.push_back({a + k, b + k, b + l});
                s.triangles.push_back({a + k, b + l, a + l});
            }
        }
        return s;
    }
    /// The box [lo, hi] without [inner_lo, inner_hi], which must be well within it.
    static Shape cavity(Vec3 lo, Vec3 hi, Vec3 inner_lo, Vec3 inner_hi) {
        Shape outer = box(lo, hi);
        const Shape inner = box(inner_lo, inner_hi);
        for (const Corners& t : inner.triangles) outer.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
        outer.vertices.insert(outer.vertices.end(), inner.vertices.begin(), inner.vertices.end());
        return outer;
    }
    /// The square plate [−1, 1]² of this thickness with a hole through its center, a regular polygon of `sides` sides.
    static Shape plate_with_hole(double radius, int sides, double thickness) {
        Shape s;
        for (const double z : {0.0, thickness})
            for (const bool outer : {true, false})
                for (int k = 0; k < sides; ++k) {
                    const double a = 2 * pi * (k + 0.5) / sides, c = std::cos(a), d = std::sin(a);
                    const double far = 1 / std::max(std::abs(c), std::abs(d));
                    s.vertices.push_back({(outer ? far : radius) * c, (outer ? far : radius) * d, z});
                }
        const auto quad = [&](int a, int b, int c, int d) {
            s.triangles.push_back({a, b, c});
            s.triangles.push_back({a, c, d});
        };
        for (int k = 0; k < sides; ++k) {
            const int l = (k + 1) % sides, outer = 0, inner = sides, top = 2 * sides;
            quad(inner + k, inner + l, outer + l, outer + k);
            quad(top + outer + k, top + outer + l, top + inner + l, top + inner + k);
            quad(outer + k, outer + l, top + outer + l, top + outer + k);
            quad(inner + l, inner + k, top + inner + k, top + inner + l);
        }
        return s;
    }
    /// The mesh as the bytes of a binary STL file.
    std::string stl() const {
        std::string bytes(80, ' ');
        const auto put = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
        put(std::uint32_t(triangles.size()));
        for (const Corners& t : triangles) {
            for (int k = 0; k < 3; ++k) put(0.0f);
            for (const int v : t)
                for (int k = 0; k < 3; ++k) put(float(vertices[v][k]));
            put(std::uint16_t(0));
        }
        return bytes;
    }
    void rotate(Gen& g) {
        const Mat3 turn = g.map(false).linear;
        for (Vec3& v : vertices) v = turn * v;
    }
};

/// Both shapes as the shells of one mesh.
inline Shape together(Shape a, const Shape& b) {
    const int n = int(a.vertices.size());
    a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
    for (const auto& t : b.triangles) a.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
    return a;
}

}  // namespace deburr::test
