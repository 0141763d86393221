// Progress of meshing, as WorkProgress reports it.
#include "polygonizer/mesh/work_progress.hpp"

#include <vector>

#include "catch.hpp"
#include "polygonizer/marching_cubes/marching_cubes.hpp"
#include "polygonizer/octree/octree.hpp"
#include "polygonizer/triage/triage.hpp"

using namespace deburr;

namespace {

// Records the shares of the work that `progress` reports, one by one.
struct Told {
    std::vector<double> shares;
    WorkProgress progress{[this](double share) { shares.push_back(share); }};
    double sum() const {
        double all = 0;
        for (const double s : shares) all += s;
        return all;
    }
};

}  // namespace

TEST_CASE("phases take shares of what is left, and nothing is told twice") {
    Told told;
    told.progress.begin(0.5);
    told.progress.advance(0.5);
    CHECK(told.sum() == Approx(0.25));
    told.progress.advance(3);  // counts only up to the end of the phase
    CHECK(told.sum() == Approx(0.5));
    told.progress.begin(0.2);
    told.progress.begin(0.5);  // ends the phase before, which counts whole
    CHECK(told.sum() == Approx(0.6));
    told.progress.finish();
    told.progress.finish();
    CHECK(told.sum() == Approx(1));
    for (const double s : told.shares) CHECK(s > 0);
}

TEST_CASE("every method tells how far one solid is, and leaves the end to its caller") {
    Density plate = Density::box({0, 0, 0}, {5, 0.3, 5});
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 5; ++k) plate = plate & ~Density::box({i + 0.3, -1, k + 0.2}, {i + 0.7, 1, k + 0.8});
    const SolidTree tree = flatten(Solid::rounded(0.05, plate));
    const Box box = polygonization_box(tree);
    const auto check = [](const Told& told) {
        CHECK(told.shares.size() > 20);
        CHECK(told.sum() > 0.4);
        CHECK(told.sum() < 1);
        for (const double s : told.shares) CHECK(s < 0.3);
    };
    Told by_triage, by_octree, by_cubes;
    triage(tree, box, {.tolerance = 0.0025, .progress = &by_triage.progress});
    check(by_triage);
    octree(tree, box, {.edge = 0.1, .progress = &by_octree.progress});
    check(by_octree);
    marching_cubes(tree, box, 0.05, nullptr, &by_cubes.progress);
    check(by_cubes);
}
