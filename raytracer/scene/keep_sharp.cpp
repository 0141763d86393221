#include "raytracer/scene/keep_sharp.hpp"

#include <fmt/format.h>

#include <utility>

#include "bounds/selective_mesh_field.hpp"

namespace deburr {

std::string KeepSharp::text() const {
    std::string all =
        fmt::format("{} {} {} {}", int(edges), below.value_or(-infinity), above.value_or(infinity), fade.value_or(0));
    for (const Box& b : boxes) all += fmt::format(" {} {} {} {} {} {}", b.lo.x, b.lo.y, b.lo.z, b.hi.x, b.hi.y, b.hi.z);
    return all;
}

FieldPtr rounded_mesh(ClosedMeshPtr mesh, double radius, const KeepSharp& keep, bool z_up) {
    constexpr double usual_fade = 3;  // in radii; edges that end at a kept one become thin over twice their width
    KeptEdges kept{keep.edges, keep.boxes, keep.fade.value_or(usual_fade * radius)};
    const int up = z_up ? 2 : 1;
    Box below = Box::everything(), above = Box::everything();
    if (keep.below) {
        below.hi[up] = *keep.below;
        kept.regions.push_back(below);
    }
    if (keep.above) {
        above.lo[up] = *keep.above;
        kept.regions.push_back(above);
    }
    if (radius == 0 || !keep.any()) return std::make_shared<MeshField>(std::move(mesh), radius);
    return std::make_shared<SelectiveMeshField>(std::move(mesh), radius, std::move(kept));
}

}  // namespace deburr
