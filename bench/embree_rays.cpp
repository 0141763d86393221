#include "bench/embree_rays.hpp"

#include <algorithm>
#include <stdexcept>

namespace deburr::bench {
namespace {

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
    const auto ray = [&](std::size_t i) { return embree_ray(recording.rays()[i], recording.t_max()[i]); };
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

// Works on copies, since a query writes its result into the rays.
void EmbreeRays::ask(const EmbreeMesh& mesh) const {
    const RTCScene scene = mesh.scene();
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments closest_together, closest_apart;
    rtcInitIntersectArguments(&closest_together);
    rtcInitIntersectArguments(&closest_apart);
    closest_together.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    RTCOccludedArguments any_together, any_apart;
    rtcInitOccludedArguments(&any_together);
    rtcInitOccludedArguments(&any_apart);
    any_together.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    const auto closest16 = [&](const int* valid, RTCRayHit16& r) {
        rtcIntersect16(valid, scene, &r, &closest_together);
    };
    const auto any16 = [&](const int* valid, RTCRay16& r) { rtcOccluded16(valid, scene, &r, &any_together); };
    const auto closest1 = [&](RTCRayHit& r) { rtcIntersect1(scene, &r, &closest_apart); };
    const auto any1 = [&](RTCRay& r) { rtcOccluded1(scene, &r, &any_apart); };
#else
    RTCIntersectContext together, apart;
    rtcInitIntersectContext(&together);
    together.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcInitIntersectContext(&apart);
    const auto closest16 = [&](const int* valid, RTCRayHit16& r) { rtcIntersect16(valid, scene, &together, &r); };
    const auto any16 = [&](const int* valid, RTCRay16& r) { rtcOccluded16(valid, scene, &together, &r); };
    const auto closest1 = [&](RTCRayHit& r) { rtcIntersect1(scene, &apart, &r); };
    const auto any1 = [&](RTCRay& r) { rtcOccluded1(scene, &apart, &r); };
#endif
    for (const auto& packet : closest_packets_) {
        RTCRayHit16 rays = packet.rays;
        closest16(packet.valid, rays);
        keep(rays);
    }
    for (const auto& packet : any_packets_) {
        RTCRay16 rays = packet.rays;
        any16(packet.valid, rays);
        keep(rays);
    }
    for (RTCRayHit ray : closest_) {
        closest1(ray);
        keep(ray);
    }
    for (RTCRay ray : any_) {
        any1(ray);
        keep(ray);
    }
}

}  // namespace deburr::bench
