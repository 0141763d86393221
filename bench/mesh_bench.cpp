// The cost of meshing: triage against a grid of half the radius [Triage §6.2], and its growth with the number of
// half-spaces [Triage §6.3].
#include <fmt/format.h>

#include <cmath>

#include "bench/flying_edges.hpp"
#include "bench/sections.hpp"
#include "bounds/solid_tree.hpp"
#include "polygonizer/mesh/metrics.hpp"
#include "polygonizer/triage/triage.hpp"

namespace deburr::bench {
namespace {

SolidTree obj4(double r) {
    return flatten(
        Solid::rounded(r, Density::box(Vec3(0.0), Vec3(1.0)) -
                              Density::half_space({0, 1, 0}, 1) * Density::box({0.25, 0.8, 0.25}, {0.75, 1.8, 0.75})));
}

// Boxes of six half-spaces each on a cubic grid, as one Boolean density.
SolidTree boxes(int count) {
    const int side = int(std::ceil(std::cbrt(count) - 1e-9));
    std::vector<Density> row;
    for (int k = 0; k < count; ++k) {
        const Vec3 lo(2.0 * (k % side), 2.0 * (k / side % side), 2.0 * (k / side / side));
        row.push_back(Density::box(lo, lo + Vec3(1.0)));
    }
    Density all = row[0];
    for (int k = 1; k < count; ++k) all = all | row[k];
    return flatten(Solid::rounded(0.05, all));
}

// A single mesh of 2 ms between two runs of Flying Edges would mainly measure the caches that these leave.
constexpr int meshes_in_turn = 16;

// Limits at the two radii of the paper's comparison.
struct Bars {
    std::optional<Bar> triangles, time, distance;
};

Bars bars_at(double r) {
    if (r == 0.05) return {at_most(1.5), at_least(1), at_most(1)};
    if (r == 0.01) return {at_most(0.1), at_least(100), at_most(1)};
    return {};
}

}  // namespace

void triage_against_flying_edges(Report& report) {
    if (!FlyingEdges::installed()) {
        report.note("VTK is not installed: left out");
        return;
    }
    for (const double r : {0.2, 0.1, 0.05, 0.02, 0.01, 0.005}) {
        const SolidTree tree = obj4(r);
        const Box box = polygonization_box(tree);
        FlyingEdges theirs;
        Mesh ours;
        const Ratio time =
            ratio_of_times([&] { return cpu_seconds_of([&] { theirs.run(tree.leaves[0].density, box, r / 2); }); },
                           [&] {
                               return cpu_seconds_of([&] {
                                          for (int k = 0; k < meshes_in_turn; ++k) ours = triage(tree, box);
                                      }) /
                                      meshes_in_turn;
                           },
                           r < 0.01 ? 3 : 7);
        const Bars bars = bars_at(r);
        report.figure(fmt::format("obj4, r = {}: triangles, of flying edges'", r),
                      100 * double(ours.triangles.size()) / double(theirs.triangles()), "%", bars.triangles);
        report.ratio(fmt::format("obj4, r = {}: time of flying edges / triage", r), time, bars.time);
        report.point("time of flying edges", "radius", "seconds", r, time.a);
        report.point("time of triage", "radius", "seconds", r, time.b);
        report.point("triangles of flying edges", "radius", "triangles", r, double(theirs.triangles()));
        report.point("triangles of triage", "radius", "triangles", r, double(ours.triangles.size()));
        if (r < 0.01) continue;  // too slow with two million root searches
        const double our_distance = measure(ours, tree).distance.max / r;
        const double their_distance = measure(theirs.mesh(), tree).distance.max / r;
        report.figure(fmt::format("obj4, r = {}: greatest distance of triage", r), our_distance, "r");
        report.figure(fmt::format("obj4, r = {}: the same of flying edges", r), their_distance, "r");
        report.figure(fmt::format("obj4, r = {}: triage's distance / flying edges'", r), our_distance / their_distance,
                      "", bars.distance);
    }
}

void growth_of_triage(Report& report) {
    // Least squares in logarithms: time ~ n^exponent.
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const int count : {6, 60, 600, 6000}) {
        const SolidTree tree = boxes(count / 6);
        const Box box = polygonization_box(tree);
        const double seconds = seconds_of([&] { keep(triage(tree, box).triangles.size()); }, count < 1000 ? 9 : 3);
        report.figure(fmt::format("{} half-spaces", count), 1e3 * seconds, "ms");
        report.point("triage of half-spaces", "half-spaces", "ms", count, 1e3 * seconds);
        const double x = std::log(count), y = std::log(seconds);
        n += 1;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    // n log n from 6 to 6,000 has a mean exponent of 1 + log(log 6000 / log 6) / log 1000 = 1.23.
    report.figure("exponent of growth", (n * sxy - sx * sy) / (n * sxx - sx * sx), "(paper: 1.3)", at_most(1.23));
}

}  // namespace deburr::bench
