// Densities multiplied out, ρ = c + Σ wₖ Pₖ with few products Pₖ of half-spaces and convex round parts, and where a ray
// crosses ρ = ½. Edges and corners that are not a product themselves have this form, above all the rim of a hole,
// P − Q.
//
// Along a ray log Pₖ is concave (convex_density.hpp, round_product.hpp), so ℓ = Pₖ′/Pₖ falls: between two points a < b
//
//     ℓ(b) ≤ Pₖ′/Pₖ ≤ ℓ(a)   and   min(Pₖ(a), Pₖ(b)) ≤ Pₖ ≤ Pₖ(a) exp(ℓ(a)(t − a)), Pₖ(b) exp(ℓ(b)(t − b)),
//
// This bounds every Pₖ′, and so f′ of f = ρ − ½, by values that were computed anyway. A segment in which f′ has one
// sign holds one crossing at most; one at whose ends f has the same sign holds none if f′ is too small in between. Any
// other segment is halved. So the first crossing is found as surely as with M, L and G (root_finder.hpp), in fewer
// steps, each of which does nothing for a half-space but evaluate it.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "bounds/local_density.hpp"
#include "bounds/root_finder.hpp"
#include "bounds/round_coordinate.hpp"

namespace deburr {

/// The density, immutable after construction.
class ProductSum {
public:
    static constexpr int max_terms = 6;
    static constexpr int max_planes = 32;  // planes and round parts together
    static constexpr int max_rounds = 4;

    /// One product wₖ Pₖ.
    struct Term {
        double weight;
        std::vector<std::uint8_t> factors;  // indices: planes, then round parts from planes() on; an index may occur
                                            // twice
        double reach;  // on ρ = ½, α ≤ reach for all factors of some term with a finite reach (unless anywhere())
    };

    /// A round part with a convex coordinate: α = (u − offset)·inverse_radius.
    struct Round {
        RoundCoordinate coordinate;
        double offset, inverse_radius;
    };

    /// The density in that form, if it has it: nothing is sharp, round parts are convex, and there are at most as many
    /// terms and half-spaces as above. `clearance` is the world distance by which bound planes are displaced
    /// (csg_bounds.hpp).
    static std::optional<ProductSum> of(const LocalDensity& density, double clearance);

    int planes() const { return planes_; }
    const std::vector<Round>& rounds() const { return rounds_; }
    const std::vector<Term>& terms() const { return terms_; }
    double constant() const { return constant_; }
    bool anywhere() const { return anywhere_; }  // the reaches do not bound the surface
    /// Coefficient k of every plane's α: coordinate k of its gradient, or for k = 3 its value at the origin. The array
    /// has even_planes() elements.
    const double* coefficients(int k) const { return coefficients_.data() + k * even_planes(); }
    /// planes(), rounded up to an even number.
    int even_planes() const { return planes_ + (planes_ & 1); }

private:
    int planes_ = 0;
    std::vector<double> coefficients_;
    std::vector<Round> rounds_;
    std::vector<Term> terms_;
    double constant_ = 0;
    bool anywhere_ = false;
};

/// A ProductSum along a ray o + t·d. The object keeps its memory, so it is cheap to set again and again.
class ProductSumRay {
public:
    /// Sets the ray. Keeps a reference to `sum`.
    void set(const ProductSum& sum, const Vec3& origin, const Vec3& direction);

    /// Whether ρ > ½ at t.
    bool inside(double t) const;
    /// Finds all crossings of ρ = ½ in [t0, t1], in order, to within `t_tolerance` in t; with `coarse` their t may be
    /// anywhere in the bracketing segment. visit(RootCrossing) returns whether to go on. t1 may be infinite.
    template <class Visit>
    void crossings(double t0, double t1, double t_tolerance, bool coarse, RootCounters& counters, Visit visit);

    /// ∇ρ at o + t·d.
    Vec3 gradient(double t) const;

    /// f = ρ − ½ and its slope f′ at a point of the ray.
    struct Point {
        double t, f, slope;
        // of every Pₖ that varies: value and derivative
        double value[ProductSum::max_terms], rate[ProductSum::max_terms];
    };
    struct SlopeRange {
        double lo, hi;
    };

    // The steps of the search.
    /// Cuts [t0, t1] down to where the surface can be, and the factors to those whose densities vary there; false if
    /// nothing is left.
    bool narrow(double& t0, double& t1);
    /// Evaluates f at t, which must lie in the interval that narrow() left; so must the arguments of slopes().
    void evaluate(double t, RootCounters& counters, Point& point) const;
    SlopeRange slopes(const Point& a, const Point& b) const;  // range of f′ between a and b, a.t < b.t

private:
    void reach(const ProductSum::Term& term, double& lo, double& hi) const;
    double last_change(double t0) const;
    bool choose_varying(double t0, double t1);
    double round_alpha(int i, double t) const {
        const ProductSum::Round& r = sum_->rounds()[std::size_t(i)];
        return (on_ray_[i].at(t) - r.offset) * r.inverse_radius;
    }
    double alpha(int factor, double t) const {
        const int round = factor - sum_->planes();
        return round < 0 ? a_[factor] + b_[factor] * t : round_alpha(round, t);
    }
    SlopeRange slopes_near_zero(int term, const Point& a, const Point& b) const;
    void densities(double t, double* F, double* slope) const;
    double root(const Point& from, const Point& until, double t_tolerance, RootCounters& counters) const;

    static constexpr int max_planes = ProductSum::max_planes;
    static constexpr int max_rounds = ProductSum::max_rounds;
    struct Term {
        double weight;
        int count, rounds;
        std::uint8_t factors[max_planes];  // `count` planes, then `rounds` round parts
    };

    const ProductSum* sum_ = nullptr;
    alignas(16) double a_[max_planes], b_[max_planes];  // α of every plane is a + b·t
    RoundOnRay on_ray_[max_rounds];
    Vec3 origin_{0.0}, direction_{0.0};
    // Factors and terms that vary in the interval that narrow() left.
    alignas(16) double varying_a_[max_planes + 1], varying_b_[max_planes + 1];
    int varying_ = 0, terms_ = 0;
    Term term_[ProductSum::max_terms];
    double constant_ = 0;   // f without the terms that vary
    double curvature_ = 0;  // upper bound of |f″|
    std::vector<Point> stack_;
};

/// True if every function with the values and slopes of these ends, whose slopes between them lie in the range, has at
/// most one root between them; roots where |f| stays below 2 · `f_tolerance` do not count.
bool at_most_one_root(const ProductSumRay::Point& a, const ProductSumRay::Point& b, ProductSumRay::SlopeRange slopes,
                      double f_tolerance);

template <class Visit>
void ProductSumRay::crossings(double t0, double t1, double t_tolerance, bool coarse, RootCounters& counters,
                              Visit visit) {
    if (!narrow(t0, t1)) return;
    constexpr double f_tolerance = RootSettings{}.f_tolerance;
    stack_.clear();
    Point a;
    evaluate(t0, counters, a);
    evaluate(t1, counters, stack_.emplace_back());
    while (!stack_.empty()) {
        const Point& b = stack_.back();
        ++counters.segments;
        if (b.t - a.t > t_tolerance && !at_most_one_root(a, b, slopes(a, b), f_tolerance)) {
            const double middle = a.t + 0.5 * (b.t - a.t);
            if (middle > a.t && middle < b.t) {
                ++counters.splits;
                evaluate(middle, counters, stack_.emplace_back());
                continue;
            }
        }
        if ((a.f > 0) != (b.f > 0) && !visit(RootCrossing{coarse ? b.t : root(a, b, t_tolerance, counters), b.f > 0}))
            return;
        a = b;
        stack_.pop_back();
    }
}

}  // namespace deburr
