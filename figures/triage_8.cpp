// Triage, figure 8: from a CSG object with a rounding radius to a classified density field, in the plane: the objects
// are infinite prisms.
#include "figures/figure.hpp"
#include "figures/plane_curves.hpp"
#include "polygonizer/triage/cell_mesh.hpp"

namespace deburr {
namespace {

constexpr double r = 0.42;

struct Block {
    Vec2 lo, hi;
    Density density() const {
        return Density::half_space({1, 0, 0}, hi.x) * Density::half_space({-1, 0, 0}, -lo.x) *
               Density::half_space({0, 1, 0}, hi.y) * Density::half_space({0, -1, 0}, -lo.y);
    }
    std::vector<Vec2> outline() const { return {lo, {hi.x, lo.y}, hi, {lo.x, hi.y}}; }
};

const Block whole{{0, 0}, {4, 3}}, hole{{1.25, 1.0}, {2.85, 2.1}};
const Vec2 lo(-0.9, -0.9), hi(4.9, 3.9);

const char* color_of(DensityClass c) {
    switch (c) {
        case DensityClass::zero: return "#ffffff";
        case DensityClass::low: return "#dfe7f0";
        case DensityClass::unclassified: return "#f3d79a";
        case DensityClass::high: return "#e3a892";
        case DensityClass::one: return "#c4684d";
    }
    return "";
}

Plot panel() {
    Plot plot = drawing(330, 270);
    plot.x_range = Vec2(lo.x, hi.x);
    plot.y_range = Vec2(lo.y, hi.y);
    return plot;
}

void outline(Plot& plot, const Block& block, const char* color, double width, const char* dash = "") {
    std::vector<Vec2> line = block.outline();
    line.push_back(line[0]);
    plot.curves.push_back({.points = line, .color = color, .width = width, .dash = dash});
}

using Lines = std::vector<std::vector<Vec2>>;

// The planes of a block along one axis, and their parallels at ±r.
std::vector<double> planes(double a, double b) { return {a - r, a, a + r, b - r, b, b + r}; }

// Twice the signed area that a closed line encloses.
double double_area(const std::vector<Vec2>& line) {
    double area = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) area += line[i].x * line[i + 1].y - line[i].y * line[i + 1].x;
    return area;
}

void add_lines(Plot& plot, const Lines& lines, double width) {
    for (const auto& line : lines) plot.curves.push_back({.points = line, .color = house::blue, .width = width});
}

// The smoothed object between its outer border and the hole's.
Plot object_within(const Lines& borders) {
    Plot plot = panel();
    for (const bool outer : {true, false})  // the hole is drawn over the object
        for (const auto& line : borders)
            if ((std::abs(double_area(line)) > 10) == outer)
                plot.curves.push_back(
                    {.points = line, .color = outer ? house::shade : "#ffffff", .kind = Curve::Kind::fill, .width = 0});
    add_lines(plot, borders, 2.4);
    return plot;
}

Plot definition() {
    Plot plot = panel();
    outline(plot, whole, house::ink, 2);
    outline(plot, hole, house::ink, 2, "-");
    plot.labels.push_back({.at = {2, 2.55}, .text = "A", .align = Label::Align::center, .size = 14});
    plot.labels.push_back({.at = {2.05, 1.55}, .text = "B", .align = Label::Align::center, .size = 14});
    plot.labels.push_back({.at = {2, -0.5}, .text = fmt::format("A − B, r = {:g}", r), .align = Label::Align::center});
    return plot;
}

Plot density_of(const Block& block) {
    Plot plot = panel();
    const SolidTree solid = flatten(Solid::rounded(r, block.density()));
    plot.field = sampled([&](Vec2 x) { return solid.leaves[0].density.at(Vec3(x.x, x.y, 0)); }, lo, hi, 174, 144);
    outline(plot, block, house::ink, 1);
    return plot;
}

// Adds the block's planes, and their parallels dashed.
void add_planes(Plot& plot, const Block& block, const char* color) {
    const auto add = [&](Vec2 from, Vec2 to, bool own) {
        plot.curves.push_back({.points = {from, to}, .color = color, .width = own ? 1.8 : 1, .dash = own ? "" : "-"});
    };
    const auto is_own = [](std::size_t i) { return i == 1 || i == 4; };
    const std::vector<double> x = planes(block.lo.x, block.hi.x), y = planes(block.lo.y, block.hi.y);
    for (std::size_t i = 0; i < x.size(); ++i) add({x[i], lo.y}, {x[i], hi.y}, is_own(i));
    for (std::size_t i = 0; i < y.size(); ++i) add({lo.x, y[i]}, {hi.x, y[i]}, is_own(i));
}

Plot planes_of_both() {
    Plot plot = panel();
    add_planes(plot, whole, house::blue);
    add_planes(plot, hole, house::red);
    return plot;
}

// Every region between the block's planes with its class from table 1.
Plot regions_of(const Block& block) {
    Plot plot = panel();
    const std::vector<double> x = planes(block.lo.x, block.hi.x), y = planes(block.lo.y, block.hi.y);
    const std::vector<DensityClass> across = {DensityClass::low, DensityClass::high, DensityClass::one,
                                              DensityClass::high, DensityClass::low};
    for (std::size_t i = 0; i + 1 < x.size(); ++i)
        for (std::size_t j = 0; j + 1 < y.size(); ++j)
            plot.curves.push_back({.points = {{x[i], y[j]}, {x[i + 1], y[j]}, {x[i + 1], y[j + 1]}, {x[i], y[j + 1]}},
                                   .color = color_of(combine(Op::product, across[i], across[j])),
                                   .kind = Curve::Kind::fill,
                                   .width = 0.8});
    return plot;
}

// The corners of the cell's front face, as seen along z.
std::vector<Vec2> front_of(const CellComplex& complex, int cell) {
    std::vector<Vec2> corners;
    for (const int f : complex.cells[std::size_t(cell)]) {
        std::vector<Vec2> face;
        bool front = true;
        for (const int v : complex.corners(f)) {
            front &= complex.vertices[std::size_t(v)].z > 0;
            face.push_back(Vec2(complex.vertices[std::size_t(v)]));
        }
        if (front) corners = face;
    }
    return corners;
}

// The classes of the subdivision's cells in the density field.
std::vector<DensityClass> classes_of(const Subdivision& s, const DensityTree& density) {
    std::vector<DensityClass> classes;
    for (int cell = 0; cell < int(s.complex.cells.size()); ++cell) classes.push_back(cell_class(s, cell, 0, density));
    return classes;
}

// The cells in class colours, and the smoothed object's borders.
Plot subdivision_of(const Subdivision& s, const std::vector<DensityClass>& classes, const Lines& borders) {
    Plot plot = panel();
    for (std::size_t cell = 0; cell < classes.size(); ++cell)
        plot.curves.push_back({.points = front_of(s.complex, int(cell)),
                               .color = color_of(classes[cell]),
                               .kind = Curve::Kind::fill,
                               .width = 0.8});
    add_lines(plot, borders, 2.2);
    return plot;
}

// The subdivision tree with its leaves from left to right, in class colours.
Plot tree_of(const Subdivision& s, const std::vector<DensityClass>& classes) {
    std::vector<std::vector<int>> children(s.nodes.size());
    for (std::size_t p = 1; p < s.nodes.size(); ++p) children[std::size_t(s.nodes[p].parent)].push_back(int(p));
    std::vector<int> cell_of(s.nodes.size(), -1);
    for (std::size_t c = 0; c < s.node_of.size(); ++c) cell_of[std::size_t(s.node_of[c])] = int(c);
    Plot plot = panel();
    plot.equal_units = false;
    double column = 0, max_depth = 0;
    std::vector<Vec2> leaves;
    std::vector<DensityClass> of_leaf;
    const std::function<Vec2(int, double)> place = [&](int p, double depth) -> Vec2 {
        max_depth = std::max(max_depth, depth);
        if (children[std::size_t(p)].empty()) {
            leaves.push_back({column++, -depth});
            of_leaf.push_back(classes[std::size_t(cell_of[std::size_t(p)])]);
            return leaves.back();
        }
        std::vector<Vec2> below;
        const bool real = children[std::size_t(p)].size() > 1;
        for (const int child : children[std::size_t(p)]) below.push_back(place(child, depth + (real ? 1 : 0)));
        if (!real) return below[0];
        const Vec2 here(0.5 * (below.front().x + below.back().x), -depth);
        for (const Vec2 b : below) plot.curves.push_back({.points = {here, b}, .color = house::grey, .width = 1});
        return here;
    };
    place(0, 0);
    for (std::size_t k = 0; k < leaves.size(); ++k) {
        Curve dot{.points = {}, .color = color_of(of_leaf[k]), .kind = Curve::Kind::fill, .width = 0.7};
        for (const Vec2 p : circle({0, 0}, 1, 24))
            dot.points.push_back(leaves[k] + p * Vec2(0.42, 0.42 * max_depth / double(leaves.size()) * 1.2));
        plot.curves.push_back(dot);
    }
    plot.x_range = Vec2(-1, column);
    plot.y_range = Vec2(-max_depth - 0.7, 0.5);
    return plot;
}

void make(FigureContext& context) {
    context.columns(4);
    const SolidTree solid = flatten(Solid::rounded(r, whole.density() - hole.density()));
    const DensityTree& density = solid.leaves.at(0).density;
    const Lines borders = level_lines([&](Vec2 x) { return density.at(Vec3(x.x, x.y, 0)); }, 0.5, lo, hi, 290, 240);
    const Subdivision subdivision(solid, {{lo.x, lo.y, -0.5}, {hi.x, hi.y, 0.5}});
    const std::vector<DensityClass> classes = classes_of(subdivision, density);
    context.plot(object_within(borders), "(a) the smoothed object");
    context.plot(definition(), "(b) its definition");
    context.plot(density_of(whole), "(c) the density of A");
    context.plot(planes_of_both(), "(d) planes of A (blue) and B (red), dashed at ±r");
    context.plot(regions_of(whole), "(e) A's regions");
    context.plot(regions_of(hole), "(e) B's regions");
    context.plot(subdivision_of(subdivision, classes, borders), "(f) Deburr's subdivision");
    context.plot(tree_of(subdivision, classes), "(g) its BSP tree");
    const auto count = [&](DensityClass c) { return std::count(classes.begin(), classes.end(), c); };
    context.measured(
        fmt::format("{} cells: {} unclassified, {} high, {} one, {} low, {} zero. Cells are not cut further once they "
                    "are decided, so there are fewer than all planes would make.",
                    classes.size(), count(DensityClass::unclassified), count(DensityClass::high),
                    count(DensityClass::one), count(DensityClass::low), count(DensityClass::zero)));
}

const RegisteredFigure registered{{
    .name = "triage-8",
    .title = "Figure 8: from a CSG object to a classified density field",
    .shows = "White: zero; pale blue: low; yellow: unclassified; light and dark red: high and one.",
    .claim = "The planes of every primitive, displaced by the radius, partition its density field; the BSP tree "
             "classifies that of the object (§4.2.3, §4.2.4).",
    .plots = true,
    .seconds = 3,
    .make = make,
}};

}  // namespace
}  // namespace deburr
