// Density classes and their tables [Triage §4.2.1, table 1], for every operator.
//
//   zero {0}   low [0, ½)   unclassified [0, 1]   high [½, 1]   one {1}
//
// The class of a result is the narrowest that holds op(a, b) for all a and b of the operands'
// classes, as the paper's restrictions keep every operand and result in [0, 1]. Sum: results beyond
// 1 are illegal and do not occur; difference: results below 0. Boolean operands may share anything,
// so their tables follow the Fréchet inequalities. The tables are derived when the program starts,
// from intervals.
#pragma once
#include <array>

#include "bounds/density_tree.hpp"

namespace deburr {

enum class DensityClass : unsigned char { zero, low, unclassified, high, one };
constexpr std::array<DensityClass, 5> density_classes = {
    DensityClass::zero, DensityClass::low, DensityClass::unclassified, DensityClass::high, DensityClass::one};

/// Least and greatest densities of the class; `open_above`: the greatest is not reached.
struct ClassInterval {
    double lo, hi;
    bool open_above;
};
ClassInterval interval_of(DensityClass c);

/// The narrowest class that holds the interval, cut to [0, 1].
DensityClass class_of(ClassInterval interval);

/// sum, product, difference, conjunction or disjunction.
DensityClass combine(Op op, DensityClass a, DensityClass b);
DensityClass complement(DensityClass a);

}  // namespace deburr
