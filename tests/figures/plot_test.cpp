// Plots: the data for gnuplot, and the pictures that it draws.
#include "figures/plot.hpp"

#include <cstdlib>
#include <limits>

#include "catch.hpp"
#include "raytracer/util/errors.hpp"

using namespace deburr;

namespace {

Plot everything() {
    Plot plot;
    plot.width = 300;
    plot.height = 200;
    plot.x_label = "it's {/:Italic α}";
    const double nan = std::numeric_limits<double>::quiet_NaN();
    plot.curves = {{.points = {{0, 0}, {1, 1}, {nan, nan}, {2, 0.25}}, .title = "density", .dash = "-"},
                   {.points = circle({1, 0.5}, 0.25), .kind = Curve::Kind::fill, .opacity = 0.5}};
    plot.labels = {{.at = {1, 0.5}, .text = "h_{−r}"}};
    plot.arrows = {{.from = {0, 0}, .to = {1, 0.5}}};
    plot.field = PlotField{
        .lo = {0, 0}, .hi = {2, 1}, .columns = 2, .rows = 2, .values = {0, 1, 1, 0}, .label = "ρ", .contours = {0.5}};
    return plot;
}

bool have_gnuplot() { return std::system("command -v gnuplot >/dev/null 2>&1") == 0; }

}  // namespace

TEST_CASE("A plot's points reach gnuplot with all their digits, and a NaN breaks the line") {
    const std::string script = gnuplot_script(everything());
    CHECK(script.find("$c0 << EOD\n0 0\n1 1\n\n2 0.25\nEOD\n") != std::string::npos);
    CHECK(script.find("0.5 0.25 0\n1.5 0.25 1\n\n0.5 0.75 1\n1.5 0.75 0\n") != std::string::npos);
    CHECK(script.find("set xlabel 'it''s {/:Italic α}'") != std::string::npos);
    CHECK(script.find("title 'density'") != std::string::npos);
}

TEST_CASE("A plot is drawn as SVG and as a PNG of twice its size, the same every time") {
    if (!have_gnuplot()) {
        WARN("gnuplot is not installed");
        return;
    }
    const PlotImages images = draw(everything());
    CHECK(images.svg.find("<svg") != std::string::npos);
    CHECK(images.svg.find("density") != std::string::npos);
    REQUIRE(images.png.size() > 24);
    CHECK(images.png.substr(1, 3) == "PNG");
    const auto big_endian = [&](std::size_t at) {
        int n = 0;
        for (std::size_t k = 0; k < 4; ++k) n = 256 * n + static_cast<unsigned char>(images.png[at + k]);
        return n;
    };
    CHECK(big_endian(16) == 600);
    CHECK(big_endian(20) == 400);
    CHECK(draw(everything()).png == images.png);
}

TEST_CASE("What gnuplot objects to is told") {
    if (!have_gnuplot()) return;
    Plot plot = everything();
    plot.legend = "nowhere sensible";
    CHECK_THROWS_AS(draw(plot), WorkError);
}

TEST_CASE("A circle is closed and round") {
    const auto points = circle({1, 2}, 3, 17);
    REQUIRE(points.size() == 18);
    CHECK(points.front() == points.back());
    for (const Vec2& p : points) CHECK(glm::length(p - Vec2(1, 2)) == Approx(3));
}
