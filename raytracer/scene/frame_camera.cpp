// Let x point to the right, y up and z towards the eye e, and t be the tangents of half the angles of view. A point p
// is in the picture where |p.x − e.x| ≤ t.x (e.z − p.z), and likewise for y. So all that matters of the solids are the
// four greatest values of ±p.x + t.x p.z and ±p.y + t.y p.z, which are sides of the boxes of two linear images of them.
// Then
//     e.z = max over both axes of (right + left) / 2t,   e.x = (right − left) / 2,   e.y = (top − bottom) / 2
// leaves equal margins on opposite sides, and none on the sides that decide.
#include "raytracer/scene/frame_camera.hpp"

#include <algorithm>
#include <memory>
#include <queue>

#include "bounds/bounding_box.hpp"
#include "bounds/solid_range.hpp"
#include "raytracer/scene/default_light.hpp"
#include "raytracer/scene/solid_survey.hpp"

namespace deburr {
namespace {

// Fraction of the picture's width or height that the solids fill (chosen).
constexpr double filled_share = 0.86;

// The box of a linear image is computed from the transformed solid; of a solid with more leaves, from the corners of
// its box.
constexpr double max_laid_out = 20'000;

// Sine of the angle between `up` and a direction below which they do not determine the picture's side (chosen).
constexpr double least_view_sine = 1e-3;

struct Axes {
    Vec3 right, up, back;
};

Axes axes_of(Vec3 from, Vec3 up) {
    Axes axes;
    axes.back = glm::normalize(from);
    Vec3 side = glm::cross(up, axes.back);
    // Seen straight from above, the picture's upper edge is the far one.
    if (glm::length(side) < least_view_sine) side = Vec3(1, 0, 0);
    axes.right = glm::normalize(side - glm::dot(side, axes.back) * axes.back);
    axes.up = glm::cross(axes.back, axes.right);
    return axes;
}

// Round parts have no planes whose images could be computed. Their ends are searched for by halving boxes, first those
// that reach farthest and may contain some of the solid: to this fraction of the solid's own box, with at most this
// many boxes for each direction, and in solids with at most this many leaves.
constexpr double close_share = 1.0 / 256;
constexpr int most_boxes = 2'000;
constexpr std::size_t max_sought = 1'000;

bool has_fields(const SolidTree& tree) {
    return std::any_of(tree.leaves.begin(), tree.leaves.end(), [](const SolidLeaf& leaf) { return leaf.field; });
}

// An upper bound of the solid's coordinate along the map's axis k.
double end_along(const Affine& map, int k, const SolidTree& solid, const Box& box) {
    struct Part {
        double end;
        Box box;
        std::shared_ptr<const SolidTree> tree;  // the solid pruned to the box
        bool operator<(const Part& other) const { return end < other.end; }
    };
    std::priority_queue<Part> parts;
    const auto add = [&](const Box& within, const SolidTree& tree) {
        auto left = std::make_shared<SolidTree>(prune(tree, within));
        if (left->nodes.back().op != SolidOp::nothing) parts.push({image(map, within).hi[k], within, std::move(left)});
    };
    add(box, solid);
    if (parts.empty()) return image(map, box).hi[k];
    const auto extent = [&](const Box& of, int axis) {
        return std::abs(map.linear[axis][k]) * (of.hi[axis] - of.lo[axis]);
    };
    const double enough = close_share * (extent(box, 0) + extent(box, 1) + extent(box, 2));
    for (int boxes = 0; boxes < most_boxes; ++boxes) {
        const Part part = parts.top();
        int widest = 0;
        for (int axis = 1; axis < 3; ++axis)
            if (extent(part.box, axis) > extent(part.box, widest)) widest = axis;
        if (3 * extent(part.box, widest) <= enough) break;
        parts.pop();
        Box halves[2] = {part.box, part.box};
        halves[0].hi[widest] = halves[1].lo[widest] = 0.5 * (part.box.lo[widest] + part.box.hi[widest]);
        for (const Box& half : halves) add(half, *part.tree);
        if (parts.empty()) return image(map, box).hi[k];
    }
    return parts.top().end;
}

// Upper bounds of the solid's coordinates along the map's axes.
Vec3 ends_along(const Affine& map, const Solid& solid, const Box& box) {
    Vec3 ends = bounding_box(flatten(solid.transformed(map))).hi;
    const SolidTree tree = flatten(solid);
    if (tree.leaves.size() <= max_sought && has_fields(tree))
        for (int k = 0; k < 3; ++k) ends[k] = std::min(ends[k], end_along(map, k, tree, box));
    return ends;
}

Affine rows(Vec3 a, Vec3 b, Vec3 c) { return {glm::transpose(Mat3(a, b, c)), Vec3(0)}; }

}  // namespace

Vec3 up_axis(bool z_up) { return z_up ? Vec3(0, 0, 1) : Vec3(0, 1, 0); }

Framing default_framing(bool z_up) {
    Framing framing;
    if (z_up) framing.from = {3, -4, 2};
    return framing;
}

std::optional<Camera> framed_camera(const std::vector<Solid>& solids, const Framing& framing, Vec3 up, double aspect) {
    const Axes axes = axes_of(framing.from, up);
    const double ty = filled_share * std::tan(framing.fov * (pi / 360)), tx = ty * aspect;
    const Affine first = rows(axes.right + tx * axes.back, -axes.right + tx * axes.back, axes.up + ty * axes.back);
    const Affine second = rows(-axes.up + ty * axes.back, axes.right, axes.back);

    Box all;
    Vec3 firsts(-infinity), seconds(-infinity);  // greatest upper bounds in either linear image
    const auto none_above = [](Vec3 side, Vec3 known) { return glm::all(glm::lessThanEqual(side, known)); };
    SolidSurvey survey;
    for (const Solid& solid : solids) {
        const Box box = survey.at(solid).box;
        if (box.empty() || !box.finite()) continue;
        all = hull(all, box);
        Vec3 in_first = image(first, box).hi, in_second = image(second, box).hi;
        // Most solids of a large scene are between others.
        if (none_above(in_first, firsts) && none_above(in_second, seconds)) continue;
        if (solid.node().leaves <= max_laid_out) {
            in_first = glm::min(in_first, ends_along(first, solid, box));
            in_second = glm::min(in_second, ends_along(second, solid, box));
        }
        firsts = glm::max(firsts, in_first);
        seconds = glm::max(seconds, in_second);
    }
    if (all.empty()) return std::nullopt;

    const double right = firsts.x, left = firsts.y, top = firsts.z, bottom = seconds.x;
    const double z = std::max({(right + left) / (2 * tx), (top + bottom) / (2 * ty), seconds.z});
    const double depth = z - glm::dot(axes.back, 0.5 * (all.lo + all.hi));
    Camera camera;
    camera.fov = framing.fov;
    camera.up = axes.up;
    camera.eye = 0.5 * (right - left) * axes.right + 0.5 * (top - bottom) * axes.up + z * axes.back;
    camera.target = camera.eye - depth * axes.back;
    if (glm::dot(up, axes.up) > least_view_sine) camera.up = up;
    return camera;
}

bool frame_camera(Scene& scene, double aspect) {
    bool placed = true;
    if (scene.framing) {
        const auto camera = framed_camera(scene.solids, *scene.framing, up_axis(scene.z_up), aspect);
        placed = camera.has_value();
        if (camera) scene.camera = *camera;
    }
    if (scene.default_light) aim_default_light(scene);
    return placed;
}

}  // namespace deburr
