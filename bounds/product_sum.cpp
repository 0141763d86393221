#include "bounds/product_sum.hpp"

#include <algorithm>

#include "bounds/convex_density.hpp"

namespace deburr {

namespace {

// A weighted product of the expansion; planes and rounds are indices in Expansion's lists.
struct Product {
    double weight;
    std::vector<std::uint8_t> planes, rounds;
};

// A density's sum, multiplied out further until no round part is flipped, and the half-spaces that occur in it.
class Expansion {
public:
    explicit Expansion(const LocalDensity& density)
        : half_spaces_(density.half_spaces()),
          plane_of_(2 * half_spaces_.size(), -1),
          round_of_(half_spaces_.size(), -1) {}

    // Adds a weighted product; false if one of its round parts is not convex.
    bool add(const LocalDensity::Sum::Term& term) {
        std::vector<Product> parts{{term.weight, {}, {}}};
        for (const auto& [i, flipped] : term.factors) {
            const HalfSpace& h = half_spaces_[i];
            if (h.round && !h.round->is_convex()) return false;
            const std::uint8_t number = number_of(i, flipped);
            if (h.round && flipped)
                subtract_products(parts, number);
            else
                for (Product& part : parts) (h.round ? part.rounds : part.planes).push_back(number);
        }
        for (Product& part : parts) {
            if (part.planes.empty() && part.rounds.empty())
                constant += part.weight;
            else
                products.push_back(std::move(part));
        }
        return true;
    }

    bool is_small() const {
        return products.size() <= std::size_t(ProductSum::max_terms) &&
               rounds.size() <= std::size_t(ProductSum::max_rounds) &&
               planes.size() + rounds.size() <= std::size_t(ProductSum::max_planes);
    }

    double constant = 0;
    std::vector<Product> products;
    std::vector<AlphaPlane> planes;
    std::vector<ProductSum::Round> rounds;
    double steepest = 0;  // the greatest |∇α| of a half-space

private:
    // The index of the half-space in `planes` or `rounds`, to which it is appended if it is new.
    std::uint8_t number_of(int i, bool flipped) {
        const HalfSpace& h = half_spaces_[i];
        int& number = h.round ? round_of_[std::size_t(i)] : plane_of_[2 * std::size_t(i) + flipped];
        if (number >= 0) return std::uint8_t(number);
        steepest = std::max(steepest, 1 / h.radius);
        number = int(h.round ? rounds.size() : planes.size());
        if (h.round)
            rounds.push_back({*h.round, h.offset, 1 / h.radius});
        else
            planes.push_back(alpha_plane(h, flipped));
        return std::uint8_t(number);
    }

    // Multiplies by 1 − F, P (1 − F) = P − P F, because of the two sides of a round part only one is convex.
    static void subtract_products(std::vector<Product>& parts, std::uint8_t round) {
        const std::size_t before = parts.size();
        for (std::size_t k = 0; k < before; ++k) {
            Product other = parts[k];
            other.weight = -other.weight;
            other.rounds.push_back(round);
            parts.push_back(std::move(other));
        }
    }

    const std::vector<HalfSpace>& half_spaces_;
    std::vector<int> plane_of_, round_of_;  // index of each half-space in `planes` (as it is, and flipped) and in
                                            // `rounds`; −1: not there yet
};

// The terms of the sum, with a reach of infinity; the list is empty if a term has too many factors.
std::vector<ProductSum::Term> terms_of(Expansion& sum) {
    std::vector<ProductSum::Term> terms;
    for (Product& product : sum.products) {
        ProductSum::Term term{product.weight, std::move(product.planes), infinity};
        for (const std::uint8_t round : product.rounds) term.factors.push_back(std::uint8_t(sum.planes.size() + round));
        if (term.factors.size() > std::size_t(ProductSum::max_planes)) return {};
        terms.push_back(std::move(term));
    }
    return terms;
}

// ProductSum::coefficients(0 … 3), one after the other, for `n` planes; the last is 0 if there are fewer.
std::vector<double> coefficients_of(const std::vector<AlphaPlane>& planes, std::size_t n) {
    std::vector<double> all(4 * n, 0.0);
    for (std::size_t i = 0; i < planes.size(); ++i) {
        for (int k = 0; k < 3; ++k) all[std::size_t(k) * n + i] = planes[i].slope[k];
        all[3 * n + i] = planes[i].base;
    }
    return all;
}

// Sets each term's reach. On ρ = ½ the terms with the sign of `missing` = ½ − c make up for it together: of m such
// terms one is at least missing/m, and so is each of its factors (divided by the weight). `clearance` is in α.
void set_reaches(std::vector<ProductSum::Term>& terms, double missing, double clearance) {
    const auto helps = [&](const ProductSum::Term& term) { return missing * term.weight > 0; };
    const auto helpers = double(std::count_if(terms.begin(), terms.end(), helps));
    for (ProductSum::Term& term : terms)
        if (helps(term)) term.reach = displacement(missing / (helpers * term.weight) - inverse_slack) + clearance;
}

}  // namespace

std::optional<ProductSum> ProductSum::of(const LocalDensity& density, double clearance) {
    if (density.has_sharp()) return std::nullopt;
    const auto expanded = density.as_sum(std::size_t(max_terms));
    if (!expanded || expanded->terms.empty()) return std::nullopt;
    Expansion expansion(density);
    expansion.constant = expanded->constant;
    for (const LocalDensity::Sum::Term& term : expanded->terms)
        if (!expansion.add(term)) return std::nullopt;
    if (!expansion.is_small()) return std::nullopt;
    ProductSum sum;
    sum.terms_ = terms_of(expansion);
    if (sum.terms_.size() < expansion.products.size()) return std::nullopt;
    sum.constant_ = expansion.constant;
    sum.rounds_ = std::move(expansion.rounds);
    sum.planes_ = int(expansion.planes.size());
    sum.coefficients_ = coefficients_of(expansion.planes, std::size_t(sum.even_planes()));
    const double missing = 0.5 - sum.constant_;
    sum.anywhere_ = missing == 0;
    set_reaches(sum.terms_, missing, clearance * expansion.steepest);
    return sum;
}

}  // namespace deburr
