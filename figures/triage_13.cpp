// Triage, figures 13, 15 and 16: subspace polygonization of single cells.
#include <set>

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

// Draws the face of the cell in which the polygon's edge is refined most, as a plane figure.
void refinement(FigureContext& context) {
    context.columns(3);
    const CellDrawing cell = corner_cell();
    std::size_t best = 0;
    double most = -1;
    const auto& loop = cell.loop();
    const auto point = [&](std::size_t k) { return cell.points()[loop[k % loop.size()]]; };
    for (std::size_t k = 0; k < loop.size(); ++k) {
        if (point(k).on != On::face) continue;
        const double rise = glm::length(point(k).x - 0.5 * (point(k + loop.size() - 1).x + point(k + 1).x));
        if (rise > most) most = rise, best = k;
    }
    const Vec3 a = point(best + loop.size() - 1).x, b = point(best + 1).x, refined = point(best).x,
               middle = 0.5 * (a + b);
    const std::vector<Vec3>* wall = nullptr;
    Vec3 normal(0.0);
    for (const auto& w : cell.walls()) {
        const Vec3 n = glm::normalize(glm::cross(w[1] - w[0], w[2] - w[0]));
        double far = 0;
        for (const Vec3 x : {a, b, refined}) far = std::max(far, std::abs(glm::dot(n, x - w[0])));
        if (far < 1e-7) wall = &w, normal = n;
    }
    // Axes in the face: x along the polygon's edge.
    const Vec3 u = glm::normalize(b - a), v = glm::cross(normal, u);
    const auto flat = [&](Vec3 x) { return Vec2(glm::dot(x - middle, u), glm::dot(x - middle, v)); };
    const auto space = [&](Vec2 p) { return middle + p.x * u + p.y * v; };
    std::vector<Vec2> face;
    Vec2 lo(1e9), hi(-1e9);
    for (const Vec3& x : *wall) {
        face.push_back(flat(x));
        lo = glm::min(lo, face.back());
        hi = glm::max(hi, face.back());
    }
    // ∇ρ at p_mid, projected into the face; its line leaves the face at s_start and s_end.
    const Vec3 gradient = cell.density().gradient_at(middle).gradient;
    const Vec2 g = glm::normalize(Vec2(glm::dot(gradient, u), glm::dot(gradient, v)));
    double t0 = -infinity, t1 = infinity;
    for (std::size_t k = 0; k < face.size(); ++k) {
        const Vec2 p = face[k], q = face[(k + 1) % face.size()], inward(p.y - q.y, q.x - p.x);
        const double speed = glm::dot(inward, g), at_zero = glm::dot(inward, -p);
        if (speed > 0)
            t0 = std::max(t0, -at_zero / speed);
        else if (speed < 0)
            t1 = std::min(t1, -at_zero / speed);
    }
    const Vec2 start = t0 * g, end = t1 * g;
    const auto level =
        level_lines([&](Vec2 p) { return cell.density().at(space(p)); }, 0.5, lo - 0.02, hi + 0.02, 160, 160);

    const auto draw = [&](int step) {
        Plot plot = drawing(330, 300);
        const Vec2 margin = 0.12 * (hi - lo);
        plot.x_range = Vec2(lo.x - margin.x, hi.x + margin.x);
        plot.y_range = Vec2(lo.y - margin.y, hi.y + margin.y);
        plot.curves.push_back({.points = face, .color = "#f2f4f7", .kind = Curve::Kind::fill, .width = 1.5});
        for (const auto& line : level) {
            std::vector<Vec2> within;
            for (const Vec2 p : line) {
                bool in = true;
                for (std::size_t k = 0; k < face.size(); ++k) {
                    const Vec2 d = face[(k + 1) % face.size()] - face[k], e = p - face[k];
                    in &= d.x * e.y - d.y * e.x >= -1e-6;
                }
                within.push_back(in ? p : Vec2(NAN));
            }
            plot.curves.push_back({.points = within, .color = house::grey, .width = 1.5, .dash = "."});
        }
        const auto dot = [&](Vec2 p, const char* color, const char* name, Vec2 shift) {
            plot.curves.push_back({.points = {p}, .color = color, .kind = Curve::Kind::points, .width = 3.2});
            if (*name) plot.labels.push_back({.at = p + shift * (hi - lo), .text = name, .size = 12});
        };
        if (step < 3)
            plot.curves.push_back({.points = {flat(a), flat(b)}, .color = house::blue, .width = 2.4});
        else
            plot.curves.push_back({.points = {flat(a), flat(refined), flat(b)}, .color = house::blue, .width = 2.4});
        if (step < 3) {
            plot.curves.push_back(
                {.points = {start, end}, .color = house::red, .width = 1.4, .dash = step == 1 ? "-" : ""});
            dot(start, house::red, "{/:Italic s}_{start}", {-0.2, -0.02});
            dot(end, house::red, "{/:Italic s}_{end}", {0.0, 0.08});
            dot({0, 0}, house::ink, "{/:Italic p}_{mid}", {0.03, -0.07});
        }
        if (step > 1) dot(flat(refined), house::amber, "", {0, 0});
        dot(flat(a), house::red, "", {0, 0});
        dot(flat(b), house::red, "", {0, 0});
        return plot;
    };
    context.plot(draw(1), "(a) the gradient's line through p_mid");
    context.plot(draw(2), "(b) the root on it");
    context.plot(draw(3), "(c) the refined edge");
    const Vec2 r = flat(refined);
    context.measured(
        fmt::format("The program's new vertex is {:.1e} r off the gradient's line, and the edge's distance from the "
                    "isoline falls from "
                    "{:.3f} r to {:.3f} r.",
                    std::max(std::abs(r.x * g.y - r.y * g.x), 1e-16), most, [&] {
                        double worst = 0;
                        for (const auto& line : level)
                            for (const Vec2 p : line) {
                                double nearest = infinity;
                                for (const Vec3 end_point : {a, b}) {
                                    const Vec2 s = flat(end_point), d = r - s;
                                    const double t = glm::dot(p - s, d) / glm::dot(d, d);
                                    if (t >= 0 && t <= 1) nearest = std::min(nearest, glm::length(p - s - t * d));
                                }
                                if (nearest < infinity) worst = std::max(worst, nearest);
                            }
                        return worst;
                    }()));
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
