// CSG objects in POV-Ray's words, made operator by operator.
//
// An intersection keeps its planes until it is written: planes of one direction become one, three
// pairs of parallel planes a box, which POV-Ray traces faster than six planes. What is taken away
// loses the planes that it shares with the rest: the papers clip a subtrahend by the very face that it
// opens, and POV-Ray shows speckles where two faces coincide.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "bounds/csg_bounds.hpp"

namespace deburr {

class PovCsg {
public:
    static PovCsg nothing() { return PovCsg(Kind::nothing); }
    static PovCsg everything() { return PovCsg(Kind::everything); }
    /// n·x ≤ offset.
    static PovCsg plane(BoundPlane plane);
    /// An object of POV-Ray's in braces, such as `sphere { 0, 1 }`.
    static PovCsg object(std::string text);

    static PovCsg unite(PovCsg a, PovCsg b);
    static PovCsg intersect(PovCsg a, PovCsg b);
    static PovCsg subtract(PovCsg a, PovCsg b);

    bool is_nothing() const { return kind_ == Kind::nothing; }
    /// The object; `modifiers` (a material) go inside its braces.
    std::string text(const std::string& modifiers = "") const;

private:
    enum class Kind { nothing, everything, intersect, unite };
    explicit PovCsg(Kind kind) : kind_(kind) {}
    PovCsg as(Kind kind) &&;
    PovCsg without_planes_of(const PovCsg& whole) const;

    Kind kind_;
    std::vector<BoundPlane> planes_;    // both
    std::vector<std::string> objects_;  // both, either
    std::vector<PovCsg> taken_;         // both: what is subtracted
};

}  // namespace deburr
