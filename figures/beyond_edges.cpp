// The greatest distances between quasi-convolution, true convolution and a fillet, as functions of the dihedral angle.
#include "bounds/rounded_edge.hpp"
#include "figures/figure.hpp"
#include "figures/plot.hpp"

namespace deburr {
namespace {

// Values of the curves for the measured sentences, in filter radii.
struct Summary {
    double towards_180 = 0;             // quasi-convolution to true convolution, near 180°
    double max_fillet = 0;              // true convolution to fillet, the greatest one from 60° on
    double nearest = infinity, at = 0;  // the least one of quasi- to true convolution, and its angle in degrees
};

Plot over_angles(Summary& summary) {
    Plot plot;
    plot.width = 760;
    plot.height = 420;
    plot.x_label = "dihedral angle, degrees";
    plot.y_label = "greatest distance, filter radii";
    plot.x_range = Vec2(0, 180);
    plot.y_range = Vec2(0, 0.5);
    plot.x_ticks = {0, 30, 60, 90, 120, 135, 150, 180};
    plot.legend = "top center";
    Curve qt{.title = "quasi-convolution – true convolution", .color = house::blue, .width = 2.6};
    Curve tf{.title = "true convolution – fillet", .color = house::red, .dash = "-"};
    Curve qf{.title = "quasi-convolution – fillet", .color = house::grey, .dash = "."};
    for (double degrees = 12; degrees < 180; degrees += degrees < 172 ? 2 : 0.5) {
        const EdgeDistances a = distances(RoundedEdge(glm::radians(degrees)));
        qt.points.push_back({degrees, a.quasi_exact});
        tf.points.push_back({degrees, a.exact_fillet});
        qf.points.push_back({degrees, a.quasi_fillet});
        summary.towards_180 = a.quasi_exact;
        if (degrees >= 60) summary.max_fillet = std::max(summary.max_fillet, a.exact_fillet);
        if (a.quasi_exact < summary.nearest) {
            summary.nearest = a.quasi_exact;
            summary.at = degrees;
        }
    }
    plot.curves = {qf, tf, qt};
    return plot;
}

void make(FigureContext& context) {
    Summary found;
    context.plot(over_angles(found));
    context.measured(
        fmt::format("Quasi-convolution is nearest to the truth at about {:g}°: {:.3f} r. Towards 180° it lies {:.2f} r "
                    "inside. The true "
                    "convolution is never more than {:.3f} r from the fillet from 60° on.",
                    found.at, found.nearest, found.towards_180, found.max_fillet));
}

const RegisteredFigure registered{{
    .name = "beyond-edges",
    .title = "The distance between quasi-convolution and the truth over the dihedral angle",
    .shows = "The greatest distance between the surfaces that quasi-convolution, true convolution and a cylindrical "
             "fillet make of one "
             "edge, over its angle.",
    .claim = "The approximate isosurface should be fairly close to the true convolution around square edges; in the "
             "limit of a pair of identical "
             "half-spaces it is about a quarter of the radius inside (Lobb §2.3.1).",
    .plots = true,
    .seconds = 3,
    .make = make,
}};

}  // namespace
}  // namespace deburr
