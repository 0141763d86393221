#include "figures/height_field.hpp"

namespace deburr {
namespace {

enum Material { top, sides };

// The grid over the rectangle, at whose points the function is sampled.
struct Grid {
    Vec2 lo, step;
    int columns, rows;

    Vec2 at(int i, int j) const { return lo + Vec2(i, j) * step; }
    int vertex(int i, int j) const { return j * (columns + 1) + i; }
};

void add(Mesh& mesh, std::array<int, 3> corners, std::array<int, 3> normals, Material material) {
    mesh.triangles.push_back({corners, normals, material, 0});
}

// Adds the graph's vertices, each with the normal of the graph there under its own number.
void add_vertices(Mesh& mesh, const Grid& grid, const std::function<double(Vec2)>& f, double height) {
    const Vec2 step = grid.step;
    for (int j = 0; j <= grid.rows; ++j)
        for (int i = 0; i <= grid.columns; ++i) {
            const Vec2 p = grid.at(i, j);
            mesh.positions.push_back({p.x, height * f(p), -p.y});
            const double dx = (height * f(p + Vec2(0.5 * step.x, 0)) - height * f(p - Vec2(0.5 * step.x, 0))) / step.x;
            const double dy = (height * f(p + Vec2(0, 0.5 * step.y)) - height * f(p - Vec2(0, 0.5 * step.y))) / step.y;
            mesh.normals.push_back(glm::normalize(Vec3(-dx, 1, dy)));
        }
}

// Adds the triangle with its own normal.
void add_flat(Mesh& mesh, int a, int b, int c, Material material) {
    const Vec3 &x = mesh.positions[a], &y = mesh.positions[b], &z = mesh.positions[c];
    mesh.normals.push_back(glm::normalize(glm::cross(y - x, z - x)));
    const int n = int(mesh.normals.size()) - 1;
    add(mesh, {a, b, c}, {n, n, n}, material);
}

// Adds the graph over the cell with the lower left corner (i, j). If it holds a jump, its halves are flat.
void add_cell(Mesh& mesh, const Grid& grid, int i, int j, double height) {
    const int a = grid.vertex(i, j), b = grid.vertex(i + 1, j), c = grid.vertex(i + 1, j + 1),
              d = grid.vertex(i, j + 1);
    const auto [lowest, highest] =
        std::minmax({mesh.positions[a].y, mesh.positions[b].y, mesh.positions[c].y, mesh.positions[d].y});
    if (highest - lowest > 0.5 * height) {
        add_flat(mesh, a, b, c, top);
        add_flat(mesh, a, c, d, top);
    } else {
        add(mesh, {a, b, c}, {a, b, c}, top);
        add(mesh, {a, c, d}, {a, c, d}, top);
    }
}

// Adds the vertical side below the graph from the grid's corner (i0, j0) to its corner (i1, j1).
void add_side(Mesh& mesh, const Grid& grid, int i0, int j0, int i1, int j1, Vec3 outward) {
    mesh.normals.push_back(outward);
    const int n = int(mesh.normals.size()) - 1;
    const auto below = [&](int i, int j) {
        const Vec2 p = grid.at(i, j);
        mesh.positions.push_back({p.x, 0, -p.y});
        return int(mesh.positions.size()) - 1;
    };
    const int steps = std::max(std::abs(i1 - i0), std::abs(j1 - j0));
    const int di = (i1 - i0) / steps, dj = (j1 - j0) / steps;
    int last = below(i0, j0);
    for (int k = 0; k < steps; ++k) {
        const int i = i0 + k * di, j = j0 + k * dj, next = below(i + di, j + dj);
        add(mesh, {last, next, grid.vertex(i + di, j + dj)}, {n, n, n}, sides);
        add(mesh, {last, grid.vertex(i + di, j + dj), grid.vertex(i, j)}, {n, n, n}, sides);
        last = next;
    }
}

}  // namespace

Mesh height_field(const std::function<double(Vec2)>& f, Vec2 lo, Vec2 hi, int columns, int rows, double height) {
    const Grid grid{lo, (hi - lo) / Vec2(columns, rows), columns, rows};
    Mesh mesh;
    add_vertices(mesh, grid, f, height);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) add_cell(mesh, grid, i, j, height);
    add_side(mesh, grid, 0, 0, columns, 0, {0, 0, 1});
    add_side(mesh, grid, columns, 0, columns, rows, {1, 0, 0});
    add_side(mesh, grid, columns, rows, 0, rows, {0, 0, -1});
    add_side(mesh, grid, 0, rows, 0, 0, {-1, 0, 0});
    return mesh;
}

}  // namespace deburr
