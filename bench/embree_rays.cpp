#include "bench/embree_rays.hpp"

#include <limits>
#include <stdexcept>

namespace deburr::bench {
namespace {

float farthest(double t_max) { return float(std::min(t_max, double(std::numeric_limits<float>::max()))); }

RTCRay ray_of(const Ray& ray, double t_max) {
    RTCRay r{};
    r.org_x = float(ray.origin.x);
    r.org_y = float(ray.origin.y);
    r.org_z = float(ray.origin.z);
    r.dir_x = float(ray.direction.x);
    r.dir_y = float(ray.direction.y);
    r.dir_z = float(ray.direction.z);
    r.tfar = farthest(t_max);
    r.mask = ~0u;
    return r;
}

void set(RTCRay16& rays, int k, const RTCRay& r) {
    rays.org_x[k] = r.org_x;
    rays.org_y[k] = r.org_y;
    rays.org_z[k] = r.org_z;
    rays.dir_x[k] = r.dir_x;
    rays.dir_y[k] = r.dir_y;
    rays.dir_z[k] = r.dir_z;
    rays.tnear[k] = 0;
    rays.time[k] = 0;
    rays.tfar[k] = r.tfar;
    rays.mask[k] = r.mask;
    rays.id[k] = rays.flags[k] = 0;
}

}  // namespace

EmbreeMesh::EmbreeMesh(const Mesh& mesh)
    : device_(rtcNewDevice(nullptr), rtcReleaseDevice), scene_(rtcNewScene(device_.get()), rtcReleaseScene) {
    rtcSetSceneBuildQuality(scene(), RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.positions.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), mesh.triangles.size()));
    if (!vertices || !indices) throw std::runtime_error("Embree has no room for the mesh");
    for (const Vec3& x : mesh.positions)
        for (int k = 0; k < 3; ++k) *vertices++ = float(x[k]);
    for (const Triangle& t : mesh.triangles)
        for (const int v : t.vertex) *indices++ = unsigned(v);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene());
}

EmbreeRays::EmbreeRays(const Recording& recording, bool alone) {
    const auto ray = [&](std::size_t i) { return ray_of(recording.rays()[i], recording.t_max()[i]); };
    for (const Recording::Question& q : recording.questions()) {
        const std::size_t end = q.first + q.count;
        if (alone || q.alone) {
            for (std::size_t i = q.first; i < end; ++i)
                if (q.any) {
                    any_.push_back(ray(i));
                } else {
                    closest_.emplace_back().ray = ray(i);
                    closest_.back().hit.geomID = RTC_INVALID_GEOMETRY_ID;
                }
            continue;
        }
        for (std::size_t first = q.first; first < end; first += 16) {
            int valid[16];
            RTCRayHit16 rays{};
            for (std::size_t k = 0; k < 16; ++k) {
                valid[k] = first + k < end ? -1 : 0;
                set(rays.ray, int(k), ray(std::min(first + k, end - 1)));
                rays.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            }
            if (q.any)
                std::copy_n(valid, 16, any_packets_.emplace_back(Packet<RTCRay16>{{}, rays.ray}).valid);
            else
                std::copy_n(valid, 16, closest_packets_.emplace_back(Packet<RTCRayHit16>{{}, rays}).valid);
        }
    }
}

// A query writes into its rays: each works on a copy.
void EmbreeRays::ask(const EmbreeMesh& mesh) const {
    RTCIntersectContext together, apart;
    rtcInitIntersectContext(&together);
    together.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcInitIntersectContext(&apart);
    for (const auto& packet : closest_packets_) {
        RTCRayHit16 rays = packet.rays;
        rtcIntersect16(packet.valid, mesh.scene(), &together, &rays);
        keep(rays);
    }
    for (const auto& packet : any_packets_) {
        RTCRay16 rays = packet.rays;
        rtcOccluded16(packet.valid, mesh.scene(), &together, &rays);
        keep(rays);
    }
    for (RTCRayHit ray : closest_) {
        rtcIntersect1(mesh.scene(), &apart, &ray);
        keep(ray);
    }
    for (RTCRay ray : any_) {
        rtcOccluded1(mesh.scene(), &apart, &ray);
        keep(ray);
    }
}

}  // namespace deburr::bench
