// The ends of a result's interval follow from those of a and b, because every operator is monotone in each operand. The
// upper end is open if an end that it comes from is open, except where the operator clamps at 0 or 1.
#include "polygonizer/triage/density_class.hpp"

#include <cassert>

namespace deburr {
namespace {

ClassInterval combine(Op op, ClassInterval a, ClassInterval b) {
    switch (op) {
        case Op::sum: return {a.lo + b.lo, a.hi + b.hi, a.open_above || b.open_above};
        case Op::product: {
            const double hi = a.hi * b.hi;
            return {a.lo * b.lo, hi, hi > 0 && (a.open_above || b.open_above)};
        }
        // The greatest difference comes from b's least value, which every class reaches.
        case Op::difference: return {a.lo - b.hi, a.hi - b.lo, a.open_above};
        case Op::conjunction: {
            const ClassInterval& less = b.hi < a.hi || (b.hi == a.hi && b.open_above) ? b : a;
            return {std::max(0.0, a.lo + b.lo - 1), less.hi, less.open_above};
        }
        case Op::disjunction: {
            const double hi = a.hi + b.hi;
            return {std::max(a.lo, b.lo), std::min(1.0, hi), hi <= 1 && (a.open_above || b.open_above)};
        }
        default: assert(false); return {0, 1, false};
    }
}

using Table = std::array<std::array<DensityClass, 5>, 5>;

Table derive(Op op) {
    Table table{};
    for (const DensityClass a : density_classes)
        for (const DensityClass b : density_classes)
            table[std::size_t(a)][std::size_t(b)] = class_of(combine(op, interval_of(a), interval_of(b)));
    return table;
}

const Table& table_of(Op op) {
    static const Table sum = derive(Op::sum), product = derive(Op::product), difference = derive(Op::difference),
                       conjunction = derive(Op::conjunction), disjunction = derive(Op::disjunction);
    switch (op) {
        case Op::sum: return sum;
        case Op::product: return product;
        case Op::difference: return difference;
        case Op::conjunction: return conjunction;
        default: return disjunction;
    }
}

}  // namespace

ClassInterval interval_of(DensityClass c) {
    switch (c) {
        case DensityClass::zero: return {0, 0, false};
        case DensityClass::low: return {0, 0.5, true};
        case DensityClass::unclassified: return {0, 1, false};
        case DensityClass::high: return {0.5, 1, false};
        case DensityClass::one: return {1, 1, false};
    }
    return {0, 1, false};
}

DensityClass class_of(ClassInterval i) {
    const double lo = std::clamp(i.lo, 0.0, 1.0), hi = std::clamp(i.hi, 0.0, 1.0);
    if (hi == 0) return DensityClass::zero;
    if (lo == 1) return DensityClass::one;
    if (hi < 0.5 || (hi == 0.5 && i.open_above)) return DensityClass::low;
    return lo >= 0.5 ? DensityClass::high : DensityClass::unclassified;
}

DensityClass combine(Op op, DensityClass a, DensityClass b) { return table_of(op)[std::size_t(a)][std::size_t(b)]; }

DensityClass complement(DensityClass a) {
    // 1 − low is (½, 1], which is within high; 1 − high is [0, ½], whose upper end low does not contain.
    switch (a) {
        case DensityClass::zero: return DensityClass::one;
        case DensityClass::low: return DensityClass::high;
        case DensityClass::one: return DensityClass::zero;
        default: return DensityClass::unclassified;
    }
}

}  // namespace deburr
