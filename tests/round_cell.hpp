// Random densities with round parts, pruned to a box as they are in a cell.
#pragma once
#include "bounds/round_density.hpp"
#include "plain_round.hpp"

namespace deburr::test {

/// A density of `parts` parts as a whole and pruned to a random box.
struct RoundCell {
    RoundCase whole;
    Box box;
    FieldPtr pruned;
    const LocalDensity* local = nullptr;  // null where pruning leaves no round density or one that is too large

    /// `parts` is the number of parts of the whole density.
    RoundCell(Gen& g, int parts) : whole(round_case(g, parts)) {
        const Vec3 lo = g.point(0.7);
        box = {lo, lo + Vec3(g.between(0.05, 0.6))};
        pruned = RoundDensity(flatten(whole.density, whole.radius)).prune(box);
        if (const auto* round = dynamic_cast<const RoundDensity*>(pruned.get())) local = round->local();
    }
    /// A random point of the box.
    Vec3 point(Gen& g) const { return 0.5 * (box.lo + box.hi) + g.point(0.5) * (box.hi - box.lo); }
};

}  // namespace deburr::test
