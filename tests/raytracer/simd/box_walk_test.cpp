// Vectorized traversal of box trees by rays and beams, for every instruction set.
#include <limits>
#include <optional>
#include <set>

#include "catch.hpp"
#include "random_case.hpp"
#include "raytracer/accel/bvh.hpp"
#include "raytracer/simd/packet_kernels.hpp"

using namespace deburr;

namespace {

// A random tree of nested boxes; some slots are empty.
struct RandomBoxes {
    std::vector<BoxNode> nodes;
    std::uint32_t items = 0;

    explicit RandomBoxes(Gen& g) { add(g, Vec3(0.0), 1, 2); }
    BoxTree tree() const {
        BoxTree tree;
        tree.nodes = nodes.data();
        return tree;
    }

    // Collects the items below the node whose boxes the ray meets if nothing shortens it.
    void met(const BoxRay& ray, std::size_t node, std::set<std::uint32_t>& seen) const {
        const BoxNode& n = nodes[node];
        for (int i = 0; i < BoxNode::width; ++i) {
            float lo = 0, hi = ray.end;
            for (int k = 0; k < 3; ++k) {
                const float a = (n.side[k][i] - ray.origin[k]) * ray.inverse[k],
                            b = (n.side[k][i + BoxNode::width] - ray.origin[k]) * ray.inverse[k];
                lo = std::max(lo, ray.inverse[k] < 0 ? b : a);
                hi = std::min(hi, ray.inverse[k] < 0 ? a : b);
            }
            if (!(lo <= hi)) continue;
            if (n.child[i] < 0)
                seen.insert(std::uint32_t(~n.child[i]));
            else
                met(ray, std::size_t(n.child[i]), seen);
        }
    }

private:
    std::int32_t add(Gen& g, Vec3 middle, double half, int levels) {
        const auto number = nodes.size();
        nodes.emplace_back();
        for (int i = 0; i < BoxNode::width; ++i) {
            const bool empty = g.chance(0.2);
            const Vec3 at = middle + g.point(half);
            const double size = half * g.between(0.2, 0.8);
            for (int k = 0; k < 3; ++k) {
                constexpr float most = std::numeric_limits<float>::max();
                nodes[number].side[k][i] = empty ? most : float(at[k] - size);
                nodes[number].side[k][i + BoxNode::width] = empty ? -most : float(at[k] + size);
            }
            const std::int32_t child =
                !empty && levels > 0 && g.chance(0.6) ? add(g, at, size, levels - 1) : ~std::int32_t(items++);
            nodes[number].child[i] = child;
        }
        return std::int32_t(number);
    }
};

// Records the visited items in order, with the ray's end at each; some visits shorten the ray.
struct Visits {
    std::vector<std::pair<std::uint32_t, float>> all;
    float shorten = 1;

    BoxVisitor visitor() {
        return {[](void* context, std::uint32_t item, float end) {
                    Visits& self = *static_cast<Visits*>(context);
                    self.all.emplace_back(item, end);
                    return item % 7 == 3 ? end * self.shorten : end;
                },
                this};
    }
};

float inverse_of(double x) { return float(std::abs(x) > 1e-30 ? 1 / x : 1e30); }

}  // namespace

TEST_CASE(
    "a ray, or several, meet the same boxes in the same order with any instructions, and those that they should") {
    constexpr double slack = 1e-5;  // more than the rounding error of single precision here
    long met = 0, in_beams = 0;
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const RandomBoxes boxes(g);
        const Vec3 o = g.point(2);
        const Vec3 d = g.chance(0.2) ? Vec3(0, -1, 0) : g.chance(0.5) ? glm::normalize(-o) : g.normal();
        BoxRay ray;
        BoxBeam beam;
        ray.end = beam.end = float(g.between(0.5, 6));
        for (int k = 0; k < 3; ++k) {
            ray.origin[k] = float(o[k]);
            ray.inverse[k] = inverse_of(d[k]);
            const double wide = 0.05 * g.number(), near = o[k] - 0.1 * g.number(), far = o[k] + 0.1 * g.number();
            const double least = d[k] - wide, most = d[k] + wide;
            const bool down = most < 0;
            if (least > 0 || down)
                beam.directed[beam.directed_axes++] = {
                    k, down, float(down ? near : far), float(down ? far : near), inverse_of(most), inverse_of(least)};
            else
                beam.undirected[beam.undirected_axes++] = {k, float(near + least * beam.end - slack),
                                                           float(far + most * beam.end + slack)};
        }
        std::set<std::uint32_t> expected;
        boxes.met(ray, 0, expected);
        met += long(expected.size());
        for (const float shorten : {1.0f, 0.6f, -1.0f}) {
            CAPTURE(shorten);
            std::optional<Visits> first, first_of_beam;
            for (const auto& [name, functions] : packet_instructions()) {
                CAPTURE(name);
                Visits visits{{}, shorten}, of_beam{{}, shorten};
                functions->walk_ray(boxes.tree(), ray, visits.visitor());
                functions->walk_beam(boxes.tree(), beam, of_beam.visitor());
                if (!first) {
                    first = visits;
                    first_of_beam = of_beam;
                }
                REQUIRE(visits.all == first->all);
                REQUIRE(of_beam.all == first_of_beam->all);
                if (shorten != 1) continue;
                REQUIRE(visits.all.size() == expected.size());
                std::set<std::uint32_t> by_beam;
                for (const auto& [item, end] : visits.all) REQUIRE(expected.count(item) == 1);
                for (const auto& [item, end] : of_beam.all) by_beam.insert(item);
                for (const std::uint32_t item : expected) REQUIRE(by_beam.count(item) == 1);
                in_beams += long(by_beam.size());
            }
        }
    }
    CHECK(met > 3'000);
    CHECK(in_beams > met);
}
