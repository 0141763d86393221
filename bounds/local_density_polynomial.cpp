// A local density as a polynomial in the densities of its half-spaces: a single product, or a sum of products.
#include <algorithm>

#include "bounds/local_density.hpp"

namespace deburr {

std::optional<LocalDensity::Product> LocalDensity::as_product() const {
    if (convolution_ || field_) return std::nullopt;
    std::vector<std::optional<Product>> expanded;
    const auto complement = [](std::optional<Product> p) {
        if (!p) return p;
        if (p->factors.size() == 1)
            p->factors[0].flipped = !p->factors[0].flipped;
        else
            p->complement = !p->complement;
        return p;
    };
    const auto times = [](std::optional<Product> a, const std::optional<Product>& b) {
        if (!a || !b || a->complement || b->complement) return std::optional<Product>();
        a->factors.insert(a->factors.end(), b->factors.begin(), b->factors.end());
        return a;
    };
    const auto is = [&](int child, double value) {
        const Node& n = nodes_[child];
        return n.step == Step::constant && n.value == value;
    };
    for (const Node& n : nodes_) {
        const auto at = [&](int child) { return expanded[child]; };
        std::optional<Product> p;
        switch (n.step) {
            case Step::half_space: p = Product{{{n.a, false}}}; break;
            case Step::product: p = times(at(n.a), at(n.b)); break;
            case Step::complement: p = complement(at(n.a)); break;
            case Step::decision: {
                if (n.b != 1) break;
                const int below = children_[std::size_t(n.a) + 1], above = children_[std::size_t(n.a) + 2];
                const Product F{{{children_[n.a], false}}}, G{{{children_[n.a], true}}};
                if (is(above, 0))
                    p = times(F, at(below));
                else if (is(below, 0))
                    p = times(G, at(above));
                else if (is(below, 1))
                    p = complement(times(G, complement(at(above))));
                else if (is(above, 1))
                    p = complement(times(F, complement(at(below))));
                break;
            }
            default: break;
        }
        expanded.push_back(std::move(p));
    }
    return expanded.back();
}

bool LocalDensity::is_affine_in_each(const std::vector<int>& variable_of) const {
    if (convolution_ || field_) return false;
    // Degrees by node and variable.
    std::vector<std::vector<int>> degree;
    for (const Node& n : nodes_) {
        std::vector<int> d(variable_of.size(), 0);
        const auto at = [&](int child, std::size_t v) { return degree[child][v]; };
        for (std::size_t v = 0; v < d.size(); ++v) {
            switch (n.step) {
                case Step::constant: break;
                case Step::half_space: d[v] = variable_of[n.a] == int(v); break;
                case Step::sum:
                case Step::difference: d[v] = std::max(at(n.a, v), at(n.b, v)); break;
                case Step::product: d[v] = at(n.a, v) + at(n.b, v); break;
                case Step::complement: d[v] = at(n.a, v); break;
                case Step::decision: {
                    const int* thresholds = &children_[n.a];
                    const int* children = thresholds + n.b;
                    for (int j = 0; j <= n.b; ++j) d[v] = std::max(d[v], at(children[j], v));
                    for (int j = 0; j < n.b; ++j)
                        if (variable_of[thresholds[j]] == int(v)) ++d[v];
                    break;
                }
            }
            if (d[v] > 1) return false;
        }
        degree.push_back(std::move(d));
    }
    return true;
}

namespace {

// Whether the densities of both are functions of one coordinate: the same round one, or those of planes, whose normals
// are compared elsewhere.
bool same_coordinate(const HalfSpace& a, const HalfSpace& b) {
    return a.round && b.round ? a.round->is_same(*b.round) : !a.round && !b.round;
}

// A weighted product. Factors are sorted numbers: twice the half-space's index, plus one if it is flipped (1 − F).
struct Monomial {
    double weight = 1;
    std::vector<int> factors;
};
using Polynomial = std::vector<Monomial>;

// Multiplies polynomials out, using what is known of parallel planes whose filters do not overlap: where F ⊂ G are
// nested, F·G = F and G − F = G·(1 − F); where they are disjoint, F·G = 0.
class Multiplier {
public:
    explicit Multiplier(const std::vector<HalfSpace>& half_spaces) {
        const std::size_t n = half_spaces.size();
        first_.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            const HalfSpace& h = half_spaces[i];
            const auto same = [&](const HalfSpace& g) {
                return same_coordinate(g, h) && g.normal == h.normal && g.offset == h.offset && g.radius == h.radius;
            };
            first_[i] = int(std::find_if(half_spaces.begin(), half_spaces.end(), same) - half_spaces.begin());
        }
        // Extent of a factor along the plane's normal or the round part's coordinate: where it is above 0, and where it
        // is 1.
        const auto factor = [&](std::size_t f) {
            const HalfSpace& h = half_spaces[f / 2];
            const bool above = f % 2 == 1;
            return above ? Extent{h.normal, {h.offset - h.radius, infinity}, {h.offset + h.radius, infinity}}
                         : Extent{h.normal, {-infinity, h.offset + h.radius}, {-infinity, h.offset - h.radius}};
        };
        relation_.assign(4 * n * n, Relation::none);
        for (std::size_t f = 0; f < 2 * n; ++f)
            for (std::size_t g = 0; g < 2 * n; ++g) {
                if (!same_coordinate(half_spaces[f / 2], half_spaces[g / 2])) continue;
                const Extent F = factor(f), G = half_spaces[f / 2].round ? factor(g) : factor(g).along(F.normal);
                if (G.normal != F.normal) continue;
                if (F.some.lo >= G.full.lo && F.some.hi <= G.full.hi)
                    relation_[2 * n * f + g] = Relation::within;
                else if (F.some.lo >= G.some.hi || F.some.hi <= G.some.lo)
                    relation_[2 * n * f + g] = Relation::apart;
            }
    }

    Polynomial leaf(int half_space) const { return {{1, {2 * first_[half_space]}}}; }

    Polynomial plus(Polynomial a, const Polynomial& b, double sign) const {
        for (Monomial m : b) {
            m.weight *= sign;
            add(a, std::move(m));
        }
        return a;
    }

    Polynomial times(const Polynomial& a, const Polynomial& b) const {
        Polynomial all;
        for (const Monomial& x : a)
            for (const Monomial& y : b) {
                Monomial m{x.weight * y.weight, x.factors};
                for (const int f : y.factors) multiply(m, f);
                add(all, std::move(m));
            }
        return all;
    }

private:
    enum class Relation : char { none, within, apart };
    struct Extent {
        Vec3 normal;
        struct {
            double lo, hi;
        } some, full;
        Extent along(Vec3 n) const {
            if (n != -normal) return *this;
            return {n, {-some.hi, -some.lo}, {-full.hi, -full.lo}};
        }
    };
    Relation relation(int f, int g) const { return relation_[2 * first_.size() * std::size_t(f) + std::size_t(g)]; }

    void multiply(Monomial& m, int f) const {
        for (const int g : m.factors) {
            if (relation(g, f) == Relation::within) return;
            if (relation(g, f) == Relation::apart) m.weight = 0;
        }
        std::erase_if(m.factors, [&](int g) { return relation(f, g) == Relation::within; });
        m.factors.insert(std::lower_bound(m.factors.begin(), m.factors.end(), f), f);
    }

    // If b = −a·F for some factor F, a becomes a·(1 − F), the sum of both.
    bool take_away(Monomial& a, const Monomial& b) const {
        for (const int f : b.factors) {
            Monomial m = a;
            multiply(m, f);
            if (m.factors != b.factors || m.weight != -b.weight) continue;
            multiply(a, f ^ 1);
            return true;
        }
        return false;
    }

    // Replaces a by a + b if that is a monomial.
    bool join(Monomial& a, const Monomial& b) const {
        if (a.factors == b.factors) {
            a.weight += b.weight;
            return true;
        }
        if (a.weight != -b.weight) return false;
        if (take_away(a, b)) return true;
        Monomial other = b;
        if (!take_away(other, a)) return false;
        a = std::move(other);
        return true;
    }

    void add(Polynomial& sum, Monomial m) const {
        for (std::size_t i = 0; i < sum.size();) {
            if (!join(m, sum[i])) {
                ++i;
                continue;
            }
            sum.erase(sum.begin() + std::ptrdiff_t(i));
            i = 0;  // the new m may join with others
        }
        if (m.weight != 0) sum.push_back(std::move(m));
    }

    std::vector<int> first_;  // first_[i]: the first half-space that coincides with i
    std::vector<Relation> relation_;
};

}  // namespace

std::optional<LocalDensity::Sum> LocalDensity::as_sum(std::size_t max_terms) const {
    constexpr std::size_t max_compared = 64;  // half-spaces; all pairs are compared
    if (convolution_ || field_ || half_spaces_.size() > max_compared) return std::nullopt;
    const Multiplier multiplier(half_spaces_);
    const Polynomial one{{1, {}}};
    std::vector<Polynomial> expanded;
    for (const Node& n : nodes_) {
        const auto at = [&](int child) -> const Polynomial& { return expanded[child]; };
        Polynomial p;
        switch (n.step) {
            case Step::constant:
                if (n.value != 0) p = {{n.value, {}}};
                break;
            case Step::half_space: p = multiplier.leaf(n.a); break;
            case Step::sum: p = multiplier.plus(at(n.a), at(n.b), 1); break;
            case Step::difference: p = multiplier.plus(at(n.a), at(n.b), -1); break;
            case Step::product: p = multiplier.times(at(n.a), at(n.b)); break;
            case Step::complement: p = multiplier.plus(one, at(n.a), -1); break;
            case Step::decision: {
                const int* thresholds = &children_[n.a];
                const int* children = thresholds + n.b;
                p = at(children[n.b]);
                for (int j = 0; j < n.b; ++j) {
                    const Polynomial step = multiplier.plus(at(children[j]), at(children[j + 1]), -1);
                    p = multiplier.plus(p, multiplier.times(multiplier.leaf(thresholds[j]), step), 1);
                }
                break;
            }
        }
        if (p.size() > 2 * max_terms) return std::nullopt;  // it would hardly shrink again
        expanded.push_back(std::move(p));
    }
    if (expanded.back().size() > max_terms + 1) return std::nullopt;
    Sum sum;
    for (const Monomial& m : expanded.back()) {
        if (m.factors.empty()) {
            sum.constant = m.weight;
            continue;
        }
        Sum::Term term{m.weight, {}};
        for (const int f : m.factors) term.factors.push_back({f / 2, f % 2 == 1});
        sum.terms.push_back(std::move(term));
    }
    if (sum.terms.size() > max_terms) return std::nullopt;
    return sum;
}

}  // namespace deburr
