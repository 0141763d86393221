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

// H1: x ≤ 0 with radius r1; H2 leans, so that the regions are no squares.
constexpr double r1 = 1, r2 = 0.65, angle = 1.25;
const Vec2 n1(1, 0), n2(std::cos(angle), std::sin(angle));
const Vec2 lo(-2.6, -2.1), hi(2.4, 2.0);  // the part of the plane that is shown

double rho(Vec2 x) { return profile(glm::dot(n1, x) / r1) * profile(glm::dot(n2, x) / r2); }

// The point at signed distances d1 and d2 from the planes.
Vec2 meet(double d1, double d2) { return Vec2(d1, (d2 - n2.x * d1) / n2.y); }

// Ends of the four intervals of each half-space, from inside; the outermost ones reach beyond the picture.
constexpr double far = 8;
constexpr std::array<double, 5> a = {-far, -r1, 0, r1, far}, b = {-far, -r2, 0, r2, far};

// A region: an interval of the signed distance from each plane.
struct Region {
    Range d1, d2;
    DensityClass density_class;
    bool is_r1;  // whether it is the paper's R₁

    // The point at the shares u and v (0 … 1) of the intervals.
    Vec2 at(double u, double v) const { return meet(glm::mix(d1.lo, d1.hi, u), glm::mix(d2.lo, d2.hi, v)); }
    std::vector<Vec2> corners() const {
        return {meet(d1.lo, d2.lo), meet(d1.hi, d2.lo), meet(d1.hi, d2.hi), meet(d1.lo, d2.hi)};
    }
};

std::vector<Region> all_regions() {
    const std::array<DensityClass, 4> classes = {DensityClass::one, DensityClass::high, DensityClass::low,
                                                 DensityClass::zero};
    std::vector<Region> all;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            all.push_back(
                {{a[i], a[i + 1]}, {b[j], b[j + 1]}, combine(Op::product, classes[i], classes[j]), i == 2 && j == 1});
    return all;
}

bool contradicts(DensityClass c, double density) {
    switch (c) {
        case DensityClass::low: return density >= 0.5;
        case DensityClass::high: return density < 0.5;
        case DensityClass::zero: return density > 0;
        default: return false;
    }
}

// The number of places, of 19 × 19, where the density is not in the region's class.
int contradictions(const Region& region) {
    int wrong = 0;
    for (int u = 1; u < 20; ++u)
        for (int v = 1; v < 20; ++v) wrong += contradicts(region.density_class, rho(region.at(u / 20.0, v / 20.0)));
    return wrong;
}

// The middle of the region's part that is shown, if any is.
std::optional<Vec2> middle_of_visible_part(const Region& region) {
    Vec2 sum(0.0);
    int visible = 0;
    for (int u = 0; u < 60; ++u)
        for (int v = 0; v < 60; ++v) {
            const Vec2 x = region.at((u + 0.5) / 60, (v + 0.5) / 60);
            if (x.x < lo.x || x.x > hi.x || x.y < lo.y || x.y > hi.y) continue;
            sum += x;
            ++visible;
        }
    if (visible == 0) return {};
    return sum / double(visible);
}

// Adds the region in the colour of its class, and the class's name.
void add_region(Plot& plot, const Region& region) {
    const DensityClass c = region.density_class;
    plot.curves.push_back({.points = region.corners(), .color = color_of(c), .kind = Curve::Kind::fill, .width = 0});
    const std::optional<Vec2> middle = middle_of_visible_part(region);
    if (!middle) return;
    Vec2 at = *middle;
    if (c == DensityClass::unclassified) at -= Vec2(0.14, 0.1);  // away from the curve
    plot.labels.push_back({.at = at, .text = name_of(c), .align = Label::Align::center, .size = 9.5});
    if (region.is_r1)
        plot.labels.push_back(
            {.at = at + Vec2(0, 0.2), .text = "{/:Italic R}_1", .align = Label::Align::center, .size = 12});
}

// Adds the planes of both half-spaces with their names, and dashed their parallels at ±r.
void add_planes(Plot& plot) {
    const char* one[] = {"{/:Italic h}_{1,−{/:Italic r}_1}", "{/:Italic h}_1", "{/:Italic h}_{1,{/:Italic r}_1}"};
    const char* two[] = {"{/:Italic h}_{2,−{/:Italic r}_2}", "{/:Italic h}_2", "{/:Italic h}_{2,{/:Italic r}_2}"};
    for (std::size_t i = 1; i < 4; ++i) {
        const char* dash = i == 2 ? "" : "-";
        plot.curves.push_back(
            {.points = {meet(a[i], -far), meet(a[i], far)}, .color = house::ink, .width = 1.3, .dash = dash});
        plot.curves.push_back(
            {.points = {meet(-far, b[i]), meet(far, b[i])}, .color = house::ink, .width = 1.3, .dash = dash});
        plot.labels.push_back({.at = {a[i] + 0.06, hi.y + 0.08}, .text = one[i - 1], .size = 12});
        plot.labels.push_back(
            {.at = {lo.x + 0.06, meet(0, b[i]).y - n2.x / n2.y * lo.x + 0.12}, .text = two[i - 1], .size = 12});
    }
}

void add_isosurface(Plot& plot) {
    for (const auto& line : level_lines(rho, 0.5, lo, hi, 250, 205))
        plot.curves.push_back({.points = line, .color = house::blue, .width = 3.2});
}

void add_p1(Plot& plot, Vec2 p1) {
    plot.curves.push_back({.points = circle(p1, 0.045), .color = house::ink, .kind = Curve::Kind::fill, .width = 0});
    plot.labels.push_back({.at = p1 + Vec2(0.08, -0.14), .text = "{/:Italic p}_1", .size = 13});
}

void make(FigureContext& context) {
    Plot plot = drawing(640, 520);
    plot.x_range = Vec2(lo.x, hi.x);
    plot.y_range = Vec2(lo.y, hi.y + 0.25);
    int wrong = 0;
    std::array<int, 5> count{};
    for (const Region& region : all_regions()) {
        add_region(plot, region);
        wrong += contradictions(region);
        ++count[std::size_t(region.density_class)];
    }
    add_planes(plot);
    add_isosurface(plot);
    const Vec2 p1 = meet(0, -r2);
    add_p1(plot, p1);
    context.plot(plot);
    context.measured(fmt::format(
        "ρ(p₁) = {:g}. Of 16 regions {} are unclassified, {} high or one, {} low, {} zero; of 5776 points none "
        "may contradict its region's class, {} did.",
        rho(p1), count[std::size_t(DensityClass::unclassified)],
        count[std::size_t(DensityClass::high)] + count[std::size_t(DensityClass::one)],
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
