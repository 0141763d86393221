// A rounded density tree [Lobb §2.2–2.3], flat and ready to be evaluated: half-spaces in world
// space with a radius each, and an expression over them.
//
// A density field that is carried along by an affine map, x ↦ ρ(A⁻¹x), needs no map of its own: α
// is affine in x, so it is the density of other half-spaces with other radii.
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

/// The points with n·x ≤ offset. In a *round part*, a half-space whose plane is bent, another coordinate stands in the
/// place of n·x.
struct HalfSpace {
    Vec3 normal;                             // unit, outward; of a round part, nothing
    double offset;                           // n·x = offset on the plane
    double radius;                           // of the filter; 0: sharp
    const RoundCoordinate* round = nullptr;  // in place of n·x, if not null; the tree's

    double distance(Vec3 x) const { return (round ? round->at(x) : glm::dot(normal, x)) - offset; }
    /// Gradient of distance(): a unit vector, or 0 where a round part has none.
    Vec3 normal_at(Vec3 x) const { return round ? round->gradient(x) : normal; }
    /// Signed distance in radii; a sharp plane counts as inside, so α is −infinity or +infinity.
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
    convolution  // of a Boolean function: the share of a ball where it is true; only ever the root
};

struct TreeNode {
    Op op = Op::constant;
    int a = -1, b = -1;  // children; half_space: a is its index
    double value = 0;    // constant
    int line = 0;        // place in the scene, 0 unknown
    int support = -1;    // index of a box outside of which the node is 0, if one is known
};

struct ValueGradient {
    double value = 0;
    Vec3 gradient{0.0};
};

struct DensityTree {
    std::vector<HalfSpace> half_spaces;
    std::vector<TreeNode> nodes;  // children before parents, the root last; never empty
    std::vector<Box> supports = {};
    Mat3 ball{1.0};  // convolution: makes the unit ball the filter
    /// Owns the coordinates that half_spaces point to; null where none is round.
    std::shared_ptr<const std::deque<RoundCoordinate>> rounds = nullptr;

    static DensityTree constant(double value) { return {{}, {{Op::constant, -1, -1, value}}, {}}; }

    int root() const { return int(nodes.size()) - 1; }
    double at(Vec3 x) const { return gradient_at(x).value; }
    /// ρ and ∇ρ; sharp half-spaces have no slope.
    ValueGradient gradient_at(Vec3 x) const;
};

/// More half-spaces than this are not laid out at once.
constexpr double max_half_spaces = 4e6;

/// A round part that has no density.
struct BadRoundPart : std::domain_error {
    using std::domain_error::domain_error;
};

/// A count in digits, or in words if it is more than 10^15: shared parts may be used more often than a double can
/// count.
std::string count_text(double count);

struct TooManyHalfSpaces : std::length_error {
    explicit TooManyHalfSpaces(double got);
};

/// Rounds and places a density: radius r wherever the scene fixed none, then `to_world`. Below a Boolean operator
/// + * - become ∨ ∧ ∧¬ [docs/design.md, Boolean densities]. Chains of one associative operator come out balanced, and
/// bounded parts have their supports. Throws TooManyHalfSpaces. With round parts the map has to keep angles, and a
/// torus has to leave room for its filter: else throws BadRoundPart.
DensityTree flatten(const Density& density, double radius, const Affine& to_world = {});

/// The tree with its round parts, carried along by a map that keeps angles; else throws BadRoundPart. Supports are
/// found again.
DensityTree placed(DensityTree tree, const Affine& map);

/// The half-spaces of flatten() alone.
std::vector<HalfSpace> flat_half_spaces(const Density& density, double radius, const Affine& to_world = {});

/// The true convolution [Lobb eq. 1] by a ball of this radius > 0: all of the density is read as a
/// Boolean function, and radii of its own are not looked at.
DensityTree flatten_convolved(const Density& density, double radius, const Affine& to_world = {});

/// The flat half-space's image; the radius scales as distance along the normal does.
HalfSpace transformed(const HalfSpace& h, const Affine& map, bool carry_radius);

}  // namespace deburr
