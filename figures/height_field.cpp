#include "figures/height_field.hpp"

namespace deburr {

Mesh height_field(const std::function<double(Vec2)>& f, Vec2 lo, Vec2 hi, int columns, int rows, double height) {
    Mesh mesh;
    const Vec2 step = (hi - lo) / Vec2(columns, rows);
    const auto at = [&](int i, int j) { return lo + Vec2(i, j) * step; };
    const auto value = [&](int i, int j) { return height * f(at(i, j)); };
    const auto index = [&](int i, int j) { return j * (columns + 1) + i; };
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const Vec2 p = at(i, j);
            mesh.positions.push_back({p.x, value(i, j), -p.y});
            const double dx = (height * f(p + Vec2(0.5 * step.x, 0)) - height * f(p - Vec2(0.5 * step.x, 0))) / step.x;
            const double dy = (height * f(p + Vec2(0, 0.5 * step.y)) - height * f(p - Vec2(0, 0.5 * step.y))) / step.y;
            mesh.normals.push_back(glm::normalize(Vec3(-dx, 1, dy)));
        }
    const auto add = [&](int a, int b, int c, int na, int nb, int nc, int material) {
        mesh.triangles.push_back({{a, b, c}, {na, nb, nc}, material, 0});
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const int a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1), d = index(i, j + 1);
            // A cell with a jump is flat, with its own normal for each half.
            const Vec3 &pa = mesh.positions[a], &pb = mesh.positions[b], &pc = mesh.positions[c],
                       &pd = mesh.positions[d];
            const double jump = std::max({pa.y, pb.y, pc.y, pd.y}) - std::min({pa.y, pb.y, pc.y, pd.y});
            const bool cliff = jump > 0.5 * height;
            const auto normal = [&](Vec3 x, Vec3 y, Vec3 z) {
                mesh.normals.push_back(glm::normalize(glm::cross(y - x, z - x)));
                return int(mesh.normals.size()) - 1;
            };
            if (cliff) {
                const int n = normal(pa, pb, pc), m = normal(pa, pc, pd);
                add(a, b, c, n, n, n, 0);
                add(a, c, d, m, m, m, 0);
            } else {
                add(a, b, c, a, b, c, 0);
                add(a, c, d, a, c, d, 0);
            }
        }
    // Adds the vertical sides and the bottom.
    const auto side = [&](int i0, int j0, int i1, int j1, Vec3 outward) {
        mesh.normals.push_back(outward);
        const int n = int(mesh.normals.size()) - 1;
        const auto below = [&](int i, int j) {
            const Vec2 p = at(i, j);
            mesh.positions.push_back({p.x, 0, -p.y});
            return int(mesh.positions.size()) - 1;
        };
        const int steps = std::max(std::abs(i1 - i0), std::abs(j1 - j0));
        const int di = (i1 - i0) / steps, dj = (j1 - j0) / steps;
        int last = below(i0, j0);
        for (int k = 0; k < steps; ++k) {
            const int i = i0 + k * di, j = j0 + k * dj, next = below(i + di, j + dj);
            add(last, next, index(i + di, j + dj), n, n, n, 1);
            add(last, index(i + di, j + dj), index(i, j), n, n, n, 1);
            last = next;
        }
    };
    side(0, 0, columns, 0, {0, 0, 1});
    side(columns, 0, columns, rows, {1, 0, 0});
    side(columns, rows, 0, rows, {0, 0, -1});
    side(0, rows, 0, 0, {-1, 0, 0});
    return mesh;
}

}  // namespace deburr
