// The implicit tracer against the plain definition, ray by ray.
#include "raytracer/trace/implicit_tracer.hpp"

#include <cstdio>

#include "catch.hpp"
#include "plain_definition.hpp"
#include "random_case.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/trace/agreement.hpp"

using namespace deburr;

namespace {

// Compares the hits of a camera's rays, one for each pixel of the grid, with the definition's first crossing of any
// solid.
Agreement compare_view(const std::vector<Solid>& solids, const Camera& camera, int columns, int rows,
                       double t_max = 100, int steps = 12) {
    const ImplicitTracer tracer(solids);
    std::vector<SolidTree> trees;
    for (const Solid& s : solids) trees.push_back(flatten(s));
    const ProjectiveCamera view(camera, columns, rows);
    Agreement a;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const Ray ray = view.ray(x + 0.5, y + 0.5);
            TraceCounters counters;
            const double t = tracer.closest_hit(ray, t_max, counters).t;
            double want = infinity;
            for (const SolidTree& tree : trees)
                want = std::min(want, expected_hit(tree, ray.origin, ray.direction, t, t_max, steps));
            ++a.rays;
            a.hits += want < infinity;
            if (!agree(t, want)) {
                UNSCOPED_INFO("pixel " << x << ' ' << y << ": " << t << ", not " << want);
                ++a.differ;
            }
        }
    return a;
}

Camera look(Vec3 eye, Vec3 target, double fov = 40) { return {eye, target, {0, 1, 0}, fov}; }

Density wheel(int sides, double radius, double y0, double y1, Vec3 center = Vec3(0)) {
    std::vector<Density> faces{Density::half_space({0, 1, 0}, y1), Density::half_space({0, -1, 0}, -y0)};
    for (int k = 0; k < sides; ++k) {
        const double a = 6.283185307179586 * k / sides;
        const Vec3 n(std::cos(a), 0, std::sin(a));
        faces.push_back(Density::half_space(n, radius + glm::dot(n, center)));
    }
    return Density::product(faces);
}

}  // namespace

TEST_CASE("random solids are hit where the definition says, from outside and from within") {
    int rays = 0, hits = 0, differ = 0;
    for (auto seed : seeds(500)) {
        Gen g(seed);
        const Solid solid = g.solid(int(seed % 3));
        const SolidTree tree = flatten(solid);
        const ImplicitTracer tracer({solid});
        for (int k = 0; k < 12; ++k) {
            const Vec3 o = g.chance(0.2) ? g.point(1) : g.point(4);
            const Vec3 d = glm::normalize(g.near(tree.leaves[0].density) - o);
            TraceCounters counters;
            const double t = tracer.closest_hit({o, d}, 100, counters).t;
            const double want = plain::first_crossing(tree, o, d, 100, 16);
            ++rays;
            hits += want < infinity;
            differ += !agree(t, want);
        }
    }
    CHECK(hits > 1'500);
    CHECK(differ <= rays / 2'000);  // grazing rays
}

TEST_CASE("every criterion and any rays: any_hit agrees with closest_hit") {
    int blocked = 0;
    for (auto seed : seeds(300)) {
        CAPTURE(seed);
        Gen g(seed);
        const ImplicitTracer tracer({g.solid(1), g.solid(0)});
        for (int k = 0; k < 20; ++k) {
            const Vec3 o = g.point(3), d = glm::normalize(g.point(0.7) - o);
            TraceCounters counters;
            const Hit hit = tracer.closest_hit({o, d}, infinity, counters);
            const double t_max = g.between(0, 6);
            REQUIRE(tracer.any_hit({o, d}, t_max, counters) == (hit.t <= t_max));
            blocked += hit.t <= t_max;
            if (hit) REQUIRE(std::abs(glm::length(hit.normal) - 1) < 1e-9);
        }
    }
    CHECK(blocked > 500);
}

TEST_CASE("slots and ribs as wide as the filter, for radii from 0 over 1e-7 to half the object", "[slow]") {
    for (const double r : {0.0, 1e-7, 1e-3, 0.05, 0.1, 0.25, 0.5}) {
        CAPTURE(r);
        Density comb = Density::box({0, 0, 0}, {2, 1, 1});
        for (int k = 0; k < 4; ++k)
            comb = comb & ~Density::box({0.3 + 0.4 * k, 0.4, -1}, {0.3 + 0.4 * k + std::max(r, 0.02), 2, 2});
        const Agreement a = compare_view({Solid::rounded(r, comb)}, look({3, 2.5, 4}, {1, 0.4, 0.5}), 48, 30);
        CHECK(a.differ == 0);
        if (r < 0.3) CHECK(a.hits > 100);
    }
}

TEST_CASE("a filter too small to be sampled leaves sharp faces with their normals") {
    for (const double r : {1e-13, 1e-15, 1e-18, 1e-100, 1e-200, 1e-300, 1e-310}) {
        CAPTURE(r);
        const Density boolean = Density::box(Vec3(0), Vec3(1)) & ~Density::box({0.3, 0.3, -1}, {0.6, 2, 0.5});
        const Density sum = Density::box({2, 0, 0}, {3, 1, 1}) + Density::box({3, 0, 0}, {4, 1, 1});
        const ImplicitTracer tracer({Solid::rounded(r, boolean), Solid::rounded(r, sum)});
        const ImplicitTracer sharp({Solid::sharp(boolean), Solid::sharp(sum)});
        Gen g(4);
        TraceCounters counters;
        int hits = 0;
        for (int i = 0; i < 2'000; ++i) {
            const Vec3 o = Vec3(2, 0, 0) + g.direction() * 6.0;
            const Vec3 d = glm::normalize(Vec3(g.between(0, 4), g.between(0, 1), g.between(0, 1)) - o);
            const Hit hit = tracer.closest_hit({o, d}, infinity, counters),
                      want = sharp.closest_hit({o, d}, infinity, counters);
            REQUIRE(bool(hit) == bool(want));
            if (!hit) continue;
            REQUIRE(std::abs(hit.t - want.t) < 1e-9);
            REQUIRE(glm::length(hit.normal - want.normal) < 1e-9);
            ++hits;
        }
        CHECK(hits > 1'000);
    }
}

TEST_CASE("a wheel of 40 sides, as a product and as a Boolean density with a hub and spokes", "[slow]") {
    for (const double r : {0.02, 0.1, 0.5}) {
        CAPTURE(r);
        const Agreement product =
            compare_view({Solid::rounded(r, wheel(40, 1, -0.2, 0.2))}, look({2, 2.5, 3}, {0, 0, 0}), 32, 20);
        CHECK(product.differ == 0);
        const Density hollow = (wheel(40, 1, -0.2, 0.2) & ~wheel(40, 0.8, -1, 1)) | wheel(40, 0.25, -0.3, 0.3) |
                               Density::box({-0.9, -0.1, -0.05}, {0.9, 0.1, 0.05});
        if (r > 0.05) continue;  // the plain definition sums all outcomes of all sides
        const Agreement boolean =
            compare_view({Solid::rounded(r, hollow)}, look({1.2, 2.8, 1.5}, {0, 0, 0}, 45), 14, 10, 100, 4);
        CHECK(boolean.differ == 0);
        CHECK(boolean.hits > 20);
    }
}

TEST_CASE("flush, touching and overlapping faces of Boolean densities are flat to 1e-12") {
    const double r = 0.15;
    const Density top = Density::box({0, 0, 0}, {2, 1, 1}) | Density::box({1, 0, 0}, {3, 1, 1}) |
                        Density::box({3, 0, 0}, {4, 1, 1}) | Density::box({0.5, 0.2, -1}, {3.5, 1, 2});
    const ImplicitTracer tracer({Solid::rounded(r, top)});
    TraceCounters counters;
    for (double x = 0.7; x <= 3.3; x += 0.01) {
        const Hit down = tracer.closest_hit({{x, 5, 0.5}, {0, -1, 0}}, infinity, counters);
        CHECK(std::abs(down.position.y - 1) < 1e-12);
        CHECK(glm::length(down.normal - Vec3(0, 1, 0)) < 1e-9);
    }
    const Agreement a = compare_view({Solid::rounded(r, top)}, look({5, 4, 6}, {2, 0.5, 0.5}), 48, 30);
    CHECK(a.differ == 0);
    CHECK(a.hits > 200);
}

TEST_CASE("mirrored and unevenly scaled solids carry their field along") {
    const Density holed = Density::box(Vec3(0), Vec3(1)) & ~Density::box({0.3, 0.3, -1}, {0.6, 0.8, 0.5});
    Affine mirror, squash;
    mirror.linear = Mat3(-1, 0, 0, 0, 1, 0, 0, 0, 1);
    squash.linear = Mat3(0.3, 0, 0, 0, 2, 0, 0, 0, 1);
    squash.shift = {0.5, 0, 0.2};
    const Solid s = Solid::rounded(0.2, holed);
    const Agreement a =
        compare_view({s.transformed(mirror), s.transformed(squash)}, look({2, 1.5, -4}, {0, 0.6, 0.5}), 64, 40);
    CHECK(a.differ == 0);
    CHECK(a.hits > 200);
}

TEST_CASE("a camera inside a room sees its rounded walls, pixel for pixel") {
    const Density room = Density::box(Vec3(-3), Vec3(3)) & ~Density::box(Vec3(-2), Vec3(2));
    const Solid furniture = Solid::rounded(0.1, Density::box({-1, -2, -1}, {0, -1, 0.5}));
    const Agreement boolean =
        compare_view({Solid::rounded(0.3, room), furniture}, look({1.5, 1, 1.7}, {-1, -0.7, -1}, 80), 64, 40);
    CHECK(boolean.differ == 0);
    CHECK(boolean.hits == boolean.rays);
    const Solid primary =
        Solid::rounded(0.3, Density::box(Vec3(-3), Vec3(3))) - Solid::rounded(0.3, Density::box(Vec3(-2), Vec3(2)));
    const Agreement csg = compare_view({primary}, look({1.5, 1, 1.7}, {-1, -0.7, -1}, 80), 64, 40);
    CHECK(csg.differ == 0);
    CHECK(csg.hits == csg.rays);
}

TEST_CASE("600 tilted blocks, as 600 solids, as one union and as one Boolean density", "[slow]") {
    Gen g(600);
    std::vector<Solid> solids;
    std::vector<Density> densities;
    std::vector<Vec3> centers;
    for (int i = 0; i < 600; ++i) {
        Affine m = g.map(false);
        for (int k = 0; k < 3; ++k) m.linear[k] *= g.between(0.05, 0.4);
        m.shift = g.point(2.5);
        centers.push_back(m.shift);
        densities.push_back(Density::box(Vec3(-0.5), Vec3(0.5)).transformed(m));
        solids.push_back(Solid::rounded(0.01, densities.back()));
    }
    const Camera camera = look({5, 4, 6}, {0, 0, 0});
    const Agreement apart = compare_view(solids, camera, 12, 8, 30, 2);
    CHECK(apart.differ == 0);
    CHECK(apart.hits > 10);

    // The hits are the same for separate solids, their union and one Boolean density.
    Solid all = solids[0];
    Density any = densities[0];
    for (std::size_t i = 1; i < solids.size(); ++i) {
        all = all | solids[i];
        any = any | densities[i];
    }
    const ImplicitTracer separate(solids), united({all}), boolean({Solid::rounded(0.01, any)});
    TraceCounters counters;
    int hits = 0, differ = 0, checked = 0;
    for (int i = 0; i < 3'000; ++i) {
        const Vec3 o = g.direction() * 8.0, d = glm::normalize(g.point(2) - o);
        const Hit a = separate.closest_hit({o, d}, infinity, counters),
                  b = united.closest_hit({o, d}, infinity, counters);
        hits += bool(a);
        differ += !agree(a.t, b.t);
        if (i % 30 == 0) {
            // Only blocks within half a diagonal plus the filter radius of the ray can matter.
            std::vector<Density> near;
            for (std::size_t k = 0; k < centers.size(); ++k)
                if (glm::length(glm::cross(centers[k] - o, d)) < 0.4) near.push_back(densities[k]);
            if (near.empty()) continue;
            Density there = near[0];
            for (std::size_t k = 1; k < near.size(); ++k) there = there | near[k];
            const SolidTree tree = flatten(Solid::rounded(0.01, there));
            ++checked;
            const double want = plain::first_crossing(tree, o, d, 20, 3);
            const double t = boolean.closest_hit({o, d}, infinity, counters).t;
            CHECK(agree(t, want));
        }
    }
    CHECK(hits > 1'000);
    CHECK(differ == 0);
    CHECK(checked > 80);
}

TEST_CASE("unbounded solids are hit at any distance") {
    const Solid ground = Solid::sharp(Density::half_space({0, 1, 0}, 0));
    const Solid wedge = Solid::rounded(0.5, Density::half_space({1, 1, 0}, -20) & Density::half_space({-1, 1, 0}, 0));
    const ImplicitTracer tracer({ground, wedge, Solid::rounded(0.1, Density::box(Vec3(0), Vec3(1)))});
    TraceCounters counters;
    for (const double far : {10.0, 1e3, 1e6}) {
        const Vec3 o(0.5, 3, 5), d = glm::normalize(Vec3(far, -3, far));
        const Hit hit = tracer.closest_hit({o, d}, infinity, counters);
        CHECK(std::abs(hit.position.y) < 1e-9 * far);
        CHECK(hit.t == Approx(3 / -d.y).epsilon(1e-9));
    }
    CHECK_FALSE(tracer.closest_hit({{0.5, 3, 5}, glm::normalize(Vec3(0.1, 1, 0.1))}, infinity, counters));
}

TEST_CASE("bounded solids among unbounded ones are hit from near and far, pixel for pixel", "[slow]") {
    // An unbounded beam and an unbounded trench; one block is on the beam, one in the trench, one far outside.
    const Solid beam =
        Solid::rounded(0.1, Density::half_space({0, 1, 0}, 0.5) * Density::half_space({0, -1, 0}, 0.5) *
                                Density::half_space({0, 0, 1}, 0.5) * Density::half_space({0, 0, -1}, 0.5));
    const Solid ground =
        Solid::rounded(0.2, Density::half_space({0, 1, 0}, -2) &
                                ~(Density::half_space({1, 0, 0}, 3) & Density::half_space({-1, 0, 0}, -2)));
    const std::vector<Solid> solids{beam, ground, Solid::rounded(0.1, Density::box({0, 0.5, -0.3}, {0.6, 1, 0.3})),
                                    Solid::rounded(0.1, Density::box({2.2, -2.2, 1}, {2.7, -1.5, 1.5})),
                                    Solid::sharp(Density::half_space({0, 1, 0}, -3))};
    for (const Vec3 eye : {Vec3(2, 3, 4), Vec3(0.2, 1.5, 0), Vec3(40, 25, 60), Vec3(-30, 0.7, 0.1)}) {
        CAPTURE(eye.x);
        const Agreement a = compare_view(solids, look(eye, {1, 0, 0.3}, 50), 48, 30, 300);
        CHECK(a.differ == 0);
        CHECK(a.hits > 400);
    }
}

TEST_CASE("products need no search, and a search finds the same") {
    int hits = 0, differ = 0;
    TraceCounters direct, by_search;
    for (auto seed : seeds(400)) {
        Gen g(seed);
        const std::vector<Solid> solids{g.solid(int(seed % 2)), g.solid(0)};
        const ImplicitTracer tracer(solids), searching(solids, Criterion::exact, RootMethod::always);
        for (int k = 0; k < 40; ++k) {
            const Vec3 o = g.point(3), d = glm::normalize(g.point(0.8) - o);
            const Hit a = tracer.closest_hit({o, d}, infinity, direct),
                      b = searching.closest_hit({o, d}, infinity, by_search);
            differ += a.t != b.t && !(std::abs(a.t - b.t) < 1e-9);
            if (!a || !b) continue;
            ++hits;
            differ += a.t == b.t && glm::length(a.normal - b.normal) > 1e-6;
        }
    }
    CHECK(hits > 3'000);
    CHECK(differ < hits / 1'000);  // grazing rays, and rays through edges
    CHECK(direct.evaluations < by_search.evaluations);
}

TEST_CASE("coincident faces of a primary CSG tree leave no film behind") {
    const Density block = Density::box(Vec3(0), Vec3(1)), slot = Density::box({0.25, 0.5, 0.25}, {0.75, 1, 0.75});
    Affine turn;  // gives the same planes by other arithmetic
    const double s = std::sin(0.3), c = std::cos(0.3);
    turn.linear = Mat3(c, s, 0, -s, c, 0, 0, 0, 1);
    const Solid cut = (Solid::sharp(block) - Solid::sharp(slot)).transformed(turn);
    const ImplicitTracer tracer({cut});
    TraceCounters counters;
    Gen g(9);
    for (int i = 0; i < 2'000; ++i) {
        const Vec3 aim = turn(Vec3(g.between(0.3, 0.7), 1, g.between(0.3, 0.7)));
        const Vec3 d = turn.linear * Vec3(0, -1, 0);
        const Hit hit = tracer.closest_hit({aim - d * 3.0, d}, infinity, counters);
        REQUIRE(std::abs(hit.t - 3.5) < 1e-9);  // the floor of the slot
    }
    // Between two touching blocks there is no surface for a ray inside.
    const ImplicitTracer pair({Solid::sharp(block) | Solid::sharp(Density::box({1, 0, 0}, {2, 1, 1}))});
    CHECK(pair.closest_hit({{0.5, 0.5, 0.5}, {1, 0, 0}}, infinity, counters).t == Approx(1.5));
}

TEST_CASE("Lobb's figure 11: the six objects, by the definition", "[slow]") {
    const double r = 0.08;
    const auto at = [](Vec3 size, Vec3 shift) { return Density::box(shift, shift + size); };
    const Density cube = at(Vec3(1), Vec3(0)), box1 = at(Vec3(0.5), {0.25, 0.8, 0.25});
    const Density box2 = at({0.5, 1, 0.5}, {0.25, 0.8, 0.25}), box3 = at(Vec3(0.5), {0.25, 1, 0.25});
    const Density top = Density::half_space({0, 1, 0}, 1);
    const std::vector<Solid> objects{
        Solid::sharp(cube) - Solid::sharp(box1),           Solid::rounded(r, cube) - Solid::sharp(box1),
        Solid::sharp(cube) - Solid::rounded(r, box2),      Solid::rounded(r, cube - top * box2),
        Solid::rounded(r, cube) | Solid::rounded(r, box3), Solid::rounded(r, cube + box3)};
    for (const Solid& object : objects) {
        const Agreement a = compare_view({object}, look({2.2, 2.4, 3}, {0.5, 0.6, 0.5}, 36), 60, 38);
        CHECK(a.differ == 0);
        CHECK(a.hits > 300);
    }
}

TEST_CASE("cost per ray grows like the logarithm of the number of solids") {
    // The cost is the number of cells and half-spaces visited: 30 times as many blocks take less than three times as
    // many cells.
    double before = 0;
    for (const int side : {3, 10}) {
        std::vector<Solid> solids;
        for (int i = 0; i < side * side * side; ++i)
            solids.push_back(
                Solid::rounded(0.05, Density::box(Vec3(0), Vec3(0.3))
                                         .transformed({Mat3(1.0), Vec3(i % side, i / side % side, i / side / side)})));
        const ImplicitTracer tracer(solids);
        Gen g(1);
        TraceCounters counters;
        for (int i = 0; i < 2'000; ++i) {
            const Vec3 o = Vec3(0.5 * side) + g.direction() * (3.0 * side);
            tracer.closest_hit({o, glm::normalize(Vec3(0.5 * side) + g.point(0.4 * side) - o)}, infinity, counters);
        }
        const double cells = double(counters.cells) / 2'000;
        if (before > 0) CHECK(cells < 3 * before);
        before = cells;
    }
}

TEST_CASE("cells become no smaller than rays repay: the more holes a plate has, the fewer for each") {
    double before = 0;  // cells per hole
    for (const int side : {4, 12}) {
        Density plate = Density::box({0, 0, 0}, {double(side), 0.3, double(side)});
        for (int i = 0; i < side; ++i)
            for (int k = 0; k < side; ++k) {
                Density hole = Density::half_space({0, 1, 0}, 2) & Density::half_space({0, -1, 0}, 1);
                for (int j = 0; j < 12; ++j) {
                    const double a = 2 * pi * j / 12;
                    const Vec3 n(std::cos(a), 0, std::sin(a));
                    hole = hole & Density::half_space(n, glm::dot(n, Vec3(i + 0.5, 0, k + 0.5)) + 0.29);
                }
                plate = plate & ~hole;
            }
        const ImplicitTracer tracer({Solid::rounded(0.03, plate)});
        const double cells = double(tracer.statistics().cells) / (side * side);
        CAPTURE(side, cells);
        CHECK(cells < (side == 4 ? 180 : 90));
        if (before > 0) CHECK(cells < 0.7 * before);
        before = cells;
    }
}
