// The exact share of a ball that lies in a polyhedron: the true convolution that quasi-convolution
// approximates [Lobb eq. 1, §2.3.1], in closed form.
//
// The polyhedron is any Boolean function of half-spaces. The unit of length is the ball's radius and
// its centre the origin, so half-space i is n·y ≤ −αᵢ, and only those with |αᵢ| < 1 matter.
//
// Accuracy: 10⁻¹³ where planes are equal, or differ by more than 10⁻³ in direction or distance;
// 10⁻⁸ always. Between, an error of 10⁻¹⁶ in a plane moves the edge that it makes with a plane that
// leans away from it by γ by 10⁻¹⁶/γ, and planes within 10⁻⁸ of one another count as one.
//
// Not promised: speed with many planes in one ball. It grows with their number's square where the function is a union
// of a few convex parts, and with its cube at the worst.
#pragma once
#include "bounds/box_range.hpp"
#include "bounds/ray_bounds.hpp"
#include "bounds/short_circuit.hpp"

namespace deburr {

class BallConvolution {
public:
    /// The tree's root is an Op::convolution. Its half-spaces are gone through for equal ones.
    explicit BallConvolution(const DensityTree& tree);

    /// The half-spaces of the function, placed in the tree's world; no two lie on one plane.
    const std::vector<HalfSpace>& half_spaces() const { return half_spaces_; }

    /// The share, and its derivative by each α.
    double at(const std::vector<double>& alpha, std::vector<double>& slope) const;

    /// Bounds of the share over a box, or over any region on which ρ of every half-space is given.
    Range range(const Box& box) const;
    Range range(const std::vector<Range>& half_spaces) const;

    /// 1 where more of half-space i can only enlarge the share, −1 where it can only shrink it, 0 where either.
    int polarity(std::size_t i) const { return uses_[i] == 1 ? 1 : uses_[i] == 2 ? -1 : 0; }

    /// A direction in the world as the unit ball has it.
    Vec3 in_ball(Vec3 direction) const { return to_ball_ * direction; }

    /// M, L and G on a segment where every αᵢ runs linearly from a0[i] to a1[i] while the ball moves
    /// by `speed` of its radii per unit of t.
    RayBounds bounds(const std::vector<double>& a0, const std::vector<double>& a1, const std::vector<double>& rate,
                     double speed) const;

private:
    void find_equal(const DensityTree& tree);
    void drop_idle();
    void find_open(const std::vector<char>& known, BooleanSteps& left) const;

    Mat3 to_ball_{1.0};
    BooleanFunction function_;
    BooleanSteps steps_;  // of the same
    std::vector<HalfSpace> half_spaces_;
    std::vector<Vec3> normals_;  // in the ball
    std::vector<char> uses_;     // of each: 1 as it is, 2 its complement, 3 both
};

}  // namespace deburr
