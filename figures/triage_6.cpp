// Triage, figure 6: the regions of an intersection of two half-spaces with different radii.
#include "bounds/profile.hpp"
#include "figures/figure.hpp"
#include "figures/plane_curves.hpp"
#include "polygonizer/triage/density_class.hpp"

namespace deburr {
namespace {

const char* name_of(DensityClass c) {
    switch (c) {
        case DensityClass::zero: return "zero";
        case DensityClass::low: return "low";
        case DensityClass::unclassified: return "unclassified";
        case DensityClass::high: return "high";
        case DensityClass::one: return "one";
    }
    return "";
}

const char* color_of(DensityClass c) {
    switch (c) {
        case DensityClass::zero: return "#ffffff";
        case DensityClass::low: return "#e3eaf2";
        case DensityClass::unclassified: return "#f3d79a";
        case DensityClass::high: return "#e3a892";
        case DensityClass::one: return "#c4684d";
    }
    return "";
}

void make(FigureContext& context) {
    // H1: x ≤ 0 with radius r1; H2 leans, so that the regions are no squares.
    constexpr double r1 = 1, r2 = 0.65, angle = 1.25;
    const Vec2 n1(1, 0), n2(std::cos(angle), std::sin(angle));
    const auto rho = [&](Vec2 x) { return profile(glm::dot(n1, x) / r1) * profile(glm::dot(n2, x) / r2); };
    const Vec2 lo(-2.6, -2.1), hi(2.4, 2.0);
    // The point at signed distances d1 and d2 from the planes.
    const auto meet = [&](double d1, double d2) { return Vec2(d1, (d2 - n2.x * d1) / n2.y); };

    Plot plot = drawing(640, 520);
    plot.x_range = Vec2(lo.x, hi.x);
    plot.y_range = Vec2(lo.y, hi.y + 0.25);

    // The four intervals of each half-space, from inside; the outermost ones reach beyond the picture.
    const double far = 8;
    const std::array<double, 5> a = {-far, -r1, 0, r1, far}, b = {-far, -r2, 0, r2, far};
    const std::array<DensityClass, 4> classes = {DensityClass::one, DensityClass::high, DensityClass::low,
                                                 DensityClass::zero};
    int open = 0, wrong = 0;
    std::array<int, 5> count{};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
            const DensityClass c = combine(Op::product, classes[i], classes[j]);
            ++count[std::size_t(c)];
            open += c == DensityClass::unclassified;
            std::vector<Vec2> corners = {meet(a[i], b[j]), meet(a[i + 1], b[j]), meet(a[i + 1], b[j + 1]),
                                         meet(a[i], b[j + 1])};
            plot.curves.push_back({.points = corners, .color = color_of(c), .kind = Curve::Kind::fill, .width = 0});
            // Counts places where the density is not in the region's class.
            for (int u = 1; u < 20; ++u)
                for (int v = 1; v < 20; ++v) {
                    const double value =
                        rho(meet(glm::mix(a[i], a[i + 1], u / 20.0), glm::mix(b[j], b[j + 1], v / 20.0)));
                    wrong += c == DensityClass::low    ? value >= 0.5
                             : c == DensityClass::high ? value < 0.5
                                                       : c == DensityClass::zero && value > 0;
                }
            // The label is at the middle of the visible part of the region.
            Vec2 middle(0.0);
            int inside = 0;
            for (int u = 0; u < 60; ++u)
                for (int v = 0; v < 60; ++v) {
                    const Vec2 x =
                        meet(glm::mix(a[i], a[i + 1], (u + 0.5) / 60), glm::mix(b[j], b[j + 1], (v + 0.5) / 60));
                    if (x.x < lo.x || x.x > hi.x || x.y < lo.y || x.y > hi.y) continue;
                    middle += x;
                    ++inside;
                }
            if (inside == 0) continue;
            Vec2 at = middle / double(inside);
            if (c == DensityClass::unclassified) at -= Vec2(0.14, 0.1);  // away from the curve
            plot.labels.push_back({.at = at, .text = name_of(c), .align = Label::Align::center, .size = 9.5});
            if (i == 2 && j == 1)
                plot.labels.push_back(
                    {.at = at + Vec2(0, 0.2), .text = "{/:Italic R}_1", .align = Label::Align::center, .size = 12});
        }
    for (std::size_t i = 1; i < 4; ++i) {
        const char* dash = i == 2 ? "" : "-";
        plot.curves.push_back(
            {.points = {meet(a[i], -far), meet(a[i], far)}, .color = house::ink, .width = 1.3, .dash = dash});
        plot.curves.push_back(
            {.points = {meet(-far, b[i]), meet(far, b[i])}, .color = house::ink, .width = 1.3, .dash = dash});
        const char* one[] = {"{/:Italic h}_{1,−{/:Italic r}_1}", "{/:Italic h}_1", "{/:Italic h}_{1,{/:Italic r}_1}"};
        const char* two[] = {"{/:Italic h}_{2,−{/:Italic r}_2}", "{/:Italic h}_2", "{/:Italic h}_{2,{/:Italic r}_2}"};
        plot.labels.push_back({.at = {a[i] + 0.06, hi.y + 0.08}, .text = one[i - 1], .size = 12});
        plot.labels.push_back(
            {.at = {lo.x + 0.06, meet(0, b[i]).y - n2.x / n2.y * lo.x + 0.12}, .text = two[i - 1], .size = 12});
    }
    for (const auto& line : level_lines(rho, 0.5, lo, hi, 250, 205))
        plot.curves.push_back({.points = line, .color = house::blue, .width = 3.2});
    const Vec2 p1 = meet(0, -r2);
    plot.curves.push_back({.points = circle(p1, 0.045), .color = house::ink, .kind = Curve::Kind::fill, .width = 0});
    plot.labels.push_back({.at = p1 + Vec2(0.08, -0.14), .text = "{/:Italic p}_1", .size = 13});
    context.plot(plot);
    context.measured(fmt::format(
        "ρ(p₁) = {:g}. Of 16 regions {} are unclassified, {} high or one, {} low, {} zero; of 5776 points none "
        "may contradict its region's class, {} did.",
        rho(p1), open, count[std::size_t(DensityClass::high)] + count[std::size_t(DensityClass::one)],
        count[std::size_t(DensityClass::low)], count[std::size_t(DensityClass::zero)], wrong));
}

const RegisteredFigure registered{{
    .name = "triage-6",
    .title = "Figure 6: the intersection of two half-spaces, and its 16 regions",
    .shows = "The classes that table 1 gives the regions, and in blue the isosurface: it keeps to the unclassified "
             "ones, and to the planes "
             "between high and low.",
    .claim = "ρ(p₁) = 0.5 · 1 = 0.5, and region R₁ is low (§4.2.1).",
    .plots = true,
    .seconds = 1,
    .make = make,
}};

}  // namespace
}  // namespace deburr
