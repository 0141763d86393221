// A rounded density tree [Lobb §2.2–2.3], flattened for evaluation: half-spaces in world space, each with a filter
// radius, and an expression over them.
//
// A density that an affine map carries along, x ↦ ρ(A⁻¹x), needs no map of its own: α is affine in x, so it is the
// density of other half-spaces with other radii.
//
// `at` and `gradient_at` prune the tree to the point and evaluate what is left (local_density.cpp); tests
// hold them against tests/plain_definition.hpp. Not promised: ρ in [0, 1] (density.hpp), nor speed.
#pragma once
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bounds/density.hpp"
#include "bounds/profile.hpp"
#include "bounds/round_coordinate.hpp"

namespace deburr {

/// The set of points with n·x ≤ offset, and the filter that rounds it. A *round part* is a HalfSpace whose boundary is
/// not a plane: a RoundCoordinate u(x) takes the place of n·x.
struct HalfSpace {
    Vec3 normal;                             // unit, outward; unused in a round part
    double offset;                           // n·x = offset on the plane; a world distance
    double radius;                           // of the filter, in world space along the normal; 0: sharp
    const RoundCoordinate* round = nullptr;  // null for a plane; owned by the tree (DensityTree::rounds)

    /// Signed distance of x from the plane or round surface, positive outside.
    double distance(Vec3 x) const { return (round ? round->at(x) : glm::dot(normal, x)) - offset; }
    /// Gradient of distance(): a unit vector, or 0 at points where a round part has no gradient.
    Vec3 normal_at(Vec3 x) const { return round ? round->gradient(x) : normal; }
    /// α: signed distance in filter radii. A sharp half-space has α = −infinity inside and on its plane, +infinity
    /// outside.
    double alpha(Vec3 x) const { return alpha_at(distance(x)); }
    double alpha_at(double distance) const {
        if (radius > 0) return distance / radius;
        return distance <= 0 ? -infinity : infinity;
    }
    double density(Vec3 x) const { return profile(alpha(x)); }
};

enum class Op : unsigned char {
    constant,
    half_space,
    sum,         // Lobb's
    product,     // Lobb's
    difference,  // Lobb's
    complement,  // 1 − a, whether arithmetic or Boolean
    conjunction,
    disjunction,
    convolution  // of a Boolean function: the part of a ball in which it is true; the root or nowhere
};

/// A node of the expression; children are indices in DensityTree::nodes.
struct TreeNode {
    Op op = Op::constant;
    int a = -1, b = -1;  // children; half_space: a is its index in half_spaces; one operand: b = −1
    double value = 0;    // constant only
    int line = 0;        // line of the scene that wrote the operator, 0 unknown
    int support = -1;    // index of a box (DensityTree::supports) outside of which the node is 0; −1: none is known
};

/// A function's value at a point, and its gradient there.
struct ValueGradient {
    double value = 0;
    Vec3 gradient{0.0};
};

/// The flattened tree. Plain data: whoever changes nodes or half-spaces keeps the order and the indices right.
struct DensityTree {
    std::vector<HalfSpace> half_spaces;
    std::vector<TreeNode> nodes;  // children before parents, the root last; never empty
    /// Boxes that nodes' `support` refers to.
    std::vector<Box> supports = {};
    Mat3 ball{1.0};  // convolution: maps the unit ball to the filter (world space)
    /// Owns the coordinates that half_spaces point to; null where none is round.
    std::shared_ptr<const std::deque<RoundCoordinate>> rounds = nullptr;

    static DensityTree constant(double value) { return {{}, {{Op::constant, -1, -1, value}}, {}}; }

    int root() const { return int(nodes.size()) - 1; }
    double at(Vec3 x) const { return gradient_at(x).value; }
    /// ρ and ∇ρ at x. Sharp half-spaces contribute no slope, not even on their planes.
    ValueGradient gradient_at(Vec3 x) const;
};

/// The most half-spaces that flatten() accepts.
constexpr double max_half_spaces = 4e6;

/// Thrown for a round part that has no density: the filter does not fit into a torus, or the map does not keep angles.
struct BadRoundPart : std::domain_error {
    using std::domain_error::domain_error;
};

/// The count in digits, or "more than 10^15": parts that are shared may be used more often than a double can count.
std::string count_text(double count);

/// Thrown where an expression would have more than max_half_spaces half-spaces. `got` is their number.
struct TooManyHalfSpaces : std::length_error {
    explicit TooManyHalfSpaces(double got);
};

/// Rounds and places a density: the filter radius is `radius` wherever the scene fixed none, and `to_world` is applied
/// to the rounded density, radii included. Below a Boolean operator + * - become ∨ ∧ ∧¬ [docs/design.md, Boolean
/// densities]. Chains of one associative operator become balanced trees, and supports are found (support.hpp). Throws
/// TooManyHalfSpaces, and BadRoundPart where there are round parts and the map does not keep angles, or a torus is too
/// small for its filter.
DensityTree flatten(const Density& density, double radius, const Affine& to_world = {});

/// The tree mapped by `map`, radii and round parts included; supports are found again. The
/// root must not be a convolution. Throws BadRoundPart where there are round parts and the map does not keep angles.
DensityTree placed(DensityTree tree, const Affine& map);

/// The half_spaces of flatten(density, radius, to_world), without its expression. Throws as flatten() does.
std::vector<HalfSpace> flat_half_spaces(const Density& density, double radius, const Affine& to_world = {});

/// The true convolution [Lobb eq. 1] with a ball of this radius > 0: the whole density is read as a Boolean function,
/// and radii that it fixes itself are ignored. Throws as flatten() does.
DensityTree flatten_convolved(const Density& density, double radius, const Affine& to_world = {});

/// The image of a half-space that is not a round part. With `carry_radius` the filter radius scales as distances along
/// the normal do; otherwise it stays.
HalfSpace transformed(const HalfSpace& h, const Affine& map, bool carry_radius);

}  // namespace deburr
