// The last resort for facets that cross: edges fewer.
//
// Where sharp surfaces meet at almost no angle, or three in almost one line, points that lie on the right surfaces are
// joined by facets that fold over one another, at whatever size of the cells. There a mesh that leaves out some of the
// points is as good, as they are closer together than anyone asked for.
#pragma once
#include "polygonizer/mesh/cancel.hpp"
#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/mended_mesh.hpp"

namespace deburr {

/// Collapses and flips edges of `m`'s facets that lean, face inward or cross, as long as each change leaves fewer of
/// them, or as many among fewer facets, and no new facet's middle is farther from the surface than `reach`. Brings the
/// faults of `m` up to date, and returns the number of changes. The mesh stays closed. Throws Cancelled.
std::size_t untangle(MendedMesh& m, const FacetJudge& judge, double reach, CancelFlag cancel);

}  // namespace deburr
