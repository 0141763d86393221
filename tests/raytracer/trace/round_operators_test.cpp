// Rays against densities of round parts under all operators, with radii of their own and transformed, held against
// their plain definition [docs/design.md, Round primitives].
#include <map>

#include "catch.hpp"
#include "plain_round.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

using namespace deburr;

namespace {

// A part in the definition: true where the draw is at most `limit`, and for a distance at least −limit.
struct PlainPart {
    int family;
    double limit;
    bool is_distance;
};

// An expression of parts; its Boolean subexpressions are summed over all draws.
class PlainExpression {
public:
    enum class Op { part, sum, product, difference, either, both, no };
    struct Node {
        Op op;
        int a = -1, b = -1;
        PlainPart part{};
    };

    // Adds a part. Surfaces of one coordinate and one radius form a family; `key` identifies the coordinate.
    int part(const std::string& key, std::function<double(Vec3)> coordinate, double radius, double limit,
             bool is_distance) {
        const auto [at, is_new] = known_.try_emplace({key, radius}, int(families_.size()));
        if (is_new) families_.push_back({std::move(coordinate), radius});
        return add({Op::part, -1, -1, {at->second, limit, is_distance}});
    }
    int add(Node node) {
        nodes_.push_back(node);
        return int(nodes_.size()) - 1;
    }
    double at(int i, Vec3 x) const {
        const Node& n = nodes_[i];
        switch (n.op) {
            case Op::sum: return at(n.a, x) + at(n.b, x);
            case Op::product: return at(n.a, x) * at(n.b, x);
            case Op::difference: return at(n.a, x) - at(n.b, x);
            default: return probability(i, x);
        }
    }

private:
    struct Family {
        std::function<double(Vec3)> coordinate;
        double radius;
    };
    void parts(int i, std::vector<int>& found) const {
        const Node& n = nodes_[i];
        if (n.op == Op::part) found.push_back(i);
        if (n.a >= 0) parts(n.a, found);
        if (n.b >= 0) parts(n.b, found);
    }
    // Probability that the expression is true, read as a Boolean function.
    double probability(int root, Vec3 x) const {
        std::vector<int> below;
        parts(root, below);
        std::map<int, std::vector<double>> limits;
        for (const int i : below) {
            const PlainPart& p = nodes_[i].part;
            limits[p.family].push_back(p.limit);
            if (p.is_distance) limits[p.family].push_back(-p.limit);
        }
        std::map<int, double> draw;
        return sum(root, x, limits, limits.begin(), draw);
    }
    using Limits = std::map<int, std::vector<double>>;
    double sum(int root, Vec3 x, Limits& limits, Limits::iterator family, std::map<int, double>& draw) const {
        if (family == limits.end()) return holds(root, draw);
        const Family& f = families_[family->first];
        std::vector<double>& all = family->second;
        std::sort(all.begin(), all.end());
        const double u = f.coordinate(x);
        double total = 0, before = 0;
        for (std::size_t k = 0; k <= all.size(); ++k) {
            const double F = k < all.size() ? test::plain_profile((u - all[k]) / f.radius) : 1;
            if (F > before) {
                draw[family->first] =
                    k < all.size() ? (k > 0 ? 0.5 * (all[k - 1] + all[k]) : all[0] - 1) : all[k - 1] + 1;
                total += (F - before) * sum(root, x, limits, std::next(family), draw);
            }
            before = F;
        }
        return total;
    }
    bool holds(int i, const std::map<int, double>& draw) const {
        const Node& n = nodes_[i];
        switch (n.op) {
            case Op::part: {
                const double u = draw.at(n.part.family);
                return u <= n.part.limit && !(n.part.is_distance && u < -n.part.limit);
            }
            case Op::sum:
            case Op::either: return holds(n.a, draw) || holds(n.b, draw);
            case Op::product:
            case Op::both: return holds(n.a, draw) && holds(n.b, draw);
            case Op::difference: return holds(n.a, draw) && !holds(n.b, draw);
            default: return !holds(n.a, draw);
        }
    }

    std::map<std::pair<std::string, double>, int> known_;
    std::vector<Family> families_;
    std::vector<Node> nodes_;
};

struct Both {
    Density density;
    int plain;
};

// Makes random densities in both forms. Concentric, coaxial and flush parts of one radius are frequent.
class Generator {
public:
    Generator(Gen& g) : g_(g), axis_(g.direction()), center_(g.point(0.2)) {
        radii_ = {g.between(0.05, 0.2), g.between(0.02, 0.3)};
        slope_ = g.between(0.3, 1);
    }

    PlainExpression plain;
    double radius() const { return radii_[0]; }

    // A convex part: a product or conjunction of up to three.
    Both convex(Vec3 shift) {
        Both all = part(shift);
        for (int k = g_.below(3); k > 0; --k) {
            const Both next = part(shift);
            all =
                g_.chance(0.5)
                    ? Both{all.density * next.density, plain.add({PlainExpression::Op::product, all.plain, next.plain})}
                    : Both{all.density & next.density, plain.add({PlainExpression::Op::both, all.plain, next.plain})};
        }
        return all;
    }
    // A density that is legal under the papers' operators.
    Both papers() {
        switch (g_.below(3)) {
            case 0: return convex(Vec3(0.0));
            case 1: {  // the operands are apart
                const Both a = bounded(Vec3(0.0)), b = bounded(Vec3(2.5, 0, 0));
                return {a.density + b.density, plain.add({PlainExpression::Op::sum, a.plain, b.plain})};
            }
            default: {  // the second operand is inside the first
                const Both a = ball("ball" + std::to_string(0.0), center_, 1.7, radii_[0]), b = bounded(Vec3(0.0));
                return {a.density - b.density, plain.add({PlainExpression::Op::difference, a.plain, b.plain})};
            }
        }
    }
    Both make() {
        Both all = papers();
        for (int k = g_.below(3); k > 0; --k) {
            const Both next = part(Vec3(0.0));
            switch (g_.below(3)) {
                case 0:
                    all = {all.density | next.density, plain.add({PlainExpression::Op::either, all.plain, next.plain})};
                    break;
                case 1:
                    all = {all.density & ~next.density, plain.add({PlainExpression::Op::both, all.plain,
                                                                   plain.add({PlainExpression::Op::no, next.plain})})};
                    break;
                default:
                    all = {all.density & next.density, plain.add({PlainExpression::Op::both, all.plain, next.plain})};
            }
        }
        return all;
    }

private:
    Both ball(const std::string& name, Vec3 c, double R, double r) {
        return {Density::sphere(c, R).radius(r), plain.part(
                                                     name, [=](Vec3 x) { return glm::distance(x, c); }, r, R, true)};
    }
    Both bounded(Vec3 shift) {  // within a ball of radius 1
        const Both a = convex(shift), b = ball("ball" + std::to_string(shift.x), center_ + shift, 1, radii_[0]);
        return {a.density * b.density, plain.add({PlainExpression::Op::product, a.plain, b.plain})};
    }
    int plane(const std::string& name, Vec3 n, double limit, double r) {
        return plain.part(
            name, [=](Vec3 x) { return glm::dot(n, x); }, r, limit, false);
    }
    int no(int a) { return plain.add({PlainExpression::Op::no, a}); }
    int product(int a, int b) { return plain.add({PlainExpression::Op::product, a, b}); }
    // The opposite half-space, of the same family as the plane.
    int above(const std::string& name, Vec3 n, double limit, double r) { return no(plane(name, n, limit, r)); }

    Both part(Vec3 shift) {
        const bool is_own = g_.chance(0.3);
        const double r = radii_[is_own], R = g_.chance(0.3) ? 0.5 : g_.between(0.1, 0.9);
        const std::string place = std::to_string(shift.x);
        const Vec3 c = center_ + shift, axis = axis_;
        const double at = glm::dot(axis, c), low = g_.chance(0.5) ? -0.4 : g_.between(-0.8, -0.1),
                     high = g_.chance(0.5) ? 0.4 : g_.between(0, 0.8);
        const auto given = [&](Density d) { return is_own || g_.chance(0.5) ? d.radius(r) : d; };
        switch (g_.below(5)) {
            case 0: {
                const Both b = ball("ball" + place, c, R, r);
                return {given(Density::sphere(c, R)), b.plain};
            }
            case 1: {
                const int side = plain.part(
                    "rod" + place, [=](Vec3 x) { return glm::length(glm::cross(axis, x - c)); }, r, R, true);
                return {given(Density::cylinder(c + low * axis, c + high * axis, R)),
                        product(side, product(above("axis", axis, at + low, r), plane("axis", axis, at + high, r)))};
            }
            case 2: {
                const double long_ = 1 / std::hypot(1.0, slope_), k = slope_, end = R - k * (high - low);
                const Vec3 from = c + low * axis;
                const double limit =
                    long_ * (R + k * (low + at));  // across·s + along·t, counted from the origin's height
                const auto cone = [=](double sign) {
                    return [=](Vec3 x) {
                        return long_ * (sign * glm::length(glm::cross(axis, x - c)) + k * glm::dot(axis, x));
                    };
                };
                const int nappe = product(plain.part("cone" + place, cone(1), r, limit, false),
                                          plain.part("mirrored" + place, cone(-1), r, limit, false));
                if (end <= 0)
                    return {given(Density::cone(from, from + axis * (R / k), R, 0)),
                            product(nappe, above("axis", axis, at + low, r))};
                return {given(Density::cone(from, c + high * axis, R, end)),
                        product(nappe, product(above("axis", axis, at + low, r), plane("axis", axis, at + high, r)))};
            }
            case 3: {
                const double ring = 0.6, tube = g_.between(0.1, 0.25);
                const int p = plain.part(
                    "ring" + place,
                    [=](Vec3 x) {
                        return std::hypot(glm::length(glm::cross(axis, x - c)) - ring, glm::dot(axis, x - c));
                    },
                    r, tube, true);
                return {given(Density::torus(c, axis, ring, tube)), p};
            }
            default: {
                const int k = g_.below(3);
                const Vec3 n = k == 0 ? axis : k == 1 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
                const std::string name = k == 0 ? "axis" : "plane" + std::to_string(k);
                const double d = glm::dot(n, c) + g_.between(-0.2, 0.6);
                if (g_.chance(0.5)) return {given(Density::half_space(n, d)), plane(name, n, d, r)};
                return {given(Density::half_space(-n, -d)), above(name, n, d, r)};
            }
        }
    }

    Gen& g_;
    Vec3 axis_, center_;
    std::vector<double> radii_;
    double slope_ = 0;
};

}  // namespace

TEST_CASE(
    "round parts under all operators, with radii of their own, placed and carried along, are hit where the "
    "definition says",
    "[slow]") {
    int hits = 0;
    for (auto seed : seeds(150)) {
        CAPTURE(seed);
        Gen g(seed);
        Generator make(g);
        const Both both = make.make();
        // A density's transform must keep lengths; a solid's transform may be any map and transforms its density as a
        // field.
        Affine placed, carried;
        if (g.chance(0.5)) {
            const Vec3 a = glm::normalize(g.point(1)), b = glm::normalize(glm::cross(a, g.point(1)));
            placed = {Mat3(a, b, (g.chance(0.5) ? 1.0 : -1.0) * glm::cross(a, b)), g.point(0.3)};
        }
        if (g.chance(0.5)) carried = {Mat3(1, 0.2, 0, 0, 0.8, 0, 0.1, 0, 1.3), g.point(0.3)};
        const Solid solid = Solid::rounded(make.radius(), both.density.transformed(placed)).transformed(carried);
        const ImplicitTracer tracer({solid});
        const Affine back_a{glm::inverse(carried.linear), Vec3(0.0)}, back_b{glm::inverse(placed.linear), Vec3(0.0)};
        const auto density = [&](Vec3 x) {
            return make.plain.at(both.plain, back_b.linear * (back_a.linear * (x - carried.shift) - placed.shift));
        };
        for (int k = 0; k < 12; ++k) {
            const Vec3 o = g.chance(0.3) ? g.point(0.5) : g.point(3), d = glm::normalize(g.point(0.7) - o);
            TraceCounters counters;
            const Hit hit = tracer.closest_hit({o, d}, 8, counters);
            const auto inside = [&](double t) { return density(o + t * d) > 0.5; };
            const bool start = inside(0);
            double want = infinity, before = 0;
            constexpr int steps = 400;
            for (int i = 1; i <= steps && want == infinity; ++i) {
                double now = 8.0 * i / steps;
                if (inside(now) != start) {
                    while (now - before > 1e-12) {
                        const double middle = 0.5 * (before + now);
                        (inside(middle) != start ? now : before) = middle;
                    }
                    want = now;
                }
                before = now;
            }
            // Between two samples the density may go in and out.
            if (hit.t < want && inside(hit.t - 1e-6) != inside(hit.t + 1e-6)) want = hit.t;
            hits += want < infinity;
            if (hit.t == want || std::abs(hit.t - want) < 1e-6) continue;
            CAPTURE(k, want, hit.t, density(o + hit.t * d), density(o + want * d));
            FAIL_CHECK("another crossing");
        }
    }
    CHECK(hits > 600);
}
