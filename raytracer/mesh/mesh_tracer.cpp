#include "raytracer/mesh/mesh_tracer.hpp"

#include <algorithm>

#include "raytracer/accel/embree.hpp"
#include "raytracer/mesh/split_distant_triangles.hpp"

namespace deburr {
namespace {

// Embree's intersections are off by a few units in the last place of the coordinates; a ray that leaves a surface
// starts at this fraction of the largest coordinate away from it.
constexpr double lift = 64 * double(std::numeric_limits<float>::epsilon());

// How far a normal is turned beyond the side view, as a fraction of the angle: far above rounding, far below anything
// visible.
constexpr double min_tilt = 1e-6;

// Computes in double precision where the ray meets the plane of the triangle x + u·e1 + v·e2: single precision is off
// by 10⁻⁷ of the triangle's size, and floors are large. If the ray is nearly parallel to the plane, u and v stay.
void meet(const Ray& ray, Vec3 x, Vec3 e1, Vec3 e2, double& u, double& v) {
    const Vec3 area = glm::cross(e1, e2);
    const double rate = glm::dot(area, ray.direction);
    if (std::abs(rate) <= 1e-9 * glm::length(area)) return;
    const Vec3 moment = glm::cross(ray.origin - x, ray.direction);
    u = glm::dot(e2, moment) / -rate;
    v = glm::dot(e1, moment) / rate;
}

}  // namespace

struct MeshTracer::Embree {
    EmbreeScene scene;

    explicit Embree(const Mesh& mesh) {
        if (!mesh.triangles.empty()) add(mesh);
        scene.commit("the mesh");
    }

private:
    void add(const Mesh& mesh) {
        RTCGeometry geometry = scene.new_geometry(RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(embree().set_new_geometry_buffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
        auto* indices = static_cast<unsigned*>(embree().set_new_geometry_buffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangles.size()));
        if (vertices && indices) {
            for (const Vec3& x : mesh.positions)
                for (int k = 0; k < 3; ++k) *vertices++ = float(x[k]);
            for (const Triangle& t : mesh.triangles)
                for (const int v : t.vertex) *indices++ = unsigned(v);
        }
        scene.add(geometry);
    }
};

MeshTracer::MeshTracer(Mesh mesh, const Box& near)
    : mesh_(split_distant_triangles(std::move(mesh), near)), embree_(std::make_unique<Embree>(mesh_)) {
    if (mesh_.triangles.empty()) return;
    const Box box = bounding_box(mesh_);
    middle_ = 0.5 * (box.lo + box.hi);
    radius_ = 0.5 * glm::length(box.hi - box.lo);
}
MeshTracer::~MeshTracer() = default;

// The parameter at which a ray from far away is restarted near the mesh; 0 for other rays.
double MeshTracer::start(const Ray& ray) const {
    constexpr double far = 64;         // in radii: there single precision is a millionth of the mesh's size
    constexpr double clearance = 1.5;  // in radii, before the point nearest to the center
    const double nearest = glm::dot(middle_ - ray.origin, ray.direction);
    return nearest > far * radius_ ? nearest - clearance * radius_ : 0;
}

Hit MeshTracer::closest_hit(const Ray& ray, double t_max, TraceCounters& counters) const {
    ++counters.rays;
    const double begin = start(ray);
    const Ray near{ray.origin + begin * ray.direction, ray.direction};
    if (begin > 0 && begin >= t_max) return {};
    RTCRayHit query{};
    query.ray = embree_ray(near, t_max - begin);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    EmbreeContext context;
    embree_->scene.intersect(query, context);
    Hit hit;
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
    const Triangle& t = mesh_.triangles[query.hit.primID];
    const auto at = [&](std::size_t k) { return mesh_.positions[t.vertex[k]]; };
    const auto normal = [&](std::size_t k) { return mesh_.normals[t.normal[k]]; };
    const Vec3 e1 = at(1) - at(0), e2 = at(2) - at(0);
    double u = query.hit.u, v = query.hit.v;
    meet(near, at(0), e1, e2, u, v);
    const double w = 1 - u - v;
    hit.position = at(0) + u * e1 + v * e2;
    const Vec3 n = w * normal(0) + u * normal(1) + v * normal(2);
    const Vec3 facet = glm::cross(e1, e2);
    hit.normal = glm::length(n) > 0 ? glm::normalize(n) : glm::normalize(facet);
    // Near an outline the interpolated normal may face away though the facet does not. It is turned until it is seen
    // from the side, as the outline would be black otherwise.
    const double away = glm::dot(hit.normal, ray.direction);
    if (away * glm::dot(facet, ray.direction) < 0)
        hit.normal = glm::normalize(hit.normal - (1 + min_tilt) * away * ray.direction);
    hit.t = std::max(glm::dot(hit.position - ray.origin, ray.direction), double(std::numeric_limits<float>::min()));
    hit.solid = t.solid;
    hit.material = t.material;
    hit.offset = lift * std::max(largest(hit.position), largest(near.origin));
    return hit;
}

bool MeshTracer::any_hit(const Ray& ray, double t_max, TraceCounters& counters) const {
    ++counters.shadow_rays;
    const double begin = start(ray);
    if (begin > 0 && begin >= t_max) return false;
    RTCRay query = embree_ray({ray.origin + begin * ray.direction, ray.direction}, t_max - begin);
    EmbreeContext context;
    embree_->scene.occluded(query, context);
    return query.tfar < 0;
}

}  // namespace deburr
