// CSG objects in POV-Ray's language, built operator by operator.
//
// An intersection keeps its planes until it is written: parallel planes that face the same way become one, and three
// pairs of opposite planes become a box, which POV-Ray traces faster than six planes. A subtrahend loses the planes
// that it shares with the minuend: the papers clip a subtrahend by the very face that it opens, and POV-Ray shows
// speckles where two faces coincide.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "bounds/csg_bounds.hpp"

namespace deburr {

/// A CSG expression of POV-Ray objects.
class PovCsg {
public:
    static PovCsg nothing() { return PovCsg(Kind::nothing); }
    static PovCsg everything() { return PovCsg(Kind::everything); }
    /// The half-space n·x ≤ offset.
    static PovCsg plane(BoundPlane plane);
    /// An object in POV-Ray's language with its braces, such as `sphere { 0, 1 }`.
    static PovCsg object(std::string text);

    static PovCsg unite(PovCsg a, PovCsg b);
    static PovCsg intersect(PovCsg a, PovCsg b);
    static PovCsg subtract(PovCsg a, PovCsg b);

    bool is_nothing() const { return kind_ == Kind::nothing; }
    /// The object in POV-Ray's language; `modifiers` (a material) are put inside its braces.
    std::string text(const std::string& modifiers = "") const;

private:
    // The last operator; a single object or half-space is an intersection.
    enum class Kind { nothing, everything, intersect, unite };
    explicit PovCsg(Kind kind) : kind_(kind) {}
    PovCsg as(Kind kind) &&;
    PovCsg without_planes_of(const PovCsg& whole) const;

    Kind kind_;
    std::vector<BoundPlane> planes_;    // intersect: its half-spaces
    std::vector<std::string> objects_;  // intersect, unite: further operands
    std::vector<PovCsg> taken_;         // intersect: subtrahends
};

}  // namespace deburr
