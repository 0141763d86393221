// What a local density is, read off its steps: a product of half-spaces, a sum of such products.
#include <algorithm>

#include "bounds/local_density.hpp"

namespace deburr {

std::optional<LocalDensity::Product> LocalDensity::as_product() const {
    if (share_) return std::nullopt;
    std::vector<std::optional<Product>> form;
    const auto complement = [](std::optional<Product> p) {
        if (!p) return p;
        if (p->factors.size() == 1) p->factors[0].flipped = !p->factors[0].flipped;
        else p->complement = !p->complement;
        return p;
    };
    const auto times = [](std::optional<Product> a, const std::optional<Product>& b) {
        if (!a || !b || a->complement || b->complement) return std::optional<Product>();
        a->factors.insert(a->factors.end(), b->factors.begin(), b->factors.end());
        return a;
    };
    const auto is = [&](int child, double value) {
        const Node& n = nodes_[std::size_t(child)];
        return n.step == Step::constant && n.value == value;
    };
    for (const Node& n : nodes_) {
        const auto at = [&](int child) { return form[std::size_t(child)]; };
        std::optional<Product> p;
        switch (n.step) {
            case Step::half_space: p = Product{{{n.a, false}}}; break;
            case Step::product: p = times(at(n.a), at(n.b)); break;
            case Step::complement: p = complement(at(n.a)); break;
            case Step::decide: {
                if (n.b != 1) break;
                const int below = kids_[std::size_t(n.a) + 1], above = kids_[std::size_t(n.a) + 2];
                const Product F{{{kids_[std::size_t(n.a)], false}}}, G{{{kids_[std::size_t(n.a)], true}}};
                if (is(above, 0)) p = times(F, at(below));
                else if (is(below, 0)) p = times(G, at(above));
                else if (is(below, 1)) p = complement(times(G, complement(at(above))));
                else if (is(above, 1)) p = complement(times(F, complement(at(below))));
                break;
            }
            default: break;
        }
        form.push_back(std::move(p));
    }
    return form.back();
}

bool LocalDensity::is_affine_in_each(const std::vector<int>& variable_of) const {
    if (share_) return false;
    // Degrees, node by node, variable by variable.
    std::vector<std::vector<int>> degree;
    for (const Node& n : nodes_) {
        std::vector<int> d(variable_of.size(), 0);
        const auto at = [&](int child, std::size_t v) { return degree[std::size_t(child)][v]; };
        for (std::size_t v = 0; v < d.size(); ++v) {
            switch (n.step) {
                case Step::constant: break;
                case Step::half_space: d[v] = variable_of[std::size_t(n.a)] == int(v); break;
                case Step::sum:
                case Step::difference: d[v] = std::max(at(n.a, v), at(n.b, v)); break;
                case Step::product: d[v] = at(n.a, v) + at(n.b, v); break;
                case Step::complement: d[v] = at(n.a, v); break;
                case Step::decide: {
                    const int* thresholds = &kids_[std::size_t(n.a)];
                    const int* children = thresholds + n.b;
                    for (int j = 0; j <= n.b; ++j) d[v] = std::max(d[v], at(children[j], v));
                    for (int j = 0; j < n.b; ++j)
                        if (variable_of[std::size_t(thresholds[j])] == int(v)) ++d[v];
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

// A product's factors as sorted numbers: twice the half-space, and one more if it is flipped.
struct Monomial {
    double weight = 1;
    std::vector<int> factors;
};
using Polynomial = std::vector<Monomial>;

// Where b has one factor more than a, that factor; else −1.
int one_more(const std::vector<int>& a, const std::vector<int>& b) {
    if (b.size() != a.size() + 1) return -1;
    const auto [in_a, in_b] = std::mismatch(a.begin(), a.end(), b.begin());
    return std::equal(in_a, a.end(), in_b + 1) ? *in_b : -1;
}

void insert_sorted(std::vector<int>& all, int value) {
    all.insert(std::lower_bound(all.begin(), all.end(), value), value);
}

// Puts two terms into the first, if that can be: equal products, M − M·F = M·(1 − F).
bool join(Monomial& a, const Monomial& b) {
    if (a.factors == b.factors) {
        a.weight += b.weight;
        return true;
    }
    if (a.weight != -b.weight) return false;
    const int more_in_b = one_more(a.factors, b.factors), more_in_a = one_more(b.factors, a.factors);
    if (more_in_b < 0 && more_in_a < 0) return false;
    if (more_in_a >= 0) a = b;
    insert_sorted(a.factors, std::max(more_in_a, more_in_b) ^ 1);
    return true;
}

void join_to(Polynomial& sum, Monomial m) {
    for (std::size_t i = 0; i < sum.size();) {
        if (!join(m, sum[i])) {
            ++i;
            continue;
        }
        sum.erase(sum.begin() + std::ptrdiff_t(i));
        i = 0;  // what has become of m may join with others
    }
    if (m.weight != 0) sum.push_back(std::move(m));
}

Polynomial plus(Polynomial a, const Polynomial& b, double sign) {
    for (Monomial m : b) {
        m.weight *= sign;
        join_to(a, std::move(m));
    }
    return a;
}

Polynomial times(const Polynomial& a, const Polynomial& b) {
    Polynomial all;
    for (const Monomial& x : a)
        for (const Monomial& y : b) {
            Monomial m{x.weight * y.weight, x.factors};
            for (const int f : y.factors) insert_sorted(m.factors, f);
            join_to(all, std::move(m));
        }
    return all;
}

}  // namespace

std::optional<LocalDensity::Sum> LocalDensity::as_sum(std::size_t most_terms) const {
    if (share_) return std::nullopt;
    // Coinciding half-spaces are one.
    std::vector<int> first(half_spaces_.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        const HalfSpace& h = half_spaces_[i];
        const auto same = [&](const HalfSpace& g) {
            return g.normal == h.normal && g.offset == h.offset && g.radius == h.radius;
        };
        first[i] = int(std::find_if(half_spaces_.begin(), half_spaces_.end(), same) - half_spaces_.begin());
    }
    const auto leaf = [&](int half_space) { return Polynomial{{1, {2 * first[std::size_t(half_space)]}}}; };
    const Polynomial one{{1, {}}};
    std::vector<Polynomial> form;
    for (const Node& n : nodes_) {
        const auto at = [&](int child) -> const Polynomial& { return form[std::size_t(child)]; };
        Polynomial p;
        switch (n.step) {
            case Step::constant: join_to(p, {n.value, {}}); break;
            case Step::half_space: p = leaf(n.a); break;
            case Step::sum: p = plus(at(n.a), at(n.b), 1); break;
            case Step::difference: p = plus(at(n.a), at(n.b), -1); break;
            case Step::product: p = times(at(n.a), at(n.b)); break;
            case Step::complement: p = plus(one, at(n.a), -1); break;
            case Step::decide: {
                const int* thresholds = &kids_[std::size_t(n.a)];
                const int* children = thresholds + n.b;
                p = at(children[n.b]);
                for (int j = 0; j < n.b; ++j)
                    p = plus(p, times(leaf(thresholds[j]), plus(at(children[j]), at(children[j + 1]), -1)), 1);
                break;
            }
        }
        if (p.size() > 2 * most_terms) return std::nullopt;  // it would hardly become fewer
        form.push_back(std::move(p));
    }
    if (form.back().size() > most_terms + 1) return std::nullopt;
    Sum sum;
    for (const Monomial& m : form.back()) {
        if (m.factors.empty()) {
            sum.constant = m.weight;
            continue;
        }
        Sum::Term term{m.weight, {}};
        for (const int f : m.factors) term.factors.push_back({f / 2, f % 2 == 1});
        sum.terms.push_back(std::move(term));
    }
    if (sum.terms.size() > most_terms) return std::nullopt;
    return sum;
}

}  // namespace deburr
