// Embree itself as the peer: its own entry points for packets of 16 and for single rays, in single precision, with
// nothing of ours around them.
#pragma once
#include <memory>
#include <vector>

#include "bench/picture.hpp"
#include "polygonizer/mesh/mesh.hpp"
#include "raytracer/accel/embree.hpp"

namespace deburr::bench {

/// A mesh in Embree, built for fast rays. It is not robust, as Embree's fastest is not.
class EmbreeMesh {
public:
    explicit EmbreeMesh(const Mesh& mesh);
    RTCScene scene() const { return scene_.get(); }

private:
    std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device_;
    std::unique_ptr<RTCSceneTy, void (*)(RTCScene)> scene_;
};

/// The rays of a recording, laid out as Embree takes them.
class EmbreeRays {
public:
    /// Rays that were asked together are packets of 16, unless all are to be `alone`.
    EmbreeRays(const Recording& recording, bool alone);
    void ask(const EmbreeMesh& mesh) const;

private:
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
