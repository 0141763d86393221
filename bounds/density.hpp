// Densities as a scene writes them: unrounded polyhedra under the papers' arithmetic [Lobb §2.2]
// and under Boolean operators.
//
// A Density is a cheap handle on an immutable, shared expression. Nothing is evaluated here: a
// filter radius and a placement turn the expression into a DensityTree, which is.
//
// Not promised: legality. `a + b` of overlapping parts and `a - b` of parts that stick out leave
// [0, 1]; the box ranges find that (box_range.hpp).
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "bounds/round_coordinate.hpp"
#include "bounds/vec.hpp"

namespace deburr {

class DensityNode;

class Density {
public:
    /// 1 where n·x ≤ d, else 0. `normal` points outward, of any length but 0; d is divided by it.
    static Density half_space(Vec3 normal, double offset);
    /// A half-space that rounding moves outward by its radius, so that it is 1 where n·x ≤ d, rounded or not: it gives
    /// bounds to what has none of its own, and changes nothing of what lies within.
    static Density cover(Vec3 normal, double offset);
    /// 1 where the coordinate is at most `offset` > 0, else 0: a ball, a cylinder without ends, a torus, a nappe of a
    /// cone.
    static Density round(const RoundCoordinate& coordinate, double offset);
    /// The ball of this radius.
    static Density sphere(Vec3 center, double radius);
    /// Around the segment; `from` ≠ `to`.
    static Density cylinder(Vec3 from, Vec3 to, double radius);
    /// From one radius to another, not both 0; `from` ≠ `to`. An end of radius 0 is the apex.
    static Density cone(Vec3 from, Vec3 to, double radius_from, double radius_to);
    /// Around the circle of radius `radius` about the unit axis; tube < radius.
    static Density torus(Vec3 center, Vec3 axis, double radius, double tube);
    /// Product of six half-spaces; lo < hi on each axis.
    static Density box(Vec3 lo, Vec3 hi);
    /// Product of all; at least one.
    static Density product(std::vector<Density> parts);

    /// The papers' arithmetic. `line` is the scene's line that wrote it, for messages; 0 unknown.
    static Density sum(Density a, Density b, int line = 0);
    static Density product(Density a, Density b, int line = 0);
    static Density difference(Density a, Density b, int line = 0);
    /// Boolean densities: below one, the whole operand is read as a Boolean function.
    static Density disjunction(Density a, Density b);
    static Density conjunction(Density a, Density b);
    static Density complement(Density a);

    friend Density operator+(Density a, Density b) { return sum(a, b); }
    friend Density operator*(Density a, Density b) { return product(a, b); }
    friend Density operator-(Density a, Density b) { return difference(a, b); }
    friend Density operator|(Density a, Density b) { return disjunction(a, b); }
    friend Density operator&(Density a, Density b) { return conjunction(a, b); }
    friend Density operator~(Density a) { return complement(a); }

    /// Fixes the filter radius of those half-spaces that have none yet [Lobb §4.2, Triage §4.5.3].
    Density radius(double r) const;
    /// The transformed polyhedron, to be rounded afterwards. `map` must be regular.
    Density transformed(const Affine& map) const;
    /// Whether radius() was used anywhere in it.
    bool has_radius() const;

    const DensityNode& node() const { return *node_; }

private:
    explicit Density(std::shared_ptr<const DensityNode> node) : node_(std::move(node)) {}
    std::shared_ptr<const DensityNode> node_;
};

/// One step of the expression. Children are shared, so expressions are graphs without cycles. A node keeps what its
/// kind needs, for a scene may have millions of them.
class DensityNode {
public:
    enum class Kind : std::uint8_t {
        half_space,
        cover,
        round,
        sum,
        product,
        difference,
        disjunction,
        conjunction,
        complement,
        radius,
        transform
    };
    struct HalfSpace {
        Vec3 normal;  // unit
        double offset;
    };
    struct Radius {
        Density child;
        double radius;
    };
    struct Transform {
        Density child;
        Affine map;
    };
    using Operands = std::array<Density, 2>;
    using Parts = std::variant<HalfSpace, Density, Operands, std::vector<Density>, Radius, Transform,
                               std::unique_ptr<const RoundPart>>;

    DensityNode(Kind kind, Parts parts, int line = 0);
    DensityNode(const DensityNode&) = delete;
    DensityNode& operator=(const DensityNode&) = delete;
    ~DensityNode();  // iterative, so that a chain of any length dies without recursion

    std::span<const Density> children() const;
    bool is_plane() const { return kind == Kind::half_space || kind == Kind::cover; }
    // For the kinds that have them.
    const Vec3& normal() const { return std::get_if<HalfSpace>(&parts_)->normal; }
    double offset() const { return std::get_if<HalfSpace>(&parts_)->offset; }
    double radius() const { return std::get_if<Radius>(&parts_)->radius; }
    const Affine& map() const { return std::get_if<Transform>(&parts_)->map; }
    const RoundPart& round() const { return **std::get_if<std::unique_ptr<const RoundPart>>(&parts_); }

    const Kind kind;
    bool has_radius = false;      // radius, or anything below it
    bool has_round = false;       // it is round, or anything below it
    bool may_be_illegal = false;  // a sum or difference is in it that no Boolean operator is above
    const int line;               // sum, product, difference: place in the scene
    double leaves = 1.0;          // half-spaces below, counted once per use; may overflow to infinity

private:
    Parts parts_;
};

}  // namespace deburr
