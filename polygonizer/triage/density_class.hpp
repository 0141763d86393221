// Density classes and their tables [Triage §4.2.1, table 1], for all operators.
//
//   zero {0}   low [0, ½)   unclassified [0, 1]   high [½, 1]   one {1}
//
// The class of a result is the narrowest one that holds op(a, b) for all a and b in the operands' classes, given that
// all operands and results are in [0, 1], as the paper requires: sums beyond 1 and differences below 0 are illegal and
// do not occur. Boolean operands may share half-spaces, so their tables follow the Fréchet inequalities. The tables are
// derived from intervals at the first use.
#pragma once
#include <array>

#include "bounds/density_tree.hpp"

namespace deburr {

enum class DensityClass : unsigned char { zero, low, unclassified, high, one };
constexpr std::array<DensityClass, 5> density_classes = {
    DensityClass::zero, DensityClass::low, DensityClass::unclassified, DensityClass::high, DensityClass::one};

/// The interval of densities in a class; with `open_above` the greatest is not reached.
struct ClassInterval {
    double lo, hi;
    bool open_above;
};
ClassInterval interval_of(DensityClass c);

/// The narrowest class that holds the interval, clamped to [0, 1].
DensityClass class_of(ClassInterval interval);

/// The class of op(a, b), for sum, product, difference, conjunction and disjunction.
DensityClass combine(Op op, DensityClass a, DensityClass b);
/// The class of 1 − a.
DensityClass complement(DensityClass a);

}  // namespace deburr
