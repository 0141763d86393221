// Triage, figure 3: the density surfaces of an unsmoothed and of a smoothed intersection.
#include "bounds/profile.hpp"
#include "figures/figure.hpp"
#include "figures/height_field.hpp"
#include "figures/plane_curves.hpp"
#include "figures/studio.hpp"
#include "raytracer/mesh/mesh_tracer.hpp"

namespace deburr {
namespace {

constexpr double height = 1.3, radius = 0.9;
const Vec2 lo(-2.2, -2.2), hi(1.4, 1.4);

double sharp(Vec2 x) { return x.x < 0 && x.y < 0 ? 1 : 0; }
double smooth(Vec2 x) { return profile(x.x / radius) * profile(x.y / radius); }

// The density's graph with grid lines, and the isosurface in black.
Film picture(const FigureContext& context, const std::function<double(Vec2)>& f,
             const std::vector<std::vector<Vec2>>& level) {
    const Mesh mesh = height_field(f, lo, hi, 360, 360, height);
    MeshAppearance appearance{.width = 440, .height = 360, .gloss = 1};
    const Box box{{lo.x, 0, -hi.y}, {hi.x, height, -lo.y}};
    const Camera camera = framing(box, {1.05, 1.0, 0.62}, appearance.width, appearance.height);
    Film film = mesh_picture(context, mesh, {{0.55, 0.66, 0.80}, {0.30, 0.38, 0.50}}, camera, appearance);
    const MeshTracer tracer(mesh);
    const int width = film.width, tall = film.height;
    const ProjectiveCamera view(camera, width, tall);
    const auto draw = [&](const std::vector<Vec2>& line, const std::function<double(Vec2)>& value, Vec3 color,
                          double thick) {
        std::vector<Vec3> points, normals;
        for (const Vec2 p : line) {
            points.push_back({p.x, height * value(p) + 0.004, -p.y});
            constexpr double h = 1e-3;
            const double dx = (f(p + Vec2(h, 0)) - f(p - Vec2(h, 0))) / (2 * h),
                         dy = (f(p + Vec2(0, h)) - f(p - Vec2(0, h))) / (2 * h);
            normals.push_back(std::abs(dx) + std::abs(dy) > 100 ? Vec3(0, 1, 0)
                                                                : glm::normalize(Vec3(-height * dx, 1, height * dy)));
        }
        draw_strokes(film, visible_line(points, normals, tracer, view, {0, 0, width, tall}), color, thick);
    };
    constexpr int lines = 18, steps = 360;
    for (int k = 0; k <= lines; ++k)
        for (const bool along : {true, false}) {
            std::vector<Vec2> line;
            for (int i = 0; i <= steps; ++i) {
                const Vec2 t =
                    along ? Vec2(i / double(steps), k / double(lines)) : Vec2(k / double(lines), i / double(steps));
                line.push_back(glm::mix(lo, hi, t));
            }
            draw(line, f, {0.16, 0.22, 0.32}, 0.6);
        }
    for (const auto& line : level)
        draw(
            line, [](Vec2) { return 0.5; }, {0.01, 0.01, 0.01}, 2.6);
    return film;
}

void make(FigureContext& context) {
    context.columns(2);
    context.picture(picture(context, sharp, {}), "(a) unsmoothed");
    const auto level = level_lines(smooth, 0.5, lo, hi, 240, 240);
    context.picture(picture(context, smooth, level), fmt::format("(b) smoothed, r = {:g}; black: ρ = ½", radius));
    double corner = 0;
    for (const auto& line : level)
        for (const Vec2 p : line) corner = std::max(corner, std::min(-p.x, -p.y));
    context.measured(
        fmt::format("ρ in (b) is {:g} where the planes meet; the isosurface cuts the corner off {:.3f} r deep, "
                    "measured along either axis.",
                    smooth({0, 0}), corner / radius));
}

const RegisteredFigure registered{{
    .name = "triage-3",
    .title = "Figure 3: the product of two unsmoothed and of two smoothed half-spaces",
    .shows = "The density over the plane, as height.",
    .claim = "The ½ isosurface of the product is a smoothed version of the object, hardly to be told from that of a "
             "true convolution (§2.2).",
    .seconds = 6,
    .make = make,
}};

}  // namespace
}  // namespace deburr
