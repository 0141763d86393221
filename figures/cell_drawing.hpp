// Line drawings, as in the Triage paper, of a single unclassified cell and its subspace polygonization [Triage, figures
// 13, 15, 16], seen from afar.
#pragma once
#include "figures/plot.hpp"
#include "polygonizer/triage/subspace.hpp"
#include "raytracer/render/integrator.hpp"

namespace deburr {

/// A cell before and after its polygonization.
class CellDrawing {
public:
    /// Draws the open cell that contains `inside`, as seen from `eye_direction`. It is first cut by `cut`, to give it a
    /// general shape; the part on the side that the plane's normal points away from is kept.
    CellDrawing(const Solid& solid, Vec3 inside, Plane cut, Vec3 eye_direction);

    /// A point of the polygonization, and the part of the cell that it is on.
    struct Point {
        Vec3 x;
        enum class On { edge, face, inside } on;
    };
    const std::vector<Point>& points() const { return points_; }
    /// The vertices of the isosurface's polygon, in order, as indices of points().
    const std::vector<int>& loop() const { return loop_; }
    /// The flat polygons that it is divided into, as indices of points().
    const std::vector<std::vector<int>>& faces() const { return faces_; }
    /// The density in the cell.
    const DensityTree& density() const { return solid_.leaves.at(0).density; }
    /// The faces of the cell as polygons, counter-clockwise from outside.
    const std::vector<std::vector<Vec3>>& walls() const { return walls_; }

    /// An empty plot of the projected cell in grey; edges at the back are dashed.
    Plot plot(int width, int height) const;
    /// Projection to the plot; the functions below draw points in space.
    Vec2 project(Vec3 x) const;
    Curve polygon(const std::vector<Vec3>& corners, const std::string& color, double opacity) const;
    Curve line(const std::vector<Vec3>& through, const std::string& color, double width,
               const std::string& dash = {}) const;
    Curve dots(const std::vector<Vec3>& at, const std::string& color) const;

private:
    SolidTree solid_;
    std::vector<Point> points_;
    std::vector<int> loop_;
    std::vector<std::vector<int>> faces_;
    std::vector<std::vector<Vec3>> walls_;
    ProjectiveCamera camera_;
    Vec3 towards_eye_;
};

}  // namespace deburr
