// True convolution as a solid: rendered beside quasi-convolution and polygonized, and a map of the distance between
// both.
#include "bounds/bounding_box.hpp"
#include "figures/figure.hpp"
#include "figures/studio.hpp"
#include "polygonizer/mesh/surface_distance.hpp"
#include "polygonizer/triage/triage.hpp"

namespace deburr {
namespace {

constexpr int shades = 16;

// Colours from pale grey to red, linear.
std::vector<Vec3> palette() {
    std::vector<Vec3> all;
    for (int k = 0; k < shades; ++k) {
        const double s = std::sqrt((k + 0.5) / shades);
        all.push_back(glm::mix(Vec3(0.72, 0.76, 0.80), Vec3(0.62, 0.05, 0.02), s));
    }
    return all;
}

double distance_between(const DistanceField& other, Vec3 x, double reach) {
    const double d = std::abs(other.distance_along_normal(x, reach));
    return std::isfinite(d) ? d : std::abs(other.at(x).distance);
}

void make(FigureContext& context) {
    const Scene scene = context.scene("convolution.lua");
    context.picture(context.render(scene, {.width = 720, .height = 400, .spp = 10}),
                    "Left quasi-convolution, right true convolution");

    const Solid &first = scene.solids.at(0), &second = scene.solids.at(1);
    const auto middle = [](const Solid& solid) {
        const Box box = bounding_box(flatten(solid));
        return 0.5 * (box.lo + box.hi);
    };
    const SolidTree exact = flatten(second),
                    quasi = flatten(first.transformed({Mat3(1.0), middle(second) - middle(first)}));
    const Box box = polygonization_box(exact);
    const double r = exact.leaves.at(0).density.half_spaces.at(0).radius;
    Mesh mesh = triage(exact, box, {.tolerance = 0.02 * r});
    const Topology shape = topology(mesh);

    const DistanceField at_quasi(quasi, box, 2 * r), at_exact(exact, box, 2 * r);
    double worst = 0, mean = 0, area = 0, off = 0;
    std::vector<double> distances;
    for (const Triangle& t : mesh.triangles) {
        const auto corner = [&](int k) { return mesh.positions[t.vertex[k]]; };
        const Vec3 center = (corner(0) + corner(1) + corner(2)) / 3.0;
        const double size = 0.5 * glm::length(mesh.area_vector(t)), d = distance_between(at_quasi, center, 2 * r);
        distances.push_back(d);
        worst = std::max(worst, d);
        mean += size * d;
        area += size;
        off = std::max(off, std::abs(at_exact.at(center).distance));
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        mesh.triangles[i].material = std::min(shades - 1, int(shades * distances[i] / worst));
    const Camera camera = framing(box_of(mesh), {0.25, 1.1, 1}, 720, 400, 22);
    context.picture(
        mesh_picture(context, mesh, palette(), camera, {.width = 720, .height = 400, .shading = Shading::smooth}),
        fmt::format("The true convolution, polygonized; red where quasi-convolution is farthest from it: {:.2f} r",
                    worst / r));
    context.measured(
        fmt::format("Triage polygonizes the true convolution too: {} triangles, {}, at their middles within {:.4f} r "
                    "of its surface. Quasi-convolution is "
                    "{:.3f} r from it on average over the surface, and {:.2f} r at the most, in the acute tips.",
                    mesh.triangles.size(), shape.manifold() ? "closed and 2-manifold" : "not a closed 2-manifold",
                    off / r, mean / area / r, worst / r));
}

const RegisteredFigure registered{{
    .name = "beyond-convolution",
    .title = "True convolution, rendered and polygonized",
    .shows = "A star rounded by the approximation of both papers and by what it approximates, with one radius; below, "
             "how far apart the two are.",
    .claim = "The approximate isosurface should be fairly close to the true convolution around square edges and "
             "corners (Lobb §2.3.1); "
             "polygonizing a true convolution is future work (Triage §8).",
    .scenes = {"convolution.lua"},
    .seconds = 90,
    .make = make,
}};

}  // namespace
}  // namespace deburr
