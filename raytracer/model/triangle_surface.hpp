// A view of an indexed triangle surface, and the coordinate plane onto which each triangle projects without loss.
#pragma once
#include <array>
#include <vector>

#include "polygonizer/mesh/mesh.hpp"
#include "raytracer/model/exact_plane.hpp"

namespace deburr {

/// A view: `vertices` and `triangles` belong to the caller.
struct TriangleSurface {
    const std::vector<Vec3>& vertices;
    const std::vector<std::array<int, 3>>& triangles;

    int size() const { return int(triangles.size()); }
    Vec3 corner(int t, int k) const { return vertices[triangles[t][k]]; }
    /// The normal, twice as long as the triangle's area.
    Vec3 normal(int t) const { return glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)); }
    /// The axis that the triangle's normal is nearest to.
    int axis(int t) const {
        const Vec3 n = glm::abs(normal(t));
        return greatest_axis(n);
    }
    PlaneAxes axes(int t) const { return PlaneAxes(axis(t)); }
    /// Corner k of triangle t, projected to these axes.
    Vec2 flat(int t, int k, PlaneAxes in) const { return {corner(t, k)[in.u], corner(t, k)[in.v]}; }
    /// The largest magnitude of a coordinate.
    double scale() const {
        double largest_yet = 0;
        for (const Vec3& v : vertices) largest_yet = std::max(largest_yet, largest(v));
        return largest_yet;
    }
    Mesh mesh() const {
        Mesh m;
        m.positions = vertices;
        for (const auto& t : triangles) m.triangles.push_back({t, {0, 0, 0}});
        return m;
    }
};

}  // namespace deburr
