#include "raytracer/box_tree.hpp"

#include <set>

#include "catch.hpp"
#include "random_case.hpp"

using namespace deburr;

TEST_CASE("every box that a ray touches is visited, wherever the boxes are and however large") {
    long touched = 0, visited = 0;
    for (auto seed : seeds(300)) {
        CAPTURE(seed);
        Gen g(seed);
        const double size = std::pow(10.0, g.between(-30, 30));
        const Vec3 away = g.chance(0.5) ? Vec3(0) : g.point(1e6) * size;
        std::vector<Box> boxes;
        BoxTree::Builder builder;
        int root = BoxTree::Builder::nothing;
        const int count = 1 + g.below(60);
        for (int i = 0; i < count; ++i) {
            Vec3 half(g.number(), g.number(), g.number());
            half *= 0.2;
            if (g.chance(0.3)) half[g.below(3)] = 0;  // flat
            const Vec3 middle = g.point(1);
            boxes.push_back({away + (middle - half) * size, away + (middle + half) * size});
            root = builder.join(root, builder.item(std::uint32_t(i), boxes.back()));
        }
        const BoxTree tree(builder, root);
        for (int k = 0; k < 40; ++k) {
            const Box& aim = boxes[std::size_t(g.below(count))];
            // At corners and edges as often as elsewhere; along axes, too.
            Vec3 target;
            for (int axis = 0; axis < 3; ++axis) {
                const double s = g.chance(0.5) ? g.number() : g.below(2);
                target[axis] = aim.lo[axis] + s * (aim.hi[axis] - aim.lo[axis]);
            }
            Vec3 d = g.direction();
            if (g.chance(0.3)) {
                d = Vec3(0);
                d[g.below(3)] = g.chance(0.5) ? 1 : -1;
            }
            const Vec3 o = target - d * (size * std::pow(10.0, g.between(-2, 3)));
            const BoxSpan whole = span_in(tree.box(), o, reciprocal(d), 0, infinity);
            if (whole.lo > whole.hi) continue;
            std::set<std::uint32_t> seen;
            tree.visit(o, d, reciprocal(d), whole.lo, whole.hi, [&](std::uint32_t i) {
                REQUIRE(seen.insert(i).second);
                return infinity;
            });
            for (std::size_t i = 0; i < boxes.size(); ++i) {
                const BoxSpan span = span_in(boxes[i], o, reciprocal(d), 0, infinity);
                if (span.lo > span.hi) continue;
                ++touched;
                REQUIRE(seen.count(std::uint32_t(i)) == 1);
            }
            visited += long(seen.size());
        }
    }
    CHECK(touched > 8'000);
    CHECK(visited < 1.3 * double(touched));
}

namespace {

int balanced(BoxTree::Builder& builder, int first, int last) {
    if (last - first == 1)
        return builder.item(std::uint32_t(first), {Vec3(2 * first, 0, 0), Vec3(2 * first + 1, 1, 1)});
    const int middle = first + (last - first) / 2;
    const int a = balanced(builder, first, middle), b = balanced(builder, middle, last);
    return builder.join(b, a);
}

}  // namespace

TEST_CASE("boxes come nearest first, and none beyond the distance that is asked for") {
    BoxTree::Builder builder;
    const int root = balanced(builder, 0, 1'000);
    const BoxTree tree(builder, root);
    for (const bool forward : {true, false}) {
        const Vec3 d = glm::normalize(Vec3(forward ? 1 : -1, 1e-5, 0)), o(forward ? -1 : 2'000, 0.5, 0.5);
        std::vector<std::uint32_t> order;
        tree.visit(o, d, reciprocal(d), 1, 2'000, [&](std::uint32_t i) {
            order.push_back(i);
            return order.size() < 5 ? infinity : 20.0;
        });
        CHECK(order.size() == 10);
        for (std::size_t i = 0; i < order.size(); ++i) CHECK(order[i] == (forward ? i : 999 - i));
    }
}
