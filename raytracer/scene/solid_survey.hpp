// Counts what solids are made of, and bounds them, in time that does not grow with the number of placements.
#pragma once
#include <unordered_map>

#include "bounds/canonical_solids.hpp"

namespace deburr {

/// Facts about a solid; counts are per use, so a part that is placed twice counts twice.
struct SolidFacts {
    Box box;                               // contains the solid; sides may be infinite
    double half_spaces = 0, quadrics = 0;  // in its densities and fields
    double round_parts = 0;                // spheres, cylinders, cones and tori of densities
    double triangles = 0, faces = 0;       // of models; faces: connected triangles in one plane count once
    double model_volume = 0;               // of models, before rounding and CSG
    double model_radius = 0;               // largest rounding radius of a model
};

/// Surveys solids. It remembers shared parts, so one survey should be used for all solids of a scene; each solid must
/// outlive it.
class SolidSurvey {
public:
    /// The facts about a solid. A union that is too large to be flattened is surveyed by its operands, each canonical
    /// one once; its box is the hull of theirs.
    SolidFacts at(const Solid& solid);

private:
    const SolidFacts& of_canonical(int root);

    CanonicalSolids canonical_;
    std::unordered_map<int, SolidFacts> known_;
};

}  // namespace deburr
