#include "figures/cell_drawing.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "polygonizer/triage/cell_mesh.hpp"
#include "polygonizer/triage/triage.hpp"

namespace deburr {
namespace {

constexpr double far = 1000;  // distance of the eye: the projection is nearly parallel

bool inside(const std::vector<std::vector<Vec3>>& walls, Vec3 x) {
    for (const auto& wall : walls)
        if (glm::dot(glm::cross(wall[1] - wall[0], wall[2] - wall[0]), x - wall[0]) > 0) return false;
    return true;
}

std::vector<std::vector<Vec3>> walls_of(const CellComplex& complex, int cell) {
    std::vector<std::vector<Vec3>> walls;
    for (const int face : complex.cells[cell]) {
        std::vector<Vec3> corners;
        for (const int v : complex.corners(face)) corners.push_back(complex.vertices[v]);
        if (complex.faces[face].front == cell) std::reverse(corners.begin(), corners.end());
        walls.push_back(std::move(corners));
    }
    return walls;
}

CellDrawing::Point::On place_of(Vec3 x, const std::vector<std::vector<Vec3>>& walls) {
    constexpr double near = 1e-7;
    bool on_face = false;
    for (const auto& wall : walls) {
        for (std::size_t k = 0; k < wall.size(); ++k)
            if (distance_to_segment(x, wall[k], wall[(k + 1) % wall.size()]) < near)
                return CellDrawing::Point::On::edge;
        const Vec3 normal = glm::normalize(glm::cross(wall[1] - wall[0], wall[2] - wall[0]));
        on_face |= std::abs(glm::dot(normal, x - wall[0])) < near;
    }
    return on_face ? CellDrawing::Point::On::face : CellDrawing::Point::On::inside;
}

}  // namespace

CellDrawing::CellDrawing(const Solid& solid, Vec3 seed, Plane cut, Vec3 eye_direction)
    : solid_(flatten(solid)),
      camera_({.eye = seed + far * glm::normalize(eye_direction), .target = seed, .fov = 0.1}, 2, 2),
      towards_eye_(glm::normalize(eye_direction)) {
    Subdivision subdivision(solid_, polygonization_box(solid_));
    int cell = -1;
    for (int c = 0; c < int(subdivision.complex.cells.size()); ++c)
        if (subdivision.open(c, 0) && inside(walls_of(subdivision.complex, c), seed)) cell = c;
    if (cell < 0 || !subdivision.halve(cell, cut)) throw std::logic_error("a drawing of a cell: there is none to cut");
    walls_ = walls_of(subdivision.complex, cell);

    Subspace subspace(subdivision);
    subspace.polygonize();
    const CellComplex& after = subspace.complex();
    std::map<int, int> known;
    std::map<std::pair<int, int>, int> next;  // from a point to the next, along half-edges without a twin
    for (int f = 0; f < int(after.faces.size()); ++f) {
        const auto& face = after.faces[f];
        if (subspace.leaf_of(f) < 0 || face.back < 0 || subspace.origin(face.back) != cell) continue;
        std::vector<int> corners;
        for (const int v : after.corners(f)) {
            const auto [at, is_new] = known.try_emplace(v, int(points_.size()));
            if (is_new) points_.push_back({after.vertices[v], place_of(after.vertices[v], walls_)});
            corners.push_back(at->second);
        }
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const int a = corners[k], b = corners[(k + 1) % corners.size()];
            if (!next.erase({b, a})) next[{a, b}] = 1;
        }
        faces_.push_back(std::move(corners));
    }
    if (next.empty()) throw std::logic_error("a drawing of a cell: the surface does not pass it");
    std::map<int, int> after_point;
    for (const auto& [ends, unused] : next) after_point[ends.first] = ends.second;
    for (int p = after_point.begin()->first; loop_.empty() || p != loop_.front(); p = after_point.at(p))
        loop_.push_back(p);
}

Vec2 CellDrawing::project(Vec3 x) const {
    const Vec3 p = camera_.project(x);
    return {p.x, -p.y};
}

Curve CellDrawing::polygon(const std::vector<Vec3>& corners, const std::string& color, double opacity) const {
    Curve curve{.points = {}, .color = color, .kind = Curve::Kind::fill, .width = 0, .opacity = opacity};
    for (const Vec3& x : corners) curve.points.push_back(project(x));
    return curve;
}

Curve CellDrawing::line(const std::vector<Vec3>& through, const std::string& color, double width,
                        const std::string& dash) const {
    Curve curve{.points = {}, .color = color, .width = width, .dash = dash};
    for (const Vec3& x : through) curve.points.push_back(project(x));
    return curve;
}

Curve CellDrawing::dots(const std::vector<Vec3>& at, const std::string& color) const {
    Curve curve = line(at, color, 3.2);
    curve.kind = Curve::Kind::points;
    return curve;
}

Plot CellDrawing::plot(int width, int height) const {
    Plot plot = drawing(width, height);
    Vec2 lo(1e9), hi(-1e9);
    // Draws the back first; an edge is in front if a face beside it is.
    for (const bool front : {false, true})
        for (const auto& wall : walls_) {
            const bool faces_eye = glm::dot(glm::cross(wall[1] - wall[0], wall[2] - wall[0]), towards_eye_) > 0;
            for (const Vec3& x : wall) {
                lo = glm::min(lo, project(x));
                hi = glm::max(hi, project(x));
            }
            if (faces_eye != front) continue;
            std::vector<Vec3> around = wall;
            around.push_back(wall[0]);
            if (!front) {
                plot.curves.push_back(line(around, "#b5b5b5", 1.2, "-"));
            } else {
                plot.curves.push_back(line(around, house::grey, 1.6));
            }
        }
    const Vec2 margin = 0.06 * (hi - lo);
    plot.x_range = Vec2(lo.x - margin.x, hi.x + margin.x);
    plot.y_range = Vec2(lo.y - margin.y, hi.y + margin.y);
    return plot;
}

}  // namespace deburr
