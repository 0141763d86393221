// Triage's density classes: the tables of the operators, entry by entry.
#include "polygonizer/triage/density_class.hpp"

#include "catch.hpp"

using namespace deburr;

namespace {

constexpr auto Z = DensityClass::zero, L = DensityClass::low, U = DensityClass::unclassified, H = DensityClass::high,
               I = DensityClass::one;

// Sample members of a class: its ends, if they belong to it, and values between them.
std::vector<double> members(DensityClass c) {
    const ClassInterval i = interval_of(c);
    if (i.lo == i.hi) return {i.lo};
    std::vector<double> all;
    for (const double share : {0.0, 1e-9, 0.25, 0.5, 0.75, 1 - 1e-9, 1.0})
        if (share < 1 || !i.open_above) all.push_back(i.lo + share * (i.hi - i.lo));
    return all;
}

bool holds(DensityClass c, double rho) {
    const ClassInterval i = interval_of(c);
    return rho >= i.lo && (rho < i.hi || (rho == i.hi && !i.open_above));
}

// Least and greatest value of the operator for these operands. A Boolean operator's result depends on what the operands
// share; these are the Fréchet bounds.
std::pair<double, double> values(Op op, double a, double b) {
    switch (op) {
        case Op::sum: return {a + b, a + b};
        case Op::product: return {a * b, a * b};
        case Op::difference: return {a - b, a - b};
        case Op::conjunction: return {std::max(0.0, a + b - 1), std::min(a, b)};
        default: return {std::max(a, b), std::min(1.0, a + b)};
    }
}

}  // namespace

TEST_CASE("Triage table 1: multiplication of density classes, entry by entry") {
    const DensityClass printed[5][5] = {
        {Z, Z, Z, Z, Z}, {Z, L, L, L, L}, {Z, L, U, U, U}, {Z, L, U, U, H}, {Z, L, U, H, I}};
    for (const DensityClass a : density_classes)
        for (const DensityClass b : density_classes) {
            CAPTURE(int(a), int(b));
            CHECK(combine(Op::product, a, b) == printed[int(a)][int(b)]);
        }
}

TEST_CASE(
    "Every table entry holds all that its operands can give, and no narrower class does but for sums and differences") {
    for (const Op op : {Op::sum, Op::product, Op::difference, Op::conjunction, Op::disjunction})
        for (const DensityClass a : density_classes)
            for (const DensityClass b : density_classes) {
                CAPTURE(int(op), int(a), int(b));
                const DensityClass result = combine(op, a, b);
                bool fits[5] = {true, true, true, true, true};
                int legal = 0;
                for (const double x : members(a))
                    for (const double y : members(b)) {
                        const auto [lo, hi] = values(op, x, y);
                        if (lo < 0 || hi > 1) continue;  // illegal by the papers' rules
                        ++legal;
                        CHECK(holds(result, lo));
                        CHECK(holds(result, hi));
                        for (const DensityClass c : density_classes) fits[int(c)] &= holds(c, lo) && holds(c, hi);
                    }
                if (legal == 0) continue;
                for (const DensityClass c : density_classes) {
                    const ClassInterval narrow = interval_of(c), own = interval_of(result);
                    const bool narrower = narrow.lo >= own.lo && narrow.hi <= own.hi && c != result;
                    if (narrower && (c == Z || c == I || c == L || c == H)) {
                        CAPTURE(int(c), int(result));
                        // Sums and differences are left out: a sum that only legality keeps at 1 may be called high.
                        if (!(op == Op::sum || op == Op::difference)) CHECK_FALSE(fits[int(c)]);
                    }
                }
            }
}

TEST_CASE("The complement of a class") {
    for (const DensityClass a : density_classes)
        for (const double x : members(a)) CHECK(holds(complement(a), 1 - x));
}
