// VTK's Flying Edges [Schroeder, Maynard & Geveci 2015], the fastest of the grid methods, where VTK is
// installed: the yardstick for triage.
#pragma once
#include <optional>

#include "bounds/density_tree.hpp"
#include "polygonizer/mesh/mesh.hpp"

namespace deburr::bench {

/// What the method itself does, the grid's evaluation included; nothing else.
class FlyingEdges {
public:
    static bool installed();
    FlyingEdges();
    ~FlyingEdges();
    FlyingEdges(const FlyingEdges&) = delete;
    FlyingEdges& operator=(const FlyingEdges&) = delete;
    /// The surface ρ = ½ on a grid of this step.
    void run(const DensityTree& tree, const Box& box, double step);
    std::size_t triangles() const;
    /// Of the last run, as a mesh of ours.
    Mesh mesh() const;

private:
    struct Vtk;
    Vtk* vtk_;
};

}  // namespace deburr::bench
