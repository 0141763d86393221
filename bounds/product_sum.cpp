#include "bounds/product_sum.hpp"

#include <algorithm>

#include "bounds/convex_density.hpp"

namespace deburr {

std::optional<ProductSum> ProductSum::of(const LocalDensity& density, double clearance) {
    if (density.has_sharp()) return std::nullopt;
    const auto expanded = density.as_sum(std::size_t(max_terms));
    if (!expanded || expanded->terms.empty()) return std::nullopt;
    ProductSum sum;
    sum.constant_ = expanded->constant;
    std::vector<AlphaPlane> planes;
    std::vector<int> plane_of(2 * density.half_spaces().size(), -1), round_of(density.half_spaces().size(), -1);
    double steepest = 0;
    struct Split {
        double weight;
        std::vector<std::uint8_t> planes, rounds;
    };
    std::vector<Split> terms;
    for (const auto& [weight, factors] : expanded->terms) {
        std::vector<Split> parts{{weight, {}, {}}};
        for (const auto& [i, flipped] : factors) {
            const HalfSpace& h = density.half_spaces()[i];
            if (h.round && !h.round->is_convex()) return std::nullopt;
            int& at = h.round ? round_of[std::size_t(i)] : plane_of[2 * std::size_t(i) + flipped];
            if (at < 0) {
                steepest = std::max(steepest, 1 / h.radius);
                at = int(h.round ? sum.rounds_.size() : planes.size());
                if (h.round)
                    sum.rounds_.push_back({*h.round, h.offset, 1 / h.radius});
                else
                    planes.push_back(alpha_plane(h, flipped));
            }
            const std::size_t before = parts.size();
            for (std::size_t k = 0; k < before; ++k) {
                if (h.round && flipped) {  // P (1 − F) = P − P F: of the two sides of a round part one is convex
                    Split other = parts[k];
                    other.weight = -other.weight;
                    other.rounds.push_back(std::uint8_t(at));
                    parts.push_back(std::move(other));
                } else {
                    (h.round ? parts[k].rounds : parts[k].planes).push_back(std::uint8_t(at));
                }
            }
        }
        for (Split& part : parts) {
            if (part.planes.empty() && part.rounds.empty())
                sum.constant_ += part.weight;
            else
                terms.push_back(std::move(part));
        }
    }
    if (terms.size() > std::size_t(max_terms) || sum.rounds_.size() > std::size_t(max_rounds) ||
        planes.size() + sum.rounds_.size() > std::size_t(max_planes))
        return std::nullopt;
    for (Split& part : terms) {
        Term term{part.weight, std::move(part.planes), infinity};
        for (const std::uint8_t round : part.rounds) term.factors.push_back(std::uint8_t(planes.size() + round));
        if (term.factors.size() > std::size_t(max_planes)) return std::nullopt;
        sum.terms_.push_back(std::move(term));
    }
    sum.planes_ = int(planes.size());
    const auto n = std::size_t(sum.even_planes());
    sum.coefficients_.assign(4 * n, 0.0);
    for (std::size_t i = 0; i < planes.size(); ++i) {
        for (int k = 0; k < 3; ++k) sum.coefficients_[std::size_t(k) * n + i] = planes[i].slope[k];
        sum.coefficients_[3 * n + i] = planes[i].base;
    }
    // ρ = ½ takes that terms of the one sign together make up for what c misses: of m terms one makes up
    // for 1/m of it, and then so does every factor of it.
    const double missing = 0.5 - sum.constant_;
    sum.anywhere_ = missing == 0;
    const auto helps = [&](const Term& term) { return missing * term.weight > 0; };
    const auto helpers = double(std::count_if(sum.terms_.begin(), sum.terms_.end(), helps));
    for (Term& term : sum.terms_)
        if (helps(term))
            term.reach = displacement(missing / (helpers * term.weight) - inverse_slack) + clearance * steepest;
    return sum;
}

}  // namespace deburr
