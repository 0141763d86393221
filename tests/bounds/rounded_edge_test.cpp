// The rounded edge of a wedge by quasi-convolution, true convolution and a fillet, against Lobb's figure 5 and §2.3.1.
#include "bounds/rounded_edge.hpp"

#include "catch.hpp"

using namespace deburr;

namespace {

double quasi_exact(double degrees, int steps = 200) {
    const RoundedEdge edge(degrees * pi / 180);
    return distance_between([&](double x) { return edge.quasi(x); }, [&](double x) { return edge.exact(x); },
                            edge.width(), steps);
}

double exact_fillet(double degrees) {
    const RoundedEdge edge(degrees * pi / 180);
    return distance_between([&](double x) { return edge.exact(x); }, [&](double x) { return edge.fillet(x); },
                            edge.width(), 200);
}

}  // namespace

TEST_CASE("Lobb figure 5: where the three curves leave the planes") {
    for (const double degrees : {20.0, 30.0, 60.0, 90.0, 100.0, 135.0, 160.0}) {
        CAPTURE(degrees);
        const RoundedEdge edge(degrees * pi / 180);
        const double s = std::sin(degrees * pi / 360);
        const auto off = [&](auto curve, double along) { return edge.plane(along * s) - (edge.*curve)(along * s); };
        CHECK(off(&RoundedEdge::quasi, edge.quasi_reach() * 1.001) == Approx(0).margin(1e-12));
        CHECK(off(&RoundedEdge::quasi, edge.quasi_reach() * 0.97) > 1e-12);
        CHECK(off(&RoundedEdge::exact, edge.exact_reach() * 1.001) == Approx(0).margin(1e-12));
        CHECK(off(&RoundedEdge::exact, edge.exact_reach() * 0.97) > 1e-9);
        // The fillet touches the plane where the true convolution leaves it.
        const double x = edge.exact_reach() * s, h = 1e-6;
        CHECK(edge.fillet(x - h) == Approx(edge.plane(x - h)).margin(1e-9));
    }
}

TEST_CASE("Lobb 2.3.1: how far quasi-convolution, true convolution and the fillet are apart") {
    // Lobb: "All three methods are virtually equivalent for right-angled edges."
    CHECK(quasi_exact(90) < 0.01);
    CHECK(exact_fillet(90) < 0.005);
    // Lobb: "Virtually indistinguishable from the cylindrical fillet for the 90° and 135° cases."
    CHECK(exact_fillet(135) < 0.025);
    CHECK(exact_fillet(30) > 0.1);
    // Lobb: "In the limit ... inside the planes by about one quarter of the filter radius."
    CHECK(quasi_exact(179.5) == Approx(-displacement(std::sqrt(0.5))).epsilon(0.01));
    // The curves are nearest to each other at right angles and move apart from there on.
    double last = quasi_exact(92);
    for (const double degrees : {100.0, 120.0, 140.0, 160.0, 175.0}) {
        const double here = quasi_exact(degrees);
        CHECK(here > last);
        last = here;
    }
    last = quasi_exact(88);
    for (const double degrees : {80.0, 60.0, 40.0, 20.0}) {
        const double here = quasi_exact(degrees);
        CHECK(here > last);
        last = here;
    }
}

TEST_CASE("Lobb figure 5: at an acute edge quasi-convolution is pointier than truth, and truth than the fillet") {
    for (const double degrees : {20.0, 30.0, 45.0}) {
        const RoundedEdge edge(degrees * pi / 180);
        CHECK(edge.quasi(0) > edge.exact(0));
        CHECK(edge.exact(0) > edge.fillet(0));
    }
}

TEST_CASE("the distance between circles about one centre is that of their radii") {
    const auto circle = [](double r) { return [r](double x) { return std::sqrt(r * r - x * x); }; };
    CHECK(distance_between(circle(2), circle(1.7), 0.8, 800) == Approx(0.3).epsilon(1e-4));
}
