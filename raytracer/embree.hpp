// Embree 3 or 4: what its users share.
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <memory>
#include <mutex>
#include <string>

#include "raytracer/errors.hpp"

namespace deburr {

/// A query's own; further members may be added by derivation.
#if RTC_VERSION_MAJOR >= 4
struct EmbreeContext : RTCRayQueryContext {
    EmbreeContext() { rtcInitRayQueryContext(this); }
};
#else
struct EmbreeContext : RTCIntersectContext {
    EmbreeContext() { rtcInitIntersectContext(this); }
};
#endif

/// One scene, to be filled and then committed.
class EmbreeScene {
public:
    EmbreeScene() : device_(shared_device()), scene_(rtcNewScene(device_.get())) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;
    ~EmbreeScene() { rtcReleaseScene(scene_); }

    RTCGeometry new_geometry(RTCGeometryType type) { return rtcNewGeometry(device_.get(), type); }
    void add(RTCGeometry geometry) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
    }
    /// `what` is in it, if it does not fit.
    void commit(const std::string& what) {
        rtcCommitScene(scene_);
        if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) throw WorkError("Embree cannot hold " + what + ": out of memory");
    }

#if RTC_VERSION_MAJOR >= 4
    void intersect(RTCRayHit& ray, EmbreeContext& context) const {
        RTCIntersectArguments arguments;
        rtcInitIntersectArguments(&arguments);
        arguments.context = &context;
        rtcIntersect1(scene_, &ray, &arguments);
    }
    void occluded(RTCRay& ray, EmbreeContext& context) const {
        RTCOccludedArguments arguments;
        rtcInitOccludedArguments(&arguments);
        arguments.context = &context;
        rtcOccluded1(scene_, &ray, &arguments);
    }
#else
    void intersect(RTCRayHit& ray, EmbreeContext& context) const { rtcIntersect1(scene_, &context, &ray); }
    void occluded(RTCRay& ray, EmbreeContext& context) const { rtcOccluded1(scene_, &context, &ray); }
#endif

private:
    using Device = std::shared_ptr<RTCDeviceTy>;
    static Device shared_device() {
        static std::mutex mutex;
        static std::weak_ptr<RTCDeviceTy> known;
        const std::lock_guard lock(mutex);
        Device device = known.lock();
        if (device) return device;
        RTCDevice fresh = rtcNewDevice(nullptr);
        if (!fresh) throw WorkError("Embree does not start on this machine");
        device = Device(fresh, rtcReleaseDevice);
        known = device;
        return device;
    }

    Device device_;
    RTCScene scene_;
};

}  // namespace deburr
