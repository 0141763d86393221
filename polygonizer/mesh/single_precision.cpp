#include "polygonizer/mesh/single_precision.hpp"

namespace deburr {
namespace {

// Not inlined, because g++ 12 (-O2, SLP) vectorizes pairs of conversions to single precision and back into nothing.
[[gnu::noinline]] float single(double x) { return float(x); }

}  // namespace

Vec3 single_precision_normal(const Mesh& mesh, const Triangle& t) {
    const auto corner = [&](std::size_t k) {
        const Vec3 x = mesh.positions[t.vertex[k]];
        return Vec3(single(x.x), single(x.y), single(x.z));
    };
    const Vec3 area = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    const double size = glm::length(area);
    return size > 0 ? area / size : Vec3(0.0);
}

SinglePrecisionLoss single_precision_loss(const Mesh& mesh) {
    SinglePrecisionLoss loss;
    loss.min_edge = mesh.triangles.empty() ? 0 : infinity;
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 a = mesh.positions[t.vertex[k]], b = mesh.positions[t.vertex[(k + 1) % 3]];
            loss.coordinate = std::max(loss.coordinate, largest(a));
            loss.min_edge = std::min(loss.min_edge, glm::distance(a, b));
        }
        loss.spoiled += glm::dot(single_precision_normal(mesh, t), mesh.area_vector(t)) <= 0;
    }
    const float coordinate = float(loss.coordinate);
    loss.step = double(std::nextafter(coordinate, std::numeric_limits<float>::infinity())) - double(coordinate);
    return loss;
}

}  // namespace deburr
