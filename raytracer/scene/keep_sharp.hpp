// Which edges of a model stay sharp when it is rounded, as a scene or the command line says it.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bounds/field.hpp"
#include "bounds/kept_edges.hpp"

namespace deburr {

struct KeepSharp {
    KeptEdges::Kind edges = KeptEdges::Kind::none;
    std::optional<double> below, above;  // heights
    std::vector<Box> boxes;
    std::optional<double> fade;  // > 0; none: three radii

    /// Whether anything stays sharp.
    bool any() const { return edges != KeptEdges::Kind::none || below || above || !boxes.empty(); }
    /// All of it.
    std::string text() const;
};

/// The mesh, rounded by this radius but for what is kept; 0: as it stands.
FieldPtr rounded_mesh(ClosedMeshPtr mesh, double radius, const KeepSharp& keep, bool z_up);

}  // namespace deburr
