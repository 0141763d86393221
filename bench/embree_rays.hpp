// Embree itself, for comparison: its own entry points for packets of 16 and for single rays, in single precision,
// without this project's code.
#pragma once
#include <memory>
#include <vector>

#include "bench/picture.hpp"
#include "polygonizer/mesh/mesh.hpp"
#include "raytracer/accel/embree.hpp"

namespace deburr::bench {

/// A mesh in Embree, built for the fastest rays, which excludes its robust mode.
class EmbreeMesh {
public:
    explicit EmbreeMesh(const Mesh& mesh);
    RTCScene scene() const { return scene_.get(); }

private:
    std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device_;
    std::unique_ptr<RTCSceneTy, void (*)(RTCScene)> scene_;
};

/// The rays of a recording in Embree's layout.
class EmbreeRays {
public:
    /// Rays that were traced together become packets of 16, unless all are to be `alone`.
    EmbreeRays(const Recording& recording, bool alone);
    /// Traces all rays.
    void ask(const EmbreeMesh& mesh) const;

private:
    // A packet of 16 rays and the lanes that are used.
    template <class Rays>
    struct Packet {
        alignas(64) int valid[16];
        Rays rays;
    };
    std::vector<Packet<RTCRayHit16>> closest_packets_;
    std::vector<Packet<RTCRay16>> any_packets_;
    std::vector<RTCRayHit> closest_;
    std::vector<RTCRay> any_;
};

}  // namespace deburr::bench
