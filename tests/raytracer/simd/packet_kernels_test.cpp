#include "raytracer/simd/packet_kernels.hpp"

#include <bit>
#include <functional>
#include <optional>
#include <set>

#include "catch.hpp"
#include "random_case.hpp"
#include "raytracer/accel/bvh.hpp"
#include "round_cell.hpp"

using namespace deburr;

namespace {

constexpr double scale = 3;

double t_tolerance(double t) { return 8 * epsilon * (scale + t); }

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

// Planes that cross near the origin; some through it, some parallel to rays along axes.
struct Factors {
    std::vector<AlphaPlane> planes;
    ConvexView view;

    explicit Factors(Gen& g) {
        const int soft = g.chance(0.8) ? 1 + g.below(3) : g.below(max_packet_factors + 1),
                  sharp = g.chance(0.7) ? 0 : g.below(3);
        for (int i = 0; i < soft + sharp; ++i) {
            const double radius = i < soft ? g.between(0.02, 0.6) : 1.0;
            const Vec3 n = g.normal();
            planes.push_back({n / radius, (g.chance(0.2) ? 0.0 : g.between(-0.6, 0.3)) / radius});
        }
        view = {planes.data(), soft, sharp, g.chance(0.5)};
    }
};

struct Packet {
    RayPacket rays;
    PacketSpans spans;
    Lanes lanes;

    explicit Packet(Gen& g) {
        lanes = Lanes(g.below(1 << RayPacket::size));
        for (int k = 0; k < RayPacket::size; ++k) {
            const Vec3 d = g.normal(), o = g.chance(0.2) ? Vec3(0.0) : g.point(0.5) - d * g.between(0, 2);
            for (int axis = 0; axis < 3; ++axis) {
                rays.origin[axis][k] = o[axis];
                rays.direction[axis][k] = d[axis];
            }
            rays.end[k] = g.chance(0.3) ? infinity : g.between(0, 5);
            spans.from[k] = g.chance(0.5) ? 0 : g.between(0, 1);
            spans.to[k] = spans.from[k] + (g.chance(0.1) ? 0 : g.between(0, 4));
        }
    }
    Vec3 origin(int k) const { return rays.ray(k).origin; }
    Vec3 direction(int k) const { return rays.ray(k).direction; }
};

}  // namespace

TEST_CASE("rays of a packet cross products of half-spaces where they do alone, to the bit") {
    for (const auto& [name, functions] : packet_instructions()) {
        CAPTURE(name);
        int crossed = 0, missed = 0, occluded = 0;
        for (auto seed : seeds(3'000)) {
            CAPTURE(seed);
            Gen g(seed);
            const Factors factors(g);
            const Packet p(g);
            PacketCrossings found;
            std::uint64_t evaluations = 0, alone = 0;
            const Lanes lanes =
                functions->convex_crossings(factors.view, p.rays, p.lanes, p.spans, scale, found, evaluations);
            CHECK((lanes & ~p.lanes) == 0);
            for (int k = 0; k < RayPacket::size; ++k) {
                if (!(p.lanes >> k & 1)) continue;
                const ConvexCrossing c = first_crossing(factors.view, p.origin(k), p.direction(k), p.spans.from[k],
                                                        p.spans.to[k], t_tolerance(p.spans.from[k]), alone);
                REQUIRE((lanes >> k & 1) == (c.t < infinity));
                if (!(c.t < infinity)) {
                    ++missed;
                    continue;
                }
                ++crossed;
                REQUIRE(same_bits(found.t[k], c.t));
                REQUIRE(int(found.plane[k]) == c.plane);
                REQUIRE(bool(found.entering >> k & 1) == c.entering);
            }
            REQUIRE(evaluations == alone);
            evaluations = alone = 0;
            const Lanes any =
                functions->convex_any_crossings(factors.view, p.rays, p.lanes, p.spans, scale, evaluations);
            for (int k = 0; k < RayPacket::size; ++k) {
                if (!(p.lanes >> k & 1)) continue;
                REQUIRE(bool(any >> k & 1) == any_crossing(factors.view, p.origin(k), p.direction(k), p.spans.from[k],
                                                           p.spans.to[k], t_tolerance(p.spans.from[k]), alone));
                occluded += any >> k & 1;
            }
            REQUIRE(evaluations == alone);
        }
        CHECK(crossed > 5'000);
        CHECK(missed > 5'000);
        CHECK(occluded > 5'000);
    }
}

TEST_CASE("rays of a packet are laid out, mapped and given normals as they are alone, to the bit") {
    for (const auto& [name, functions] : packet_instructions()) {
        CAPTURE(name);
        int alone = 0, entering = 0;
        for (auto seed : seeds(1'000)) {
            CAPTURE(seed);
            Gen g(seed);
            Ray rays[RayPacket::size];
            double t_max[RayPacket::size];
            for (int k = 0; k < RayPacket::size; ++k) {
                rays[k] = {g.point(3), g.chance(0.1) ? Vec3(0, 1, 0) : g.normal()};
                t_max[k] = g.chance(0.2) ? infinity : g.between(0, 5);
            }
            RayPacket packet, mapped;
            RayTerms terms;
            functions->load(packet, rays, t_max);
            const Lanes far = functions->prepare(packet, scale, 2, terms);
            Affine map;
            for (int axis = 0; axis < 3; ++axis) map.linear[axis] = g.point(2);
            map.shift = g.point(5);
            const bool only_moved = g.chance(0.3);
            if (only_moved) map.linear = Mat3(1.0);
            alignas(64) double rate[RayPacket::size];
            functions->map(map, only_moved, packet, packet.t_max, mapped, rate);
            const Factors factors(g);
            PacketNearest nearest;
            for (int k = 0; k < RayPacket::size; ++k) {
                const Vec3 o = rays[k].origin, d = rays[k].direction, inverse = reciprocal(d);
                REQUIRE((packet.ray(k).origin == o && packet.ray(k).direction == d && packet.begin[k] == 0));
                REQUIRE((packet.t_max[k] == t_max[k] && packet.end[k] == t_max[k] && terms.end[k] == t_max[k]));
                for (int axis = 0; axis < 3; ++axis) REQUIRE(same_bits(terms.inverse[axis][k], inverse[axis]));
                REQUIRE(terms.coordinate_bound[k] == scale + largest(o));
                REQUIRE(bool(far >> k & 1) == (largest(o) > 2));
                const Vec3 along = only_moved ? d : map.linear * d;
                const double length = only_moved ? 1 : glm::length(along);
                REQUIRE(same_bits(rate[k], length));
                const Vec3 origin = only_moved ? o + map.shift : map(o);
                for (int axis = 0; axis < 3; ++axis) {
                    REQUIRE(same_bits(mapped.origin[axis][k], origin[axis]));
                    REQUIRE(same_bits(mapped.direction[axis][k], along[axis] / length));
                }
                REQUIRE(same_bits(mapped.t_max[k], t_max[k] * length));
                terms.end[k] = g.between(0, 3);
                nearest.plane[k] = g.chance(0.5) ? -1 : g.below(factors.view.soft + factors.view.sharp + 1) - 1;
                nearest.entering |= Lanes(g.chance(0.5)) << k;
            }
            alignas(64) double normal[3][RayPacket::size];
            const Lanes lanes = Lanes(g.below(1 << RayPacket::size));
            functions->convex_normals(factors.view, packet, terms.end, lanes, nearest, normal);
            for_each_lane(lanes, [&](int k) {
                const ConvexCrossing c{terms.end[k], bool(nearest.entering >> k & 1), int(nearest.plane[k])};
                Vec3 n = surface_normal(factors.view, c, rays[k].origin + rays[k].direction * c.t);
                if ((glm::dot(n, rays[k].direction) < 0) != c.entering) n = -n;
                for (int axis = 0; axis < 3; ++axis) REQUIRE(same_bits(normal[axis][k], n[axis]));
                alone += c.plane >= 0;
                entering += c.entering;
            });
        }
        CHECK(alone > 1'000);
        CHECK(entering > 1'000);
    }
}

namespace {

// Rays towards places near a surface, some nearly along a direction.
void aim(Gen& g, Packet& p, const std::function<Vec3()>& target, const std::function<Vec3()>& across) {
    for (int k = 0; k < RayPacket::size; ++k) {
        Vec3 direction = glm::normalize(target() - p.origin(k));
        const Vec3 n = across(), flat = direction - n * glm::dot(direction, n);
        if (g.chance(0.3) && glm::length(flat) > 1e-3)
            direction = glm::normalize(flat + n * std::pow(10.0, g.between(-17, -1)));
        for (int axis = 0; axis < 3; ++axis) p.rays.direction[axis][k] = direction[axis];
    }
}

struct SumTally {
    int crossed = 0, missed = 0, split = 0;
};

void check_sum(const PacketFunctions& functions, const ProductSum& sum, const Packet& p, SumTally& tally) {
    PacketCrossings found;
    PacketNearest nearest;
    alignas(64) double normal[3][RayPacket::size];
    RootCounters together, alone;
    const Lanes lanes = functions.sum_crossings(sum, p.rays, p.lanes, p.spans, scale, found, together);
    CHECK((lanes & ~p.lanes) == 0);
    nearest.entering = found.entering;
    functions.sum_normals(sum, p.rays, found.t, lanes, nearest, normal);
    ProductSumRay ray;
    const auto first = [&](int k, bool coarse) {
        std::optional<RootCrossing> c;
        ray.set(sum, p.origin(k), p.direction(k));
        ray.crossings(p.spans.from[k], p.spans.to[k], t_tolerance(p.spans.from[k]), coarse, alone,
                      [&](RootCrossing at) {
                          c = at;
                          return false;
                      });
        return c;
    };
    for_each_lane(p.lanes, [&](int k) {
        const auto c = first(k, false);
        REQUIRE(bool(lanes >> k & 1) == c.has_value());
        ++(c ? tally.crossed : tally.missed);
        if (!c) return;
        REQUIRE(same_bits(found.t[k], c->t));
        REQUIRE(bool(found.entering >> k & 1) == c->entering);
        Vec3 n = ray.gradient(c->t);
        const double length = glm::length(n);
        n = length > 0 ? n / length : p.direction(k);
        if ((glm::dot(n, p.direction(k)) < 0) != c->entering) n = -n;
        for (int axis = 0; axis < 3; ++axis) REQUIRE(normal[axis][k] == n[axis]);
    });
    REQUIRE(together.evaluations == alone.evaluations);
    REQUIRE(together.segments == alone.segments);
    REQUIRE(together.splits == alone.splits);
    tally.split += alone.splits > 0;
    together = alone = {};
    const Lanes any = functions.sum_any_crossings(sum, p.rays, p.lanes, p.spans, scale, together);
    for_each_lane(p.lanes, [&](int k) { REQUIRE(bool(any >> k & 1) == first(k, true).has_value()); });
    REQUIRE(together.evaluations == alone.evaluations);
}

void check_surface(const PacketFunctions& functions, const RoundSurface& surface, const Packet& p, int& crossed) {
    PacketCrossings found;
    PacketNearest nearest;
    alignas(64) double normal[3][RayPacket::size];
    const Lanes lanes = functions.surface_crossings(surface, p.rays, p.lanes, p.spans, found);
    nearest.entering = found.entering;
    functions.surface_normals(surface, p.rays, found.t, lanes, nearest, normal);
    for_each_lane(p.lanes, [&](int k) {
        const RoundCrossings all = surface.crossings(p.origin(k), p.direction(k), p.spans.from[k], p.spans.to[k]);
        REQUIRE(bool(lanes >> k & 1) == (all.count > 0));
        if (all.count == 0) return;
        ++crossed;
        REQUIRE(same_bits(found.t[k], all.at[0].t));
        REQUIRE(bool(found.entering >> k & 1) == all.at[0].entering);
        Vec3 n = surface.normal(p.origin(k) + p.direction(k) * all.at[0].t);
        if ((glm::dot(n, p.direction(k)) < 0) != all.at[0].entering) n = -n;
        for (int axis = 0; axis < 3; ++axis) REQUIRE(normal[axis][k] == n[axis]);
    });
}

}  // namespace

TEST_CASE("rays of a packet cross sums of products where they do alone, to the bit") {
    for (const auto& [name, functions] : packet_instructions()) {
        CAPTURE(name);
        SumTally tally;
        for (auto seed : seeds(8'000)) {
            CAPTURE(seed);
            Gen g(seed);
            const Density d = g.chance(0.4) ? g.boolean(2) : g.chance(0.6) ? g.legal(2) : g.arithmetic(2);
            const DensityTree whole = flatten(d, g.between(0.05, 0.6));
            const Vec3 lo = g.near(whole);
            const DensityTree tree = prune(whole, {lo, lo + Vec3(g.between(0.05, 0.6))}).tree;
            const LocalDensity density(tree);
            if (density.half_spaces().size() < 2) continue;
            const auto sum = ProductSum::of(density, 1e-12);
            if (!sum) continue;
            Packet p(g);
            aim(
                g, p, [&] { return g.near(tree); },
                [&] { return tree.half_spaces[std::size_t(g.below(int(tree.half_spaces.size())))].normal; });
            check_sum(*functions, *sum, p, tally);
        }
        CHECK(tally.crossed > 2'000);
        CHECK(tally.missed > 2'000);
        CHECK(tally.split > 300);
    }
}

TEST_CASE("rays of a packet cross round parts, and sums with these, where they do alone, to the bit") {
    for (const auto& [name, functions] : packet_instructions()) {
        CAPTURE(name);
        SumTally tally;
        int sums = 0, surfaces = 0;
        for (auto seed : seeds(4'000)) {
            CAPTURE(seed);
            Gen g(seed);
            const test::RoundCell c(g, 1 + g.below(3));
            if (!c.local) continue;
            Packet p(g);
            aim(
                g, p, [&] { return c.point(g); }, [&] { return g.chance(0.5) ? Vec3(0, 0, 1) : g.normal(); });
            if (const auto surface = RoundSurface::of(*c.local)) check_surface(*functions, *surface, p, surfaces);
            const auto sum = ProductSum::of(*c.local, 1e-12);
            if (!sum || sum->rounds().empty()) continue;
            ++sums;
            check_sum(*functions, *sum, p, tally);
        }
        CHECK(sums > 500);
        CHECK(surfaces > 300);
        CHECK(tally.crossed > 1'000);
        CHECK(tally.missed > 1'000);
        CHECK(tally.split > 100);
    }
}

TEST_CASE("rays of a packet cross tori where they do alone, to the bit") {
    for (const auto& [name, functions] : packet_instructions()) {
        CAPTURE(name);
        int crossed = 0;
        for (auto seed : seeds(4'000)) {
            CAPTURE(seed);
            Gen g(seed);
            const double R = std::pow(10, g.between(-2, 1)), tube = R * (g.chance(0.3) ? 1e-3 : g.between(0.02, 1));
            const RoundCoordinate circle = RoundCoordinate::distance_from_circle(g.point(1), g.direction(), R);
            const RoundSurface torus{circle, tube, g.chance(0.3)};
            Packet p(g);
            const Vec3 u = glm::normalize(glm::cross(circle.axis, g.direction()));
            const auto near = [&] {  // at the tube, within, or anywhere
                const Vec3 out = glm::normalize(u + g.point(2) - circle.axis);
                const Vec3 across = glm::normalize(out - circle.axis * glm::dot(circle.axis, out));
                return circle.center + R * across + tube * (g.chance(0.5) ? g.direction() : g.point(3));
            };
            aim(g, p, near, [&] { return g.chance(0.3) ? circle.axis : g.direction(); });
            check_surface(*functions, torus, p, crossed);
        }
        CHECK(crossed > 8'000);
    }
}

namespace {

// Boxes within boxes, some slots empty.
struct RandomBoxes {
    std::vector<BoxNode> nodes;
    std::uint32_t items = 0;

    explicit RandomBoxes(Gen& g) { add(g, Vec3(0.0), 1, 2); }
    BoxTree tree() const {
        BoxTree tree;
        tree.nodes = nodes.data();
        return tree;
    }

    // Items that are met where nothing ends the ray.
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

// The items in the order in which they are visited, with the ends that are told; nearer ends are set on the way.
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
    constexpr double slack = 1e-5;  // more than single precision makes of such places
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
