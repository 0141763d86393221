// Triage, figures 13, 15 and 16: subspace polygonization of single cells.
#include <cassert>

#include "figures/cell_drawing.hpp"
#include "figures/figure.hpp"
#include "figures/plane_curves.hpp"
#include "polygonizer/triage/density_class.hpp"

namespace deburr {
namespace {

using On = CellDrawing::Point::On;

// The corner of a block with r = 1, cut obliquely, so that the surface meets edges of the cell and no corners.
CellDrawing corner_cell() {
    const Vec3 normal = glm::normalize(Vec3(0.75, 0.55, -0.9));
    return CellDrawing(Solid::rounded(1, Density::box(Vec3(-4), Vec3(0))), Vec3(-0.4, -0.45, -0.5),
                       {normal, glm::dot(normal, Vec3(-0.22, -0.4, -0.6))}, {0.55, 0.6, 1});
}

std::vector<Vec3> at(const CellDrawing& cell, const std::vector<int>& points) {
    std::vector<Vec3> all;
    for (const int p : points) all.push_back(cell.points()[p].x);
    return all;
}

std::vector<Vec3> on(const CellDrawing& cell, On where) {
    std::vector<Vec3> all;
    for (const auto& p : cell.points())
        if (p.on == where) all.push_back(p.x);
    return all;
}

std::vector<Vec3> closed(std::vector<Vec3> line) {
    line.push_back(line.at(0));
    return line;
}

void add_faces(Plot& plot, const CellDrawing& cell, const std::vector<std::vector<int>>& faces) {
    const char* shades[] = {"#c9dcec", "#b3cde3", "#9dbdd9", "#c0d6e8", "#a8c5de", "#d2e2ef"};
    for (std::size_t i = 0; i < faces.size(); ++i) {
        plot.curves.push_back(cell.polygon(at(cell, faces[i]), shades[i % 6], 0.9));
        plot.curves.push_back(cell.line(closed(at(cell, faces[i])), house::blue, 1.8));
    }
}

void four_steps(FigureContext& context) {
    context.columns(4);
    const CellDrawing cell = corner_cell();
    std::vector<Vec3> coarse;  // the polygon before its edges are refined
    for (const int p : cell.loop())
        if (cell.points()[p].on == On::edge) coarse.push_back(cell.points()[p].x);
    constexpr int width = 330, height = 330;

    Plot a = cell.plot(width, height);
    a.curves.push_back(cell.dots(on(cell, On::edge), house::red));
    Plot b = cell.plot(width, height);
    b.curves.push_back(cell.polygon(coarse, "#b3cde3", 0.6));
    b.curves.push_back(cell.line(closed(coarse), house::blue, 2));
    b.curves.push_back(cell.dots(coarse, house::red));
    Plot c = cell.plot(width, height);
    c.curves.push_back(cell.line(closed(coarse), "#a9bed3", 1.2));
    c.curves.push_back(cell.line(closed(at(cell, cell.loop())), house::blue, 2));
    c.curves.push_back(cell.dots(on(cell, On::face), house::amber));
    c.curves.push_back(cell.dots(coarse, house::red));
    Plot d = cell.plot(width, height);
    add_faces(d, cell, cell.faces());
    d.curves.push_back(cell.dots(on(cell, On::inside), house::green));
    context.plot(a, "(a) where the isosurface meets edges");
    context.plot(b, "(b) joined to a polygon");
    context.plot(c, "(c) edges refined");
    context.plot(d, "(d) cut into planar polygons about a displaced centroid");

    double worst = 0;
    for (const auto& p : cell.points()) worst = std::max(worst, std::abs(cell.density().at(p.x) - 0.5));
    context.measured(fmt::format(
        "{} intersections with edges, {} points on faces, {} inside, {} polygons; all points have ρ = ½ to {:.0e}.",
        on(cell, On::edge).size(), on(cell, On::face).size(), on(cell, On::inside).size(), cell.faces().size(),
        std::max(worst, 1e-16)));
}

// An edge of the isosurface's polygon, in a face of the cell, and the point by which it is refined.
struct RefinedEdge {
    Vec3 a, b, refined;
    Vec3 middle() const { return 0.5 * (a + b); }                    // p_mid
    double rise() const { return glm::length(refined - middle()); }  // by which the middle is moved
};

// The edge whose middle is moved most.
RefinedEdge most_refined_edge(const CellDrawing& cell) {
    const auto& loop = cell.loop();
    const auto point = [&](std::size_t k) { return cell.points()[loop[k % loop.size()]]; };
    RefinedEdge best{};
    double most = -1;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        if (point(k).on != On::face) continue;
        const RefinedEdge edge{point(k + loop.size() - 1).x, point(k + 1).x, point(k).x};
        if (edge.rise() > most) most = edge.rise(), best = edge;
    }
    return best;
}

Vec3 normal_of(const std::vector<Vec3>& wall) {
    return glm::normalize(glm::cross(wall[1] - wall[0], wall[2] - wall[0]));
}

// The face of the cell in which the edge is.
const std::vector<Vec3>& wall_with(const CellDrawing& cell, const RefinedEdge& edge) {
    constexpr double near = 1e-7;
    const std::vector<Vec3>* found = nullptr;
    for (const auto& wall : cell.walls()) {
        double far = 0;
        for (const Vec3 x : {edge.a, edge.b, edge.refined})
            far = std::max(far, std::abs(glm::dot(normal_of(wall), x - wall[0])));
        if (far < near) found = &wall;
    }
    assert(found);
    return *found;
}

// A face of the cell as a plane figure: its origin is p_mid, the middle of the polygon's edge, along which x runs.
struct FaceDrawing {
    std::vector<Vec2> face;                     // counter-clockwise
    Vec2 lo, hi;                                // the face's box
    Vec2 a, b, refined;                         // the edge's ends, and the point by which it is refined
    Vec2 gradient;                              // direction of ∇ρ at p_mid, projected into the face
    Vec2 start, end;                            // where the gradient's line leaves the face: s_start and s_end
    std::vector<std::vector<Vec2>> isosurface;  // lines in which it meets the face's plane
};

// The stretch of the line t·direction in a convex, counter-clockwise polygon.
Range stretch_within(const std::vector<Vec2>& polygon, Vec2 direction) {
    Range t{-infinity, infinity};
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 p = polygon[k], q = polygon[(k + 1) % polygon.size()], inward(p.y - q.y, q.x - p.x);
        const double speed = glm::dot(inward, direction), at_zero = glm::dot(inward, -p);
        if (speed > 0)
            t.lo = std::max(t.lo, -at_zero / speed);
        else if (speed < 0)
            t.hi = std::min(t.hi, -at_zero / speed);
    }
    return t;
}

FaceDrawing face_drawing(const CellDrawing& cell, const RefinedEdge& edge) {
    const std::vector<Vec3>& wall = wall_with(cell, edge);
    const Vec3 middle = edge.middle(), u = glm::normalize(edge.b - edge.a), v = glm::cross(normal_of(wall), u);
    const auto flat = [&](Vec3 x) { return Vec2(glm::dot(x - middle, u), glm::dot(x - middle, v)); };
    const auto space = [&](Vec2 p) { return middle + p.x * u + p.y * v; };
    FaceDrawing d{.face = {},
                  .lo = Vec2(1e9),
                  .hi = Vec2(-1e9),
                  .a = flat(edge.a),
                  .b = flat(edge.b),
                  .refined = flat(edge.refined),
                  .gradient = {},
                  .start = {},
                  .end = {},
                  .isosurface = {}};
    for (const Vec3& x : wall) {
        d.face.push_back(flat(x));
        d.lo = glm::min(d.lo, d.face.back());
        d.hi = glm::max(d.hi, d.face.back());
    }
    const Vec3 gradient = cell.density().gradient_at(middle).gradient;
    d.gradient = glm::normalize(Vec2(glm::dot(gradient, u), glm::dot(gradient, v)));
    const Range t = stretch_within(d.face, d.gradient);
    d.start = t.lo * d.gradient;
    d.end = t.hi * d.gradient;
    d.isosurface =
        level_lines([&](Vec2 p) { return cell.density().at(space(p)); }, 0.5, d.lo - 0.02, d.hi + 0.02, 160, 160);
    return d;
}

// The line, interrupted where it is outside of a convex, counter-clockwise polygon.
std::vector<Vec2> part_within(const std::vector<Vec2>& polygon, const std::vector<Vec2>& line) {
    std::vector<Vec2> part;
    for (const Vec2 p : line) {
        bool in = true;
        for (std::size_t k = 0; k < polygon.size(); ++k)
            in &= cross(polygon[(k + 1) % polygon.size()] - polygon[k], p - polygon[k]) >= -1e-6;
        part.push_back(in ? p : Vec2(NAN));
    }
    return part;
}

// The steps of a refinement: the gradient's line through p_mid, the root on it, and the edge through the root.
enum class Step { line, root, edge };

Plot plot_of(const FaceDrawing& d, Step step) {
    Plot plot = drawing(330, 300);
    const Vec2 size = d.hi - d.lo, margin = 0.12 * size;
    plot.x_range = Vec2(d.lo.x - margin.x, d.hi.x + margin.x);
    plot.y_range = Vec2(d.lo.y - margin.y, d.hi.y + margin.y);
    plot.curves.push_back({.points = d.face, .color = "#f2f4f7", .kind = Curve::Kind::fill, .width = 1.5});
    for (const auto& line : d.isosurface)
        plot.curves.push_back({.points = part_within(d.face, line), .color = house::grey, .width = 1.5, .dash = "."});
    const auto dot = [&](Vec2 p, const char* color) {
        plot.curves.push_back({.points = {p}, .color = color, .kind = Curve::Kind::points, .width = 3.2});
    };
    const auto name = [&](Vec2 p, const char* text, Vec2 shift) {
        plot.labels.push_back({.at = p + shift * size, .text = text, .size = 12});
    };
    if (step == Step::edge) {
        plot.curves.push_back({.points = {d.a, d.refined, d.b}, .color = house::blue, .width = 2.4});
    } else {
        plot.curves.push_back({.points = {d.a, d.b}, .color = house::blue, .width = 2.4});
        plot.curves.push_back(
            {.points = {d.start, d.end}, .color = house::red, .width = 1.4, .dash = step == Step::line ? "-" : ""});
        dot(d.start, house::red);
        name(d.start, "{/:Italic s}_{start}", {-0.2, -0.02});
        dot(d.end, house::red);
        name(d.end, "{/:Italic s}_{end}", {0.0, 0.08});
        dot({0, 0}, house::ink);
        name({0, 0}, "{/:Italic p}_{mid}", {0.03, -0.07});
    }
    if (step != Step::line) dot(d.refined, house::amber);
    dot(d.a, house::red);
    dot(d.b, house::red);
    return plot;
}

// The greatest distance of the isosurface's points beside the refined edge's halves from these.
double greatest_distance_from_refined_edge(const FaceDrawing& d) {
    double greatest = 0;
    for (const auto& line : d.isosurface)
        for (const Vec2 p : line) {
            double nearest = infinity;
            for (const Vec2 end : {d.a, d.b}) {
                const Vec2 half = d.refined - end;
                const double t = glm::dot(p - end, half) / glm::dot(half, half);
                if (t >= 0 && t <= 1) nearest = std::min(nearest, glm::length(p - end - t * half));
            }
            if (nearest < infinity) greatest = std::max(greatest, nearest);
        }
    return greatest;
}

// Draws the face of the cell in which the polygon's edge is refined most, as a plane figure.
void refinement(FigureContext& context) {
    context.columns(3);
    const CellDrawing cell = corner_cell();
    const RefinedEdge edge = most_refined_edge(cell);
    const FaceDrawing d = face_drawing(cell, edge);
    context.plot(plot_of(d, Step::line), "(a) the gradient's line through p_mid");
    context.plot(plot_of(d, Step::root), "(b) the root on it");
    context.plot(plot_of(d, Step::edge), "(c) the refined edge");
    context.measured(fmt::format(
        "The program's new vertex is {:.1e} r off the gradient's line, and the edge's distance from the "
        "isoline falls from {:.3f} r to {:.3f} r.",
        std::max(std::abs(cross(d.refined, d.gradient)), 1e-16), edge.rise(), greatest_distance_from_refined_edge(d)));
}

void two_half_spaces(FigureContext& context) {
    context.columns(3);
    const Vec3 normal = glm::normalize(Vec3(0.35, 0.25, 1));
    const CellDrawing cell(Solid::rounded(1, Density::box(Vec3(-4, -4, -4), Vec3(0, 0, 0))), Vec3(-0.5, -0.5, -2),
                           {normal, glm::dot(normal, Vec3(-0.5, -0.5, -1.6))}, {0.9, 0.7, 0.75});
    const std::vector<Vec3> loop = at(cell, cell.loop());
    constexpr int width = 330, height = 330;
    Plot a = cell.plot(width, height);
    a.curves.push_back(cell.polygon(loop, "#b3cde3", 0.7));
    a.curves.push_back(cell.line(closed(loop), house::blue, 2));
    a.curves.push_back(cell.dots(loop, house::red));

    // The general method: a fan around the centroid, moved along the gradient onto the isosurface.
    Vec3 center(0.0);
    for (const Vec3& x : loop) center += x / double(loop.size());
    const LocalDensity local(cell.density());
    const Vec3 direction = glm::normalize(local.gradient_at(center).gradient);
    const double here = local.at(center) - 0.5, reach = here > 0 ? -0.5 : 0.5;
    const Vec3 there = center + reach * direction;
    center = root_between(local, center, here, there, local.at(there) - 0.5);
    Plot b = cell.plot(width, height);
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const std::vector<Vec3> triangle = {loop[k], loop[(k + 1) % loop.size()], center};
        b.curves.push_back(cell.polygon(triangle, k % 2 ? "#c9dcec" : "#b3cde3", 0.9));
        b.curves.push_back(cell.line(closed(triangle), house::blue, 1.6));
    }
    b.curves.push_back(cell.dots({center}, house::green));
    Plot c = cell.plot(width, height);
    add_faces(c, cell, cell.faces());
    context.plot(a, "(a) the cell and the isosurface's outline");
    context.plot(b, "(b) fragmented about a centroid");
    context.plot(c, "(c) what Deburr puts out");
    context.measured(fmt::format("{} triangles in (b), {} polygons in (c).", loop.size(), cell.faces().size()));
}

const RegisteredFigure steps{{
    .name = "triage-13",
    .title = "Figure 13: subspace polygonization in four steps",
    .shows = "A cell at a block's rounded corner.",
    .claim = "Points where edges meet the isosurface, a polygon through them, its edges refined by one point each, and "
             "planar polygons (§4.4).",
    .plots = true,
    .make = four_steps,
}};

const RegisteredFigure refined{{
    .name = "triage-15",
    .title = "Figure 15: refinement of an edge",
    .shows = "A face of that cell. Dotted: the isosurface in it.",
    .claim = "The line along the gradient through p_mid, projected into the face, is searched for a root from p_mid to "
             "its ends (§4.4.3).",
    .plots = true,
    .make = refinement,
}};

const RegisteredFigure swept{{
    .name = "triage-16",
    .title = "Figure 16: a cell with an intersection of two half-spaces",
    .shows = "",
    .claim = "Some 30 % of the unclassified cells hold two half-spaces only; their surface is swept, and the convex "
             "hull of the intersection points "
             "gives fewer polygons than the general method (§4.5.2).",
    .plots = true,
    .make = two_half_spaces,
}};

}  // namespace
}  // namespace deburr
