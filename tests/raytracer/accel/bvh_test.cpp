// Both bounding volume hierarchies, Deburr's Bvh8 and Embree's, on random boxes and rays.
#include "raytracer/accel/bvh.hpp"

#include <set>

#include "catch.hpp"
#include "random_case.hpp"
#include "raytracer/accel/embree_bvh.hpp"

using namespace deburr;

namespace {

// Indices of the boxes that the ray visits if its end is `until`.
std::set<std::uint32_t> visited_by(const Bvh8& tree, Vec3 o, Vec3 d, BoxSpan whole, double until) {
    std::set<std::uint32_t> seen;
    tree.visit(o, d, reciprocal(d), whole.lo, whole.hi, [&](std::uint32_t i) {
        REQUIRE(seen.insert(i).second);
        return until;
    });
    return seen;
}

std::set<std::uint32_t> visited_by(const EmbreeBvh& boxes, Vec3 o, Vec3 d, BoxSpan whole, double until,
                                   EmbreeBvh::Order order) {
    std::set<std::uint32_t> seen;
    boxes.visit(o, d, whole.lo, whole.hi, order, [&](std::uint32_t i) {
        REQUIRE(seen.insert(i).second);
        return until;
    });
    return seen;
}

// A direction parallel to an axis, nearly parallel to one, or arbitrary.
Vec3 awkward_direction(Gen& g) {
    Vec3 d = g.direction();
    if (g.chance(0.5)) return d;
    const double off = g.chance(0.5) ? 0 : std::pow(10.0, g.between(-40, -5));
    const int axis = g.below(3);
    for (int k = 0; k < 3; ++k) d[k] *= k == axis ? 1 : off;
    return glm::normalize(d);
}

}  // namespace

TEST_CASE("every box that a ray touches is visited, by either hierarchy, wherever the boxes are and however large") {
    long touched = 0, visited = 0, visited_by_embree = 0;
    for (auto seed : seeds(400)) {
        CAPTURE(seed);
        Gen g(seed);
        const double size = std::pow(10.0, g.between(-30, 30));
        const Vec3 away = g.chance(0.5) ? Vec3(0) : g.point(1e6) * size;
        std::vector<NumberedBox> boxes;
        Bvh8::Builder builder;
        int root = Bvh8::Builder::nothing;
        const int count = 1 + g.below(60);
        const bool grid = g.chance(0.3);  // so that faces coincide
        for (int i = 0; i < count; ++i) {
            Vec3 half(g.number(), g.number(), g.number());
            half *= 0.2;
            if (g.chance(0.3)) half[g.below(3)] = 0;  // a flat box
            if (grid) half = Vec3(0.125);
            const Vec3 middle = grid ? 0.25 * glm::round(4.0 * g.point(1)) : g.point(1);
            boxes.push_back({std::uint32_t(i), {away + (middle - half) * size, away + (middle + half) * size}});
            root = builder.join(root, builder.item(std::uint32_t(i), boxes.back().box));
        }
        const Bvh8 tree(builder, root);
        const EmbreeBvh embree(boxes);
        for (int k = 0; k < 40; ++k) {
            const Box& aim = boxes[g.below(count)].box;
            // The target is on a box's sides, edges and corners as often as inside it.
            Vec3 target;
            for (int axis = 0; axis < 3; ++axis) {
                const double s = g.chance(0.5) ? g.number() : g.below(2);
                target[axis] = aim.lo[axis] + s * (aim.hi[axis] - aim.lo[axis]);
            }
            const Vec3 d = awkward_direction(g);
            const Vec3 o = target - d * (size * std::pow(10.0, g.between(-2, g.chance(0.2) ? 6 : 3)));
            const BoxSpan whole = span_in(tree.box(), o, reciprocal(d), 0, infinity);
            if (whole.lo > whole.hi) continue;
            std::vector<double> entered;
            for (const NumberedBox& box : boxes) {
                const BoxSpan span = span_in(box.box, o, reciprocal(d), 0, infinity);
                entered.push_back(span.lo <= span.hi ? span.lo : infinity);
            }
            // The ray ends at infinity, or where it enters a random box.
            const double begins = entered[g.below(count)];
            for (const double until : {infinity, begins}) {
                const auto seen = visited_by(tree, o, d, whole, until);
                const auto by_embree = visited_by(embree, o, d, whole, until, EmbreeBvh::Order::nearest_first);
                const auto in_any_order = visited_by(embree, o, d, whole, until, EmbreeBvh::Order::any);
                for (std::size_t i = 0; i < boxes.size(); ++i) {
                    if (!(entered[i] < infinity && entered[i] <= until)) continue;
                    touched += until == infinity;
                    REQUIRE(seen.count(std::uint32_t(i)) == 1);
                    REQUIRE(by_embree.count(std::uint32_t(i)) == 1);
                    REQUIRE(in_any_order.count(std::uint32_t(i)) == 1);
                }
                visited += until == infinity ? long(seen.size()) : 0;
                visited_by_embree += until == infinity ? long(by_embree.size()) : 0;
            }
        }
    }
    CHECK(touched > 20'000);
    CHECK(visited < 1.5 * double(touched));
    CHECK(visited_by_embree < 1.5 * double(touched));
}

namespace {

int balanced(Bvh8::Builder& builder, int first, int last) {
    if (last - first == 1)
        return builder.item(std::uint32_t(first), {Vec3(2 * first, 0, 0), Vec3(2 * first + 1, 1, 1)});
    const int middle = first + (last - first) / 2;
    const int a = balanced(builder, first, middle), b = balanced(builder, middle, last);
    return builder.join(b, a);
}

}  // namespace

TEST_CASE("boxes come nearest first, and none beyond the distance that is asked for") {
    Bvh8::Builder builder;
    const int root = balanced(builder, 0, 1'000);
    const Bvh8 tree(builder, root);
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

TEST_CASE("what one of several rays touches, they meet together") {
    long alone = 0, together = 0, across = 0;
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const double size = std::pow(10.0, g.between(-30, 30));
        Bvh8::Builder builder;
        int root = Bvh8::Builder::nothing;
        std::vector<Box> boxes;
        for (int i = 0, count = 1 + g.below(60); i < count; ++i) {
            const Vec3 half = 0.2 * Vec3(g.number(), g.number(), g.number()), middle = g.point(1);
            boxes.push_back({(middle - half) * size, (middle + half) * size});
            root = builder.join(root, builder.item(std::uint32_t(i), boxes.back()));
        }
        const Bvh8 tree(builder, root);
        // The rays form a beam or go in all directions.
        const double apart = g.chance(0.2) ? 3 : std::pow(10.0, g.between(-12, -1));
        const Vec3 middle = awkward_direction(g), from = g.point(0.5) - middle * g.between(0, 4);
        std::set<std::uint32_t> any;
        Bvh8::Beam beam{Vec3(infinity), Vec3(-infinity), Vec3(infinity), Vec3(-infinity), 0};
        for (int k = 2 + g.below(15); k > 0; --k) {
            const Vec3 d = g.chance(0.2) ? middle : glm::normalize(middle + g.point(apart)), inverse = reciprocal(d);
            const Vec3 o = (g.chance(0.5) ? from : from + g.point(apart)) * size;
            const BoxSpan whole = span_in(tree.box(), o, inverse, 0, infinity);
            if (whole.lo > whole.hi) continue;
            const Vec3 point = o + d * whole.lo;
            beam.min_point = glm::min(beam.min_point, point);
            beam.max_point = glm::max(beam.max_point, point);
            beam.min_direction = glm::min(beam.min_direction, d);
            beam.max_direction = glm::max(beam.max_direction, d);
            beam.longest = std::max(beam.longest, whole.hi - whole.lo);
            for (const std::uint32_t i : visited_by(tree, o, d, whole, infinity)) {
                const BoxSpan span = span_in(boxes[i], o, inverse, 0, infinity);
                if (span.lo <= span.hi) any.insert(i);
            }
        }
        if (any.empty()) continue;
        bool all_across = true;
        for (int k = 0; k < 3; ++k) all_across &= beam.min_direction[k] < 0 && beam.max_direction[k] > 0;
        across += all_across;
        std::set<std::uint32_t> seen;
        tree.visit_packet(beam, [&](std::uint32_t i) {
            REQUIRE(seen.insert(i).second);
            return infinity;
        });
        for (const std::uint32_t i : any) REQUIRE(seen.count(i) == 1);
        if (apart < 1e-3) {
            alone += long(any.size());
            together += long(seen.size());
        }
    }
    CHECK(across > 20);
    CHECK(alone > 400);
    CHECK(together < 1.2 * double(alone));
}
