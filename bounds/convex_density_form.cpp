// Recognizes densities that are products of half-spaces, or one minus such a product.
#include <algorithm>

#include "bounds/convex_density.hpp"

namespace deburr {

AlphaPlane alpha_plane(const HalfSpace& h, bool flipped) {
    const double per = (flipped ? -1 : 1) / (h.radius > 0 ? h.radius : 1.0);
    return {h.normal * per, -h.offset * per};
}

namespace {

// A half-space as a variable in [0, 1] or one minus it.
struct Occurrence {
    int variable = 0;
    bool flipped = false;
};

// Half-spaces as occurrences of the fewest variables: planes that coincide share one.
std::vector<Occurrence> occurrences(const std::vector<HalfSpace>& planes, double scale) {
    constexpr double slack = 8 * epsilon;
    std::vector<Occurrence> all;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const HalfSpace& h = planes[i];
        Occurrence l{int(i), false};
        for (std::size_t j = 0; j < i && l.variable == int(i); ++j) {
            const HalfSpace& g = planes[j];
            if (all[j].variable != int(j) || std::abs(g.radius - h.radius) > slack * g.radius) continue;
            const double sign = glm::dot(g.normal, h.normal) < 0 ? -1 : 1;
            if (glm::length(sign * h.normal - g.normal) <= slack &&
                std::abs(sign * h.offset - g.offset) <= slack * scale)
                l = {int(j), sign < 0};
        }
        all.push_back(l);
    }
    return all;
}

// With more variables than this the 2ⁿ corners are not enumerated.
constexpr int max_variables = 6;

}  // namespace

std::optional<ConvexDensity> convex_density(const LocalDensity& density, double scale) {
    const std::vector<HalfSpace>& planes = density.half_spaces();
    if (planes.size() > std::size_t(max_factors)) return std::nullopt;
    ConvexDensity result;
    std::vector<Occurrence> factors;
    if (const auto product = density.as_product()) {
        result.complement = product->complement;
        for (const auto& [plane, flipped] : product->factors) factors.push_back({plane, flipped});
    } else {
        // A polynomial that is affine in each variable is determined by its values at the corners, where every variable
        // is 0 or 1. It is a product if exactly one of these is 1, and the others are 0.
        const std::vector<Occurrence> of = occurrences(planes, scale);
        std::vector<int> variables;
        std::vector<int> variable_of;
        for (std::size_t i = 0; i < of.size(); ++i) {
            variable_of.push_back(of[i].variable);
            if (of[i].variable == int(i)) variables.push_back(int(i));
        }
        const int n = int(variables.size());
        if (n > max_variables || !density.is_affine_in_each(variable_of)) return std::nullopt;
        std::vector<char> value;
        std::vector<Range> at(planes.size());
        for (int corner = 0; corner < 1 << n; ++corner) {
            for (std::size_t i = 0; i < planes.size(); ++i) {
                const auto v = std::find(variables.begin(), variables.end(), of[i].variable) - variables.begin();
                const double rho = ((corner >> v & 1) != 0) != of[i].flipped;
                at[i] = {rho, rho};
            }
            const Range rho = density.range(at);
            if (rho.lo != rho.hi || (rho.lo != 0 && rho.lo != 1)) return std::nullopt;
            value.push_back(rho.lo == 1);
        }
        int relevant = 0;
        for (int v = 0; v < n; ++v)
            for (int corner = 0; corner < 1 << n; ++corner)
                if (value[corner] != value[corner ^ 1 << v]) relevant |= 1 << v;
        int ones = 0, zeros = 0, the_one = 0, the_zero = 0;
        for (int corner = 0; corner < 1 << n; ++corner) {
            if ((corner & ~relevant) != 0) continue;
            (value[corner] ? ones : zeros)++;
            (value[corner] ? the_one : the_zero) = corner;
        }
        if (relevant == 0 || (ones != 1 && zeros != 1)) return std::nullopt;
        result.complement = ones != 1;
        const int corner = result.complement ? the_zero : the_one;
        for (int v = 0; v < n; ++v)
            if (relevant >> v & 1) factors.push_back({variables[v], (corner >> v & 1) == 0});
    }
    for (const bool sharp : {false, true})
        for (const auto [i, flipped] : factors) {
            const HalfSpace& h = planes[i];
            if ((h.radius == 0) != sharp) continue;
            result.planes.push_back(alpha_plane(h, flipped));
            result.sharp += sharp;
        }
    return result;
}

}  // namespace deburr
