// A last resort for facets that cross: fewer edges.
//
// Where sharp surfaces meet at almost no angle, or three in almost one line, points on the correct surfaces are joined
// by facets that fold over each other, whatever the size of the cells. A mesh that leaves out some of these points is
// as good, because they are closer together than any tolerance.
#pragma once
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/mended_mesh.hpp"

namespace deburr {

/// Collapses and flips edges of `m`'s facets that lean, face inward or cross, as long as each change leaves fewer
/// faults, or as many among fewer facets, and no new facet's middle is farther from the surface than `reach`. Updates
/// the faults in `m`, and returns the number of changes. The mesh stays closed. Throws Cancelled. A mesh with more than
/// 1000 faults is left unchanged.
std::size_t untangle(MendedMesh& m, const FacetJudge& judge, double reach, CancelFlag cancel);

}  // namespace deburr
