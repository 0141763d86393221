// Which edges and regions of a model stay sharp when it is rounded, as given by a scene or the command line.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bounds/field.hpp"
#include "bounds/kept_edges.hpp"

namespace deburr {

/// The edges and regions that stay sharp; lengths are scene units.
struct KeepSharp {
    KeptEdges::Kind edges = KeptEdges::Kind::none;
    std::optional<double> below, above;  // heights below and above which all stays sharp
    std::vector<Box> boxes;              // regions in which all stays sharp
    std::optional<double> fade;          // width of the transition, > 0; none: three radii

    /// Whether anything stays sharp.
    bool any() const { return edges != KeptEdges::Kind::none || below || above || !boxes.empty(); }
    /// The settings as text, for descriptions.
    std::string text() const;
};

/// The mesh rounded by this radius except for what is kept sharp; radius 0 leaves it as it is.
FieldPtr rounded_mesh(ClosedMeshPtr mesh, double radius, const KeepSharp& keep, bool z_up);

}  // namespace deburr
