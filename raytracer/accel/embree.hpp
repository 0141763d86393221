// Access to Embree 3 or 4 for the rest of the program: the loaded library, rays, query contexts and scenes.
//
// The library (42 MB) is loaded when it is first used: linking it would add a millisecond to every run of the program.
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
#include <string>

#include "raytracer/simd/ray_packet.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {

/// The functions of Embree that are called, under this project's names.
struct EmbreeLibrary {
    decltype(&rtcNewDevice) new_device;
    decltype(&rtcReleaseDevice) release_device;
    decltype(&rtcGetDeviceError) device_error;
    decltype(&rtcNewScene) new_scene;
    decltype(&rtcReleaseScene) release_scene;
    decltype(&rtcSetSceneFlags) set_scene_flags;
    decltype(&rtcSetSceneBuildQuality) set_scene_build_quality;
    decltype(&rtcCommitScene) commit_scene;
    decltype(&rtcNewGeometry) new_geometry;
    decltype(&rtcCommitGeometry) commit_geometry;
    decltype(&rtcAttachGeometry) attach_geometry;
    decltype(&rtcReleaseGeometry) release_geometry;
    decltype(&rtcSetNewGeometryBuffer) set_new_geometry_buffer;
    decltype(&rtcSetGeometryUserPrimitiveCount) set_primitive_count;
    decltype(&rtcSetGeometryBoundsFunction) set_bounds_function;
    decltype(&rtcSetGeometryUserData) set_user_data;
    decltype(&rtcSetGeometryIntersectFunction) set_intersect_function;
    decltype(&rtcSetGeometryOccludedFunction) set_occluded_function;
    decltype(&rtcIntersect1) intersect;
    decltype(&rtcOccluded1) occluded;
};

/// The library, loaded by the first call. Throws UnsupportedError if it cannot be loaded.
const EmbreeLibrary& embree();

/// The ray in Embree's single precision, in [0, t_max].
inline RTCRay embree_ray(const Ray& ray, double t_max) {
    RTCRay r{};
    r.org_x = float(ray.origin.x);
    r.org_y = float(ray.origin.y);
    r.org_z = float(ray.origin.z);
    r.dir_x = float(ray.direction.x);
    r.dir_y = float(ray.direction.y);
    r.dir_z = float(ray.direction.z);
    r.tnear = 0;
    r.tfar = float(std::min(t_max, double(std::numeric_limits<float>::max())));
    r.mask = ~0u;
    return r;
}

/// The context of one query; users derive from it to pass their own data to callbacks.
#if RTC_VERSION_MAJOR >= 4
struct EmbreeContext : RTCRayQueryContext {
    EmbreeContext() { rtcInitRayQueryContext(this); }
};
#else
struct EmbreeContext : RTCIntersectContext {
    EmbreeContext() { rtcInitIntersectContext(this); }
};
#endif

/// An Embree scene: geometries are added, it is committed once, then rays are traced. Throws WorkError if Embree runs
/// out of memory.
class EmbreeScene {
public:
    EmbreeScene() : device_(shared_device()), scene_(library_.new_scene(device_)) {
        if (!scene_) fail("a scene");
        library_.set_scene_flags(scene_, RTC_SCENE_FLAG_ROBUST);
        library_.set_scene_build_quality(scene_, RTC_BUILD_QUALITY_HIGH);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;
    ~EmbreeScene() {
        if (!out_of_memory) library_.release_scene(scene_);
    }

    RTCGeometry new_geometry(RTCGeometryType type) {
        const RTCGeometry geometry = library_.new_geometry(device_, type);
        if (!geometry) fail("a geometry");
        return geometry;
    }
    /// Commits the geometry, adds it to the scene and gives up the caller's reference to it.
    void add(RTCGeometry geometry) {
        library_.commit_geometry(geometry);
        library_.attach_geometry(scene_, geometry);
        library_.release_geometry(geometry);
    }
    /// Builds the scene. `what` names its content in the message of the error if memory does not suffice.
    void commit(const std::string& what) {
        library_.commit_scene(scene_);
        if (library_.device_error(device_) != RTC_ERROR_NONE) fail(what);
    }

#if RTC_VERSION_MAJOR >= 4
    void intersect(RTCRayHit& ray, EmbreeContext& context) const {
        RTCIntersectArguments arguments;
        rtcInitIntersectArguments(&arguments);
        arguments.context = &context;
        library_.intersect(scene_, &ray, &arguments);
    }
    void occluded(RTCRay& ray, EmbreeContext& context) const {
        RTCOccludedArguments arguments;
        rtcInitOccludedArguments(&arguments);
        arguments.context = &context;
        library_.occluded(scene_, &ray, &arguments);
    }
#else
    void intersect(RTCRayHit& ray, EmbreeContext& context) const { library_.intersect(scene_, &context, &ray); }
    void occluded(RTCRay& ray, EmbreeContext& context) const { library_.occluded(scene_, &context, &ray); }
#endif

private:
    /// Set once an allocation of Embree's has failed. Embree then leaves locks of its allocator held, and releasing
    /// objects could wait for them forever, so nothing is released any more.
    static inline std::atomic<bool> out_of_memory{false};

    [[noreturn]] static void fail(const std::string& what) {
        out_of_memory = true;
        throw WorkError("Embree cannot hold " + what + ": out of memory");
    }

    /// The process's only device. It is never released, since after a failed allocation that could wait forever, too.
    static RTCDevice shared_device() {
        static std::mutex mutex;
        static RTCDevice device = nullptr;
        const std::lock_guard lock(mutex);
        if (device) return device;
        device = embree().new_device(nullptr);
        if (!device && embree().device_error(nullptr) == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
        if (!device) throw WorkError("Embree does not start on this machine");
        return device;
    }

    const EmbreeLibrary& library_ = embree();
    RTCDevice device_;
    RTCScene scene_;
};

}  // namespace deburr
