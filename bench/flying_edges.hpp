// VTK's Flying Edges [Schroeder, Maynard & Geveci 2015], the fastest of the grid methods, to compare triage with where
// VTK is installed.
#pragma once
#include <optional>

#include "bounds/density_tree.hpp"
#include "polygonizer/mesh/mesh.hpp"

namespace deburr::bench {

/// Runs Flying Edges, including the evaluation of the grid, and nothing else.
class FlyingEdges {
public:
    /// Whether this program was built with VTK; if not, no other function may be called.
    static bool installed();
    FlyingEdges();
    ~FlyingEdges();
    FlyingEdges(const FlyingEdges&) = delete;
    FlyingEdges& operator=(const FlyingEdges&) = delete;
    /// Extracts the surface ρ = ½ on a grid with this step.
    void run(const DensityTree& tree, const Box& box, double step);
    /// The number of triangles of the last run.
    std::size_t triangles() const;
    /// The surface of the last run as a Mesh.
    Mesh mesh() const;

private:
    struct Vtk;
    Vtk* vtk_;
};

}  // namespace deburr::bench
