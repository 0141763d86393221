#include "bench/flying_edges.hpp"

#ifdef DEBURR_VTK

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include "bench/density_grid.hpp"

namespace deburr::bench {

struct FlyingEdges::Vtk {
    vtkNew<vtkFlyingEdges3D> filter;
};

bool FlyingEdges::installed() { return true; }

FlyingEdges::FlyingEdges() : vtk_(new Vtk) {
    vtk_->filter->SetValue(0, 0.5);
    vtk_->filter->ComputeNormalsOff();
    vtk_->filter->ComputeGradientsOff();
    vtk_->filter->ComputeScalarsOff();
}

FlyingEdges::~FlyingEdges() { delete vtk_; }

void FlyingEdges::run(const DensityTree& tree, const Box& box, double step) {
    DensityGrid grid = density_grid(tree, box, step);
    vtkNew<vtkFloatArray> values;
    values->SetArray(grid.values.data(), vtkIdType(grid.values.size()), 1);  // 1: VTK must not delete the array
    vtkNew<vtkImageData> image;
    image->SetDimensions(grid.size[0], grid.size[1], grid.size[2]);
    image->SetOrigin(grid.origin.x, grid.origin.y, grid.origin.z);
    image->SetSpacing(step, step, step);
    image->GetPointData()->SetScalars(values);
    vtk_->filter->SetInputData(image);
    vtk_->filter->Update();
    vtk_->filter->SetInputData(nullptr);
}

std::size_t FlyingEdges::triangles() const { return std::size_t(vtk_->filter->GetOutput()->GetNumberOfPolys()); }

Mesh FlyingEdges::mesh() const {
    Mesh mesh;
    vtkPolyData* surface = vtk_->filter->GetOutput();
    for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i) {
        double p[3];
        surface->GetPoint(i, p);
        mesh.positions.push_back({p[0], p[1], p[2]});
    }
    mesh.normals.push_back({0, 1, 0});  // normals are not measured
    const auto cells = vtk::TakeSmartPointer(surface->GetPolys()->NewIterator());
    for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell()) {
        vtkIdType count = 0;
        const vtkIdType* points = nullptr;
        cells->GetCurrentCell(count, points);
        // Densities fall outward, so VTK's triangles face inward and are turned.
        Triangle t{{int(points[0]), int(points[2]), int(points[1])}, {0, 0, 0}};
        mesh.triangles.push_back(t);
    }
    mesh.polygons = mesh.triangles.size();
    return mesh;
}

}  // namespace deburr::bench

#else

namespace deburr::bench {

bool FlyingEdges::installed() { return false; }
FlyingEdges::FlyingEdges() : vtk_(nullptr) {}
FlyingEdges::~FlyingEdges() = default;
void FlyingEdges::run(const DensityTree&, const Box&, double) {}
std::size_t FlyingEdges::triangles() const { return 0; }
Mesh FlyingEdges::mesh() const { return {}; }

}  // namespace deburr::bench

#endif
