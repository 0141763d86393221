// Boolean densities as decision diagrams over families of parallel planes
// [docs/design.md, Boolean densities].
//
// A Boolean density is the probability that the Boolean function of its half-spaces is true when a
// point is drawn around x: independently for every direction, but with one draw for all parallel
// planes of one radius. Round parts of one coordinate share a draw likewise. A family (normals ±n, radius r, thresholds
// τ₀ < τ₁ < … along n) is one random coordinate; a decision node has one child for each gap between thresholds that
// makes a difference.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

/// A Boolean density whose diagram would be too large to be evaluated.
struct TooEntangled : std::length_error {
    /// `line`: of the solid in the scene, 0 unknown.
    explicit TooEntangled(int line = 0)
        : std::length_error((line > 0 ? "the solid of line " + std::to_string(line) + ": " : "") +
                            "expected a Boolean density whose decision diagram has at most 100,000 "
                            "nodes, got more; too many of its planes meet within one radius") {}
};

/// A node decides where its family's coordinate falls: `children[j]` is reached with the
/// probability that it lies between thresholds[j−1] and thresholds[j].
struct Decision {
    int family = -1;
    std::vector<int> thresholds;  // indices in the family, increasing; one fewer than children
    std::vector<int> children;    // node numbers; 0 is false, 1 is true

    bool operator==(const Decision&) const = default;
};

/// Half-spaces, or round parts, of one coordinate.
struct PlaneFamily {
    Vec3 normal;
    double radius = 0;
    std::vector<double> thresholds;          // increasing
    const RoundCoordinate* round = nullptr;  // the tree's
};

/// Nodes 0 and 1 are the constants false and true; children come before parents.
struct DecisionDiagram {
    std::vector<PlaneFamily> families;
    std::vector<Decision> nodes;
    int root = 0;
};

/// Diagram of the Boolean function at node `root` of `tree`, whose every node below is a
/// half-space, a constant 0 or 1, a complement, conjunction or disjunction. Planes count as
/// parallel, as of one radius, and as the same plane within a relative 10⁻⁹, 10⁻⁹ and 10⁻¹².
/// Throws TooEntangled.
DecisionDiagram build_diagram(const DensityTree& tree, int root);

}  // namespace deburr
