// What solids are made of, and where they are, however often they place a part.
#pragma once
#include <unordered_map>

#include "bounds/canonical_solids.hpp"

namespace deburr {

struct SolidFacts {
    Box box;                               // holds the solid; sides may be infinite
    double half_spaces = 0, quadrics = 0;  // counted once per use
    double round_parts = 0;                // spheres, cylinders, cones and tori of densities, once per use
    double triangles = 0, faces = 0;       // of models; faces: triangles of one plane that hang together count once
    double model_volume = 0;               // of models, before they are rounded and combined
    double model_radius = 0;               // greatest by which one is rounded
};

/// Remembers parts that were met before, so one survey should see all solids of a scene, each of which must live as
/// long as it does.
class SolidSurvey {
public:
    /// A solid that is too large to be laid out is a union that is looked at by its operands, each canonical one
    /// once; its box is the hull of theirs.
    SolidFacts at(const Solid& solid);

private:
    const SolidFacts& of_canonical(int root);

    CanonicalSolids canonical_;
    std::unordered_map<int, SolidFacts> known_;
};

}  // namespace deburr
