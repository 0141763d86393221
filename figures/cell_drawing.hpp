// One unclassified cell and what subspace polygonization makes of it, drawn as the Triage paper draws
// it: from afar, in lines [Triage, figures 13, 15, 16].
#pragma once
#include "figures/plot.hpp"
#include "polygonizer/triage/subspace.hpp"
#include "raytracer/render/integrator.hpp"

namespace deburr {

/// A cell before and after.
class CellDrawing {
public:
    /// The open cell that holds `inside`, cut by `cut` first so that it has a general form; of the two
    /// parts, the one that the plane's normal points away from.
    CellDrawing(const Solid& solid, Vec3 inside, Plane cut, Vec3 eye_direction);

    struct Point {
        Vec3 x;
        enum class On { edge, face, inside } on;
    };
    const std::vector<Point>& points() const { return points_; }
    /// Around the isosurface's polygon, points of it.
    const std::vector<int>& loop() const { return loop_; }
    /// The flat polygons that it is divided into.
    const std::vector<std::vector<int>>& faces() const { return faces_; }
    const DensityTree& density() const { return solid_.leaves.at(0).density; }
    /// Corners of the cell's faces, counter-clockwise from outside.
    const std::vector<std::vector<Vec3>>& walls() const { return walls_; }

    /// A frame, with the cell in grey: what is behind, dashed.
    Plot plot(int width, int height) const;
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
    PinholeCamera camera_;
    Vec3 towards_eye_;
};

}  // namespace deburr
