#include "bounds/half_edges.hpp"

#include <map>
#include <set>
#include <utility>

#include "catch.hpp"
#include "random_case.hpp"

using namespace deburr;

TEST_CASE("half-edges come edge by edge, each once, with its direction and its triangle") {
    int shared = 0;
    for (auto seed : seeds(200)) {
        CAPTURE(seed);
        Gen g(seed);
        std::vector<std::array<int, 3>> triangles(std::size_t(g.below(30)));
        for (auto& t : triangles)
            for (int& v : t) v = g.below(6);
        std::map<std::pair<int, int>, std::set<std::pair<int, int>>> expected;  // (triangle, k) of each edge
        for (int t = 0; t < int(triangles.size()); ++t)
            for (int k = 0; k < 3; ++k) {
                const auto edge = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
                expected[{edge.first, edge.second}].insert({t, k});
            }
        auto next = expected.begin();
        const std::vector<HalfEdge> sorted = sorted_half_edges(triangles);
        each_edge(sorted, [&](std::span<const HalfEdge> edge) {
            REQUIRE(next != expected.end());
            std::set<std::pair<int, int>> found;
            for (const HalfEdge& e : edge) {
                CHECK(std::pair(e.lo, e.hi) == next->first);
                CHECK(e.up == (triangles[e.triangle][e.k] < triangles[e.triangle][(e.k + 1) % 3]));
                found.insert({e.triangle, e.k});
            }
            CHECK(found == next->second);
            CHECK(found.size() == edge.size());
            shared += edge.size() > 1;
            ++next;
        });
        CHECK(next == expected.end());
    }
    CHECK(shared > 500);
}
