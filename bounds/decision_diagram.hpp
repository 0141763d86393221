// Boolean densities as decision diagrams over families of parallel planes
// [docs/design.md, Boolean densities].
//
// A Boolean density is the probability that the Boolean function of its half-spaces is true when a point is drawn
// around x: independently for every direction, but with one draw for all parallel planes of one radius. Round parts of
// one coordinate share a draw likewise. A family (normals ±n, radius r, thresholds τ₀ < τ₁ < … along n) stands for one
// random coordinate; a decision node has one child for each range of gaps between thresholds that leads elsewhere.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "bounds/density_tree.hpp"

namespace deburr {

/// Thrown for a Boolean density whose diagram would be too large to be evaluated.
struct TooEntangled : std::length_error {
    /// `line` is that of the solid in the scene, 0 if it is unknown.
    explicit TooEntangled(int line = 0);
};

/// A node that branches on its family's random coordinate: children[j] is reached with the probability that the
/// coordinate lies between thresholds[j−1] and thresholds[j] (−∞ and +∞ at the ends). Constants have no family: −1.
struct Decision {
    int family = -1;
    std::vector<int> thresholds;  // indices in PlaneFamily::thresholds, increasing; one fewer than children
    std::vector<int> children;    // node numbers; 0 is false, 1 is true

    bool operator==(const Decision&) const = default;
};

/// A family: the half-spaces with one normal (up to sign) and radius, or the round parts of one coordinate and radius.
struct PlaneFamily {
    /// Unit; unused in a family of round parts.
    Vec3 normal;
    double radius = 0;
    std::vector<double> thresholds;          // offsets τ of the planes along the normal, increasing
    const RoundCoordinate* round = nullptr;  // null for planes; owned by the tree
};

/// Nodes 0 and 1 are the constants false and true; children come before parents.
struct DecisionDiagram {
    std::vector<PlaneFamily> families;
    std::vector<Decision> nodes;
    int root = 0;
};

/// Diagram of the Boolean function at node `root` of `tree`. Every node below it must be a half-space, a constant 0 or
/// 1, a complement, a conjunction or a disjunction. Normals and radii count as equal within 10⁻⁹, thresholds within
/// 10⁻¹² of the largest offset. Throws TooEntangled if there would be more than 100,000 nodes.
DecisionDiagram build_diagram(const DensityTree& tree, int root);

}  // namespace deburr
