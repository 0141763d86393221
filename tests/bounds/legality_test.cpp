// The search for points where the papers' operators leave [0, 1].
#include "bounds/legality.hpp"

#include "catch.hpp"
#include "plain_definition.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

const Density cube = Density::box(Vec3(0), Vec3(1));
const Density top = Density::half_space({0, 1, 0}, 1);
const Density box1 = Density::box({0.25, 0.8, 0.25}, {0.75, 1.3, 0.75});  // overlaps the cube and sticks out of it
const Density box3 = Density::box({0.25, 1, 0.25}, {0.75, 1.5, 0.75});    // stands on the cube

std::vector<IllegalDensity> check(const Density& d, double r) { return find_illegal(flatten(d, r), 1'000); }

}  // namespace

TEST_CASE("Lobb figure 11: obj4 as printed is illegal, clipped it is legal, and so is obj6") {
    for (const double r : {0.0, 1e-3, 0.07, 0.3}) {
        CAPTURE(r);
        REQUIRE(check(Density::difference(cube, box1, 12), r).size() == 1);
        const IllegalDensity printed = check(Density::difference(cube, box1, 12), r)[0];
        CHECK(printed.op == Op::difference);
        CHECK(printed.line == 12);
        CHECK(printed.value < 0);
        CHECK(printed.point.y > 1 - r);
        CHECK(check(cube - top * box1, r).empty());
        CHECK(check(cube + box3, r).empty());
        CHECK(check(cube & ~box1, r).empty());
        CHECK(check(cube | box1, r).empty());
    }
}

TEST_CASE("parts that overlap by a hundredth are found, whatever the radius") {
    for (const double r : {0.0, 1e-4, 0.01, 0.1, 0.4}) {
        CAPTURE(r);
        const auto found = check(Density::sum(cube, Density::box({0.99, 0, 0}, {2, 1, 1}), 3), r);
        REQUIRE(found.size() == 1);
        CHECK(found[0].line == 3);
        CHECK(found[0].value > 1);
        CHECK(check(cube + Density::box({1, 0, 0}, {2, 1, 1}), r).empty());  // touching boxes are legal
        CHECK(check(cube + Density::box({1.01, 0, 0}, {2, 1, 1}), r).empty());
    }
}

TEST_CASE("what is called illegal is, at the point that is named; what is legal by rule is not") {
    int illegal = 0, legal = 0;
    for (auto seed : seeds(400)) {
        CAPTURE(seed);
        Gen g(seed);
        const double r = g.radius();
        const DensityTree tree = flatten(g.arithmetic(2), r);
        for (const IllegalDensity& d : find_illegal(tree, 400)) {
            ++illegal;
            REQUIRE((d.value > 1 || d.value < 0));
        }
        const Density a = g.box(), b = g.box();
        legal += find_illegal(flatten(a * b, r), 400).empty();
        legal += find_illegal(flatten(a - a * b, r), 400).empty();
    }
    CHECK(illegal > 150);
    CHECK(legal == 800);
}

TEST_CASE("a search costs no more tree nodes than it may, however many operators there are") {
    const auto chain = [](int count, bool one_line) {
        Density d = cube;
        for (int i = 1; i <= count; ++i)
            d = Density::difference(d, Density::box(Vec3(i, 0, 0), Vec3(i + 1, 1, 1)), one_line ? 1 : i);
        return flatten(d, 0.1);
    };
    for (const bool one_line : {false, true}) {
        CAPTURE(one_line);
        const DensityTree tree = chain(2'000, one_line);
        LegalityEffort effort{20'000, 2'000'000};
        const std::vector<IllegalDensity> found = find_illegal(tree, effort);
        REQUIRE(!found.empty());
        for (const IllegalDensity& d : found) CHECK(d.value < -0.5);
        // The last step may exceed the limit, but by no more than its own cost.
        CHECK(effort.nodes > -4 * std::int64_t(tree.nodes.size()));
        // If all operators are on one line, only the whole chain is searched and none of its parts.
        if (one_line) CHECK(effort.nodes > 1'000'000);
    }
}
