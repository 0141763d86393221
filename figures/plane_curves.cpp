#include "figures/plane_curves.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

namespace deburr {
namespace {

// The point between a and b, at which f − level has different signs, where f = level; by bisection to the last digit.
Vec2 root(const std::function<double(Vec2)>& f, double level, Vec2 a, Vec2 b) {
    const bool above = f(a) > level;
    for (int k = 0; k < 60; ++k) {
        const Vec2 middle = 0.5 * (a + b);
        ((f(middle) > level) == above ? a : b) = middle;
    }
    return 0.5 * (a + b);
}

// The signed area of the part of the triangle (0, a, b) inside the circle around 0.
double triangle_in_disc(Vec2 a, Vec2 b, double r) {
    const Vec2 d = b - a;
    const double dd = glm::dot(d, d), ad = glm::dot(a, d), disc = ad * ad - dd * (glm::dot(a, a) - r * r);
    const auto sector = [&](Vec2 p, Vec2 q) { return 0.5 * r * r * std::atan2(cross(p, q), glm::dot(p, q)); };
    if (dd == 0) return 0;
    if (disc <= 0) return sector(a, b);
    const double t0 = std::clamp((-ad - std::sqrt(disc)) / dd, 0.0, 1.0),
                 t1 = std::clamp((-ad + std::sqrt(disc)) / dd, 0.0, 1.0);
    if (t0 == t1) return sector(a, b);
    const Vec2 p = a + t0 * d, q = a + t1 * d;
    return (t0 > 0 ? sector(a, p) : 0) + 0.5 * cross(p, q) + (t1 < 1 ? sector(q, b) : 0);
}

}  // namespace

double disc_share(const std::vector<Vec2>& polygon, Vec2 center, double radius) {
    double area = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        area += triangle_in_disc(polygon[i] - center, polygon[(i + 1) % polygon.size()] - center, radius);
    return area / (pi * radius * radius);
}

std::vector<std::vector<Vec2>> level_lines(const std::function<double(Vec2)>& f, double level, Vec2 lo, Vec2 hi,
                                           int columns, int rows) {
    const Vec2 step = (hi - lo) / Vec2(columns, rows);
    const auto corner = [&](int i, int j) { return lo + Vec2(i, j) * step; };
    std::vector<char> above(std::size_t(columns + 1) * std::size_t(rows + 1));
    const auto is_above = [&](int i, int j) {
        return above[std::size_t(j) * std::size_t(columns + 1) + std::size_t(i)] != 0;
    };
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i)
            above[std::size_t(j) * std::size_t(columns + 1) + std::size_t(i)] = f(corner(i, j)) > level;

    // Number of a grid line's segment: 2·corner for the one to the right of a corner, + 1 for the one upward.
    const auto edge = [&](int i, int j, int upwards) { return 2 * (j * (columns + 1) + i) + upwards; };
    std::map<int, std::vector<int>> joined;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            // The corners of the cell, counter-clockwise from the lower left.
            const bool s[4] = {is_above(i, j), is_above(i + 1, j), is_above(i + 1, j + 1), is_above(i, j + 1)};
            const int e[4] = {edge(i, j, 0), edge(i + 1, j, 1), edge(i, j + 1, 0), edge(i, j, 1)};
            std::vector<int> cut;
            for (int k = 0; k < 4; ++k)
                if (s[k] != s[(k + 1) % 4]) cut.push_back(e[k]);
            // With four intersections, the two corners on the same side as the middle are connected, and the others cut
            // off.
            if (cut.size() == 4 && (f(corner(i, j) + 0.5 * step) > level) != s[0])
                std::rotate(cut.begin(), cut.begin() + 3, cut.end());
            for (std::size_t k = 0; k + 1 < cut.size(); k += 2) {
                joined[cut[k]].push_back(cut[k + 1]);
                joined[cut[k + 1]].push_back(cut[k]);
            }
        }
    const auto point = [&](int e) {
        const int i = e / 2 % (columns + 1), j = e / 2 / (columns + 1);
        return root(f, level, corner(i, j), e % 2 ? corner(i, j + 1) : corner(i + 1, j));
    };
    std::vector<std::vector<Vec2>> lines;
    std::map<int, bool> done;
    for (const auto& [start, unused] : joined) {
        if (done[start]) continue;
        std::deque<int> line{start};
        done[start] = true;
        for (const bool forward : {true, false}) {
            for (bool grew = true; grew;) {
                grew = false;
                for (const int n : joined[forward ? line.back() : line.front()]) {
                    if (done[n]) continue;
                    done[n] = grew = true;
                    if (forward)
                        line.push_back(n);
                    else
                        line.push_front(n);
                    break;
                }
            }
        }
        const std::vector<int>& last = joined[line.back()];
        if (line.size() > 2 && std::count(last.begin(), last.end(), line.front())) line.push_back(line.front());
        std::vector<Vec2> points;
        for (const int e : line) points.push_back(point(e));
        lines.push_back(std::move(points));
    }
    return lines;
}

PlotField sampled(const std::function<double(Vec2)>& f, Vec2 lo, Vec2 hi, int columns, int rows) {
    PlotField field{.lo = lo, .hi = hi, .columns = columns, .rows = rows};
    const Vec2 step = (hi - lo) / Vec2(columns, rows);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) field.values.push_back(f(lo + (Vec2(i, j) + 0.5) * step));
    return field;
}

}  // namespace deburr
