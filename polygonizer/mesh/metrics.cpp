#include "polygonizer/mesh/metrics.hpp"

#include <algorithm>

#include "polygonizer/mesh/facet_judge.hpp"
#include "polygonizer/mesh/facet_orientation.hpp"

namespace deburr {
namespace {

constexpr double degrees = 180 / pi;

struct Sum {
    double total = 0, max = 0;
    std::size_t count = 0;
    void add(double x) {
        total += x;
        max = std::max(max, x);
        ++count;
    }
    Spread spread() const { return {count ? total / double(count) : 0, max}; }
};

// A triangle whose height is below this fraction of its longest side counts as having no area.
constexpr double flat = 1e-9;

void measure_edges(const Mesh& mesh, MeshMetrics& m) {
    double sum = 0, squares = 0;
    std::size_t count = 0;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const int a = t.vertex[k], b = t.vertex[(k + 1) % 3];
            if (a > b) continue;  // each edge once, because the mesh is closed
            const double length = glm::length(mesh.positions[a] - mesh.positions[b]);
            sum += length;
            squares += length * length;
            ++count;
        }
    if (count == 0 || sum == 0) return;
    m.edge_mean = sum / double(count);
    m.edge_spread = std::sqrt(std::max(0.0, squares / double(count) - m.edge_mean * m.edge_mean)) / m.edge_mean;
}

void measure_vertices(const Mesh& mesh, const DistanceField& field, MeshMetrics& m) {
    Sum distance, angle;
    std::vector<char> used(mesh.positions.size(), false);
    std::vector<Vec3> around(mesh.normals.size(), Vec3(0.0));
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            used[t.vertex[k]] = true;
            around[t.normal[k]] += mesh.area_vector(t);
        }
    for (std::size_t v = 0; v < used.size(); ++v)
        if (used[v]) distance.add(std::abs(field.at(mesh.positions[v]).distance));
    for (std::size_t n = 0; n < around.size(); ++n) {
        const double size = glm::length(around[n]);
        if (size > 0)
            angle.add(std::acos(std::clamp(glm::dot(around[n], mesh.normals[n]) / size, -1.0, 1.0)) * degrees);
    }
    m.vertex_distance = distance.max;
    m.vertex_distance_mean = distance.spread().mean;
    m.vertex_normal_degrees = angle.spread();
}

}  // namespace

MeshMetrics measure(const Mesh& mesh, const SolidTree& solid) {
    MeshMetrics m;
    m.topology = topology(mesh);
    m.polygons = mesh.polygons;
    m.volume = volume(mesh);
    m.box = bounding_box(mesh);
    measure_edges(mesh, m);
    const DistanceField field = field_around(mesh, solid);
    const double reach = m.box.empty() ? 0 : glm::length(m.box.hi - m.box.lo);
    measure_vertices(mesh, field, m);
    Sum first, far, angle;
    for (const Triangle& t : mesh.triangles) {
        Vec3 middle(0.0), normals(0.0);
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 x = mesh.positions[t.vertex[k]];
            middle += x / 3.0;
            normals += mesh.normals[t.normal[k]];
            longest = std::max(longest, glm::length(x - mesh.positions[t.vertex[(k + 1) % 3]]));
        }
        const Vec3 area = mesh.area_vector(t);
        const double twice = glm::length(area);
        m.area += 0.5 * twice;
        if (twice <= flat * longest * longest) {
            ++m.degenerate;
            continue;
        }
        const SurfaceSample here = field.at(middle);
        m.inverted += !faces_outward(field, middle, here, area / twice, normals, longest);
        if (here.normal == Vec3(0.0)) continue;
        first.add(std::abs(here.distance));
        const double distance = field.distance_along_normal(middle, std::min(reach, 0.5 * longest));
        far.add(std::isfinite(distance) ? distance : std::abs(here.distance));
        const double cosine = glm::dot(area, here.normal) / twice;
        angle.add(std::acos(std::clamp(cosine, -1.0, 1.0)) * degrees);
    }
    m.first_order = first.spread();
    m.distance = far.spread();
    m.normal_degrees = angle.spread();
    return m;
}

MeshMetrics combined(const std::vector<MeshMetrics>& parts) {
    MeshMetrics all;
    const auto merge = [](Spread& to, const Spread& from, double share) {
        to.mean += from.mean * share;
        to.max = std::max(to.max, from.max);
    };
    std::size_t triangles = 0;
    for (const MeshMetrics& m : parts) triangles += m.topology.triangles;
    double squares = 0;
    for (const MeshMetrics& m : parts) {
        const double share = triangles ? double(m.topology.triangles) / double(triangles) : 0;
        Topology& t = all.topology;
        t.vertices += m.topology.vertices;
        t.edges += m.topology.edges;
        t.triangles += m.topology.triangles;
        t.open_edges += m.topology.open_edges;
        t.nonmanifold_edges += m.topology.nonmanifold_edges;
        t.flipped_edges += m.topology.flipped_edges;
        t.nonmanifold_vertices += m.topology.nonmanifold_vertices;
        t.shells += m.topology.shells;
        t.euler += m.topology.euler;
        all.polygons += m.polygons;
        all.area += m.area;
        all.volume += m.volume;
        if (!m.box.empty()) all.box = hull(all.box, m.box);
        all.vertex_distance = std::max(all.vertex_distance, m.vertex_distance);
        all.vertex_distance_mean += share * m.vertex_distance_mean;
        merge(all.vertex_normal_degrees, m.vertex_normal_degrees, share);
        merge(all.first_order, m.first_order, share);
        merge(all.distance, m.distance, share);
        merge(all.normal_degrees, m.normal_degrees, share);
        all.inverted += m.inverted;
        all.degenerate += m.degenerate;
        all.edge_mean += share * m.edge_mean;
        squares += share * m.edge_mean * m.edge_mean * (1 + m.edge_spread * m.edge_spread);
    }
    if (all.edge_mean > 0) all.edge_spread = std::sqrt(std::max(0.0, squares / (all.edge_mean * all.edge_mean) - 1));
    return all;
}

}  // namespace deburr
