// True convolution of polyhedra with a ball: values, gradients and running time against independent computations.
#include "bounds/ball_convolution.hpp"

#include <ctime>

#include "bounds/local_density.hpp"
#include "bounds/solid_tree.hpp"
#include "catch.hpp"
#include "plain_definition.hpp"
#include "random_case.hpp"

using namespace deburr;

namespace {

double share(const Density& d, Vec3 x = Vec3(0), double r = 1) { return flatten_convolved(d, r).at(x); }

// Fraction of the ball around x of radius r that lies in the polyhedron, by across² parallel lines: along each of them
// the Boolean function changes only where the line meets a plane.
double by_lines(const DensityTree& tree, Vec3 x, double r, int across) {
    const int root = tree.nodes.back().a;
    std::vector<char> is_true(tree.half_spaces.size());
    double inside = 0;
    const Vec3 ex = glm::normalize(Vec3(0.8, 0.37, -0.29)), ey = glm::normalize(glm::cross(ex, Vec3(0.3, 0.7, 0.5))),
               ez = glm::cross(ex, ey);  // parallel to no plane
    for (int i = 0; i < across; ++i)
        for (int k = 0; k < across; ++k) {
            const double u = 2 * (i + 0.5) / across - 1, v = 2 * (k + 0.5) / across - 1;
            if (u * u + v * v >= 1) continue;
            const double h = std::sqrt(1 - u * u - v * v);
            std::vector<double> cuts{-h, h};
            for (const HalfSpace& s : tree.half_spaces) {
                const double at = -s.distance(x + r * (u * ex + v * ey)) / r, w = at / glm::dot(s.normal, ez);
                if (w > -h && w < h) cuts.push_back(w);
            }
            std::sort(cuts.begin(), cuts.end());
            for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
                const Vec3 y = x + r * (u * ex + v * ey + 0.5 * (cuts[c] + cuts[c + 1]) * ez);
                for (std::size_t p = 0; p < is_true.size(); ++p) is_true[p] = tree.half_spaces[p].distance(y) <= 0;
                if (plain::boolean_value(tree, root, is_true)) inside += cuts[c + 1] - cuts[c];
            }
        }
    return inside * 4.0 / across / across / (4 * pi / 3);
}

}  // namespace

TEST_CASE("the share of one half-space is Lobb's cubic") {
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const double alpha = g.between(-1.1, 1.1);
        CHECK(std::abs(share(Density::half_space(g.normal(), -alpha)) - plain::profile(alpha)) <= 1e-15);
    }
}

TEST_CASE("the share of a polyhedron is what is counted line by line") {
    for (auto seed : seeds(200)) {
        CAPTURE(seed);
        Gen g(seed);
        const DensityTree tree = flatten_convolved(g.boolean(g.below(3)), g.between(0.2, 0.8));
        const Vec3 x = g.near(tree, 0.8);
        const double r = glm::length(tree.ball[0]);
        CHECK(std::abs(tree.at(x) - by_lines(tree, x, r, 120)) < 1e-4);
    }
}

TEST_CASE("the shares of a polyhedron and of what it leaves add up to 1, and those of its pieces to its own") {
    int varied = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Density d = g.boolean(g.below(3));
        const double r = g.between(0.2, 0.8);
        const Vec3 x = g.near(flatten_convolved(d, r), 0.8);
        const double whole = share(d, x, r);
        CHECK(std::abs(whole + share(~d, x, r) - 1) < 1e-13);
        const Density cut = g.chance(0.5) ? g.boolean(1) : Density::half_space(g.normal(), g.between(-0.5, 0.5));
        CHECK(std::abs(share(d & cut, x, r) + share(d & ~cut, x, r) - whole) < 1e-13);
        varied += whole > 0 && whole < 1;
    }
    CHECK(varied > 1'000);
}

TEST_CASE("around a point of all planes the share is an angle") {
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Vec3 a = g.direction(), b = g.direction(), c = g.direction();
        const double between = pi - std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
        CHECK(std::abs(share(Density::half_space(a, 0) & Density::half_space(b, 0)) - between / (2 * pi)) < 1e-13);
        // Solid angle of a corner from its edges [Van Oosterom & Strackee 1983].
        const double hand = glm::dot(a, glm::cross(b, c)) > 0 ? -1 : 1;
        const Vec3 u = glm::normalize(hand * glm::cross(b, c)), v = glm::normalize(hand * glm::cross(c, a)),
                   w = glm::normalize(hand * glm::cross(a, b));
        const double solid = 2 * std::atan2(std::abs(glm::dot(u, glm::cross(v, w))),
                                            1 + glm::dot(u, v) + glm::dot(v, w) + glm::dot(w, u));
        if (std::abs(glm::dot(a, glm::cross(b, c))) > 0.05)  // otherwise the edges are too nearly parallel
            CHECK(std::abs(share(Density::half_space(a, 0) & Density::half_space(b, 0) & Density::half_space(c, 0)) -
                           solid / (4 * pi)) < 1e-13);
    }
}

TEST_CASE("the share's change from place to place is the integral of its gradient") {
    // Values use areas on the sphere too, gradients only the faces, so the two are independent.
    for (auto seed : seeds(60)) {
        CAPTURE(seed);
        Gen g(seed);
        const DensityTree tree =
            flatten_convolved(g.boolean(g.below(3)), g.between(0.2, 0.8), g.chance(0.3) ? g.map() : Affine{});
        const Vec3 from = g.near(tree, 0.8), step = 0.5 * g.direction();
        constexpr int panels = 2'000;  // of three Gauss points each, since the gradient has kinks
        double sum = 0;
        for (int k = 0; k < panels; ++k)
            for (const double s : {-0.7745966692414834, 0.0, 0.7745966692414834}) {
                const Vec3 x = from + (k + 0.5 + 0.5 * s) / panels * step;
                sum += (s == 0 ? 8.0 : 5.0) / 18 / panels * glm::dot(step, tree.gradient_at(x).gradient);
            }
        CHECK(std::abs(tree.at(from + step) - tree.at(from) - sum) < 3e-8);
    }
}

TEST_CASE("flush, touching and coincident faces leave no trace in the share") {
    for (auto seed : seeds(1'000)) {
        CAPTURE(seed);
        Gen g(seed);
        // A box is the union of eight parts; a random half of them are mapped there and back, which rounds their
        // planes.
        const Vec3 cut = {g.between(0.2, 0.8), g.between(0.2, 0.8), g.between(0.2, 0.8)};
        const Affine map = g.map(), back = {glm::inverse(map.linear), -(glm::inverse(map.linear) * map.shift)};
        Density parts = ~Density::box(Vec3(-9), Vec3(9));
        for (int k = 0; k < 8; ++k) {
            Vec3 lo, hi;
            for (int axis = 0; axis < 3; ++axis) {
                const bool upper = k >> axis & 1;
                lo[axis] = upper ? cut[axis] : 0;
                hi[axis] = upper ? 1 : cut[axis];
            }
            const Density part = Density::box(lo, hi);
            parts = parts | (g.chance(0.5) ? part : part.transformed(map).transformed(back));
        }
        const Vec3 x = g.chance(0.3) ? cut : g.point(1);
        const double r = g.between(0.1, 0.6);
        CHECK(std::abs(share(parts, x, r) - share(Density::box(Vec3(0), Vec3(1)), x, r)) < 1e-12);
    }
}

TEST_CASE("planes through one line, however near, are told apart or are one") {
    // The union of adjacent wedges around a common edge is compared with one wedge of the whole angle.
    double worst = 0;
    for (auto seed : seeds(3'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Vec3 e = g.direction(), u = glm::normalize(glm::cross(e, g.direction())), v = glm::cross(e, u);
        const auto at = [&](double angle) { return std::cos(angle) * u + std::sin(angle) * v; };
        const int count = 2 + g.below(5);
        const bool near = g.chance(0.7);
        std::vector<double> angles{0};
        for (int i = 0; i < count; ++i)
            angles.push_back(angles.back() +
                             (near && g.chance(0.5) ? std::pow(10, -g.between(1, 16)) : g.between(1e-3, 0.5)));
        const Vec3 corner = g.point(0.5);
        const auto wedge = [&](double from, double to) {
            const Vec3 a = -at(from + pi / 2), b = at(to + pi / 2);
            return Density::half_space(a, glm::dot(a, corner)) & Density::half_space(b, glm::dot(b, corner));
        };
        Density pieces = wedge(angles[0], angles[1]);
        for (int i = 1; i < count; ++i) pieces = pieces | wedge(angles[i], angles[std::size_t(i) + 1]);
        const double error = std::abs(share(pieces) - share(wedge(angles.front(), angles.back())));
        CHECK(error < (near ? 1e-8 : 1e-12));
        worst = std::max(worst, error);
    }
    CHECK(worst > 1e-13);  // otherwise no planes were near enough to be hard
}

TEST_CASE("planes that touch the ball, edges that touch it and corners on it make no jump") {
    for (auto seed : seeds(2'000)) {
        CAPTURE(seed);
        Gen g(seed);
        const Vec3 n = g.direction(), a = g.direction(), b = g.direction(), c = g.direction();
        const auto corner = [&](double at) {
            return Density::half_space(a, at * glm::dot(a, n)) & Density::half_space(b, at * glm::dot(b, n)) &
                   Density::half_space(c, at * glm::dot(c, n));
        };
        const Density edge = Density::half_space(a, glm::dot(a, n)) &
                             Density::half_space(b, glm::dot(b, n));  // through n, on the unit sphere
        for (const double step : {1e-15, 1e-12, 1e-10}) {
            CHECK(std::abs(share(corner(1 + step)) - share(corner(1 - step))) < 2 * step + 1e-13);
            CHECK(std::abs(share(edge, step * n) - share(edge, -step * n)) < 2 * step + 1e-13);
            CHECK(share(Density::half_space(n, -1 + step)) < 1e-18);
        }
    }
}

namespace {

// A polyhedron of `count` faces in all directions, all tangent to the sphere of radius 0.5 around the origin.
Density many_sided(int count) {
    std::vector<Density> planes;
    for (int k = 0; k < count; ++k) {
        const double z = 1 - (2 * k + 1.0) / count, phi = 2.399963229728653 * k, s = std::sqrt(1 - z * z);
        planes.push_back(Density::half_space({s * std::cos(phi), s * std::sin(phi), z}, 0.5));
    }
    return Density::product(planes);
}

}  // namespace

TEST_CASE("many planes in one ball: a sphere in a ball, nearly") {
    // So many planes need more than truth tables can hold. The polyhedron is a little larger than a ball of radius ½,
    // whose share of the unit ball is ⅛.
    const DensityTree tree = flatten_convolved(many_sided(60), 1);
    CHECK(tree.at(Vec3(0)) > 0.125);
    CHECK(tree.at(Vec3(0)) < 0.14);
    CHECK(std::abs(tree.at({0.1, 0.2, 0.05}) - by_lines(tree, {0.1, 0.2, 0.05}, 1, 200)) < 2e-5);
    CHECK(std::abs(tree.at({0.1, 0.2, 0.05}) + flatten_convolved(~many_sided(60), 1).at({0.1, 0.2, 0.05}) - 1) < 1e-13);
}

TEST_CASE("many planes in one ball: the parts of a union of many-sided pieces add up to it") {
    for (auto seed : seeds(40)) {
        CAPTURE(seed);
        Gen g(seed);
        const auto piece = [&] { return many_sided(12 + g.below(12)).transformed(g.map()); };
        const Density a = piece(), b = piece(), c = piece(), whole = (a | b) & ~c;
        const Vec3 x = g.point(0.5);
        const double r = g.between(0.7, 1.5);
        const double only_a = share(a & ~b & ~c, x, r), only_b = share(b & ~a & ~c, x, r);
        CHECK(std::abs(only_a + only_b + share(a & b & ~c, x, r) - share(whole, x, r)) < 1e-12);
        CHECK(std::abs(share(~whole, x, r) + share(whole, x, r) - 1) < 1e-12);
    }
}

TEST_CASE("240 planes in one ball take no walk along the chords of all of them") {
    const auto seconds_at = [](int count) {
        const DensityTree tree = flatten_convolved(many_sided(count), 1);
        const std::clock_t begin = std::clock();
        double sum = 0;
        for (int k = 0; k < 5; ++k) sum += tree.at({0.1, 0.02 * k, 0.05});
        CHECK(sum > 0.5);
        return double(std::clock() - begin) / CLOCKS_PER_SEC;
    };
    CHECK(seconds_at(240) < 3);  // 0.15 s; a walk along all planes' chords takes 30 s
}
