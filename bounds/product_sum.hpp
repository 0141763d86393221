// Densities multiplied out, ρ = c + Σ wₖ Pₖ with few products Pₖ of half-spaces and convex round parts: what edges and
// corners are that are no product themselves, the rim of a hole (P − Q) before all. Where a ray crosses ρ = ½.
//
// Along a ray log Pₖ is concave (convex_density.hpp, round_product.hpp), so ℓ = Pₖ′/Pₖ falls: between two points a < b
//
//     ℓ(b) ≤ Pₖ′/Pₖ ≤ ℓ(a)   and   min(Pₖ(a), Pₖ(b)) ≤ Pₖ ≤ Pₖ(a) exp(ℓ(a)(t − a)), Pₖ(b) exp(ℓ(b)(t − b)),
//
// which bounds every Pₖ′, hence f′ of f = ρ − ½, by what was evaluated anyway. A stretch in which f′ has
// one sign holds one crossing at most; one at whose ends f has the same sign holds none if f′ is too
// small in between. What is neither is halved. So the first crossing is found as surely as by M, L and
// G (root_finder.hpp), in fewer steps, and none of them looks at each half-space but to evaluate.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "bounds/local_density.hpp"
#include "bounds/root_finder.hpp"
#include "bounds/round_coordinate.hpp"

namespace deburr {

class ProductSum {
public:
    static constexpr int max_terms = 6;
    static constexpr int max_planes = 32;  // and round parts among them
    static constexpr int max_rounds = 4;

    struct Term {
        double weight;
        std::vector<std::uint8_t> factors;  // planes, then round parts from planes() on; one may occur twice
        double reach;                       // the surface is where some term with a finite one has no α beyond it
    };

    /// A round part with a convex coordinate: α = (u − offset)·inverse_radius.
    struct Round {
        RoundCoordinate coordinate;
        double offset, inverse_radius;
    };

    /// The density in that form, if it has it: nothing is sharp, round parts are convex, and terms are few.
    /// `clearance`: as bound planes keep clear (csg_bounds.hpp).
    static std::optional<ProductSum> of(const LocalDensity& density, double clearance);

    int planes() const { return planes_; }
    const std::vector<Round>& rounds() const { return rounds_; }
    const std::vector<Term>& terms() const { return terms_; }
    double constant() const { return constant_; }
    bool anywhere() const { return anywhere_; }  // no term's reach says where the surface is
    /// Coordinate k of the gradient of every α; k = 3: α at the origin. As many as even_planes().
    const double* coefficients(int k) const { return coefficients_.data() + k * even_planes(); }
    int even_planes() const { return planes_ + (planes_ & 1); }

private:
    int planes_ = 0;
    std::vector<double> coefficients_;
    std::vector<Round> rounds_;
    std::vector<Term> terms_;
    double constant_ = 0;
    bool anywhere_ = false;
};

/// A ray's view of it. Keeps its memory; to be used again and again.
class ProductSumRay {
public:
    void set(const ProductSum& sum, const Vec3& origin, const Vec3& direction);

    /// ρ > ½?
    bool inside(double t) const;
    /// All crossings of ρ = ½ in [t0, t1], in order, to within `t_tolerance`; `coarse`: no matter where
    /// exactly. visit(RootCrossing) says whether to go on.
    template <class Visit>
    void crossings(double t0, double t1, double t_tolerance, bool coarse, RootCounters& counters, Visit visit);

    Vec3 gradient(double t) const;

    /// f and its slope at a point of the ray.
    struct Point {
        double t, f, slope;
        double value[ProductSum::max_terms], rate[ProductSum::max_terms];  // of every Pₖ that varies
    };
    struct SlopeRange {
        double lo, hi;
    };

    // The steps of the search.
    /// Cuts [t0, t1] down to where the surface can be, and the factors to those whose densities vary there;
    /// false if nothing is left.
    bool narrow(double& t0, double& t1);
    /// evaluate() and slopes() are valid only within the interval that narrow() left.
    void evaluate(double t, RootCounters& counters, Point& point) const;
    SlopeRange slopes(const Point& a, const Point& b) const;  // f′ between two points, a before b

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
        std::uint8_t factors[max_planes];  // as many planes as `count` says, then round parts
    };

    const ProductSum* sum_ = nullptr;
    alignas(16) double a_[max_planes], b_[max_planes];  // every α = a + b·t
    RoundOnRay on_ray_[max_rounds];
    Vec3 origin_{0.0}, direction_{0.0};
    // Of those that vary.
    alignas(16) double varying_a_[max_planes + 1], varying_b_[max_planes + 1];
    int varying_ = 0, terms_ = 0;
    Term term_[ProductSum::max_terms];
    double constant_ = 0;   // the rest of f
    double curvature_ = 0;  // |f″| at most
    std::vector<Point> stack_;
};

/// Whether a function with the signs and slopes of these ends, and with slopes between them in the
/// range, has at most one root between them; as far as |f| > 2 · `f_tolerance`.
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
