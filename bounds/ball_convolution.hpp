// True convolution: the exact part of a ball that lies in a polyhedron, in closed form. Quasi-convolution approximates
// it [Lobb eq. 1, §2.3.1].
//
// The polyhedron is any Boolean function of half-spaces. The unit of length is the ball's radius and the origin is its
// centre, so half-space i is n·y ≤ −αᵢ, and only half-spaces with |αᵢ| < 1 matter.
//
// Accuracy: 10⁻¹³ where planes are equal, or differ by more than 10⁻³ in direction or distance; 10⁻⁸ always. In
// between, an error of 10⁻¹⁶ in a plane moves its intersection with a plane that makes the angle γ with it by 10⁻¹⁶/γ,
// and planes within 10⁻⁸ of one another count as one.
//
// Not promised: speed with many planes in one ball. Time grows with the square of their number where the function is a
// union of a few convex parts, and with its cube at worst.
#pragma once
#include "bounds/box_range.hpp"
#include "bounds/ray_bounds.hpp"
#include "bounds/short_circuit.hpp"

namespace deburr {

class BallConvolution {
public:
    /// A convolution for a tree whose root is an Op::convolution (asserted).
    explicit BallConvolution(const DensityTree& tree);

    /// The half-spaces of the function in world space. Those on one plane are one half-space if there are at most 64.
    const std::vector<HalfSpace>& half_spaces() const { return half_spaces_; }

    /// ρ, the part of the ball in the polyhedron, from the α of each of half_spaces(); slope[i] becomes dρ/dα of
    /// half-space i.
    double at(const std::vector<double>& alpha, std::vector<double>& slope) const;

    /// Range of ρ over a box in world space, or over any region, given the range of each half-space's density over it.
    Range range(const Box& box) const;
    Range range(const std::vector<Range>& half_spaces) const;

    /// 1 where enlarging half-space i can only enlarge ρ, −1 where it can only reduce it, 0 where it can do either.
    int polarity(std::size_t i) const { return uses_[i] == 1 ? 1 : uses_[i] == 2 ? -1 : 0; }

    /// A direction in world space, mapped to the space in which the filter is the unit ball.
    Vec3 in_ball(Vec3 direction) const { return to_ball_ * direction; }

    /// M, L and G of ρ on a segment where every αᵢ runs linearly from a0[i] to a1[i], rate[i] = |dαᵢ/dt|, and the ball
    /// moves by `speed` of its radii per unit of t.
    RayBounds bounds(const std::vector<double>& a0, const std::vector<double>& a1, const std::vector<double>& rate,
                     double speed) const;

private:
    void find_equal(const DensityTree& tree);
    void drop_idle();
    void find_open(const std::vector<char>& known, BooleanSteps& left) const;

    Mat3 to_ball_{1.0};
    BooleanFunction function_;
    BooleanSteps steps_;  // function_ as steps
    std::vector<HalfSpace> half_spaces_;
    std::vector<Vec3> normals_;  // unit, in the space of the unit ball
    std::vector<char> uses_;     // how each half-space occurs: 1 as it is, 2 complemented, 3 both ways
};

}  // namespace deburr
