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
    std::vector<int> new_index(2 * density.half_spaces().size(), -1);
    double steepest = 0;
    for (const auto& [weight, factors] : expanded->terms) {
        Term term{weight, {}, infinity};
        for (const auto& [i, flipped] : factors) {
            int& at = new_index[2 * std::size_t(i) + flipped];
            if (at < 0) {
                const HalfSpace& h = density.half_spaces()[i];
                at = int(planes.size());
                planes.push_back(alpha_plane(h, flipped));
                steepest = std::max(steepest, 1 / h.radius);
            }
            term.factors.push_back(std::uint8_t(at));
        }
        if (planes.size() > std::size_t(max_planes) || term.factors.size() > std::size_t(max_planes))
            return std::nullopt;
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
