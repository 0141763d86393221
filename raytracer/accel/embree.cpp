#include "raytracer/accel/embree.hpp"

#include <dlfcn.h>

#include "raytracer/util/module.hpp"

namespace deburr {
namespace {

EmbreeLibrary load() {
    const auto fail = [] {
        const std::string why = dlerror();
        check_loader_memory(why);
        throw UnsupportedError("meshes and --accel embree need " DEBURR_EMBREE_LIBRARY ": " + why);
    };
    void* library = dlopen(DEBURR_EMBREE_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (!library) fail();
    EmbreeLibrary e{};
    const auto find = [&](auto& function, const char* name) {
        void* found = dlsym(library, name);
        if (!found) fail();
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(found);
    };
    find(e.new_device, "rtcNewDevice");
    find(e.release_device, "rtcReleaseDevice");
    find(e.device_error, "rtcGetDeviceError");
    find(e.new_scene, "rtcNewScene");
    find(e.release_scene, "rtcReleaseScene");
    find(e.set_scene_flags, "rtcSetSceneFlags");
    find(e.set_scene_build_quality, "rtcSetSceneBuildQuality");
    find(e.commit_scene, "rtcCommitScene");
    find(e.new_geometry, "rtcNewGeometry");
    find(e.commit_geometry, "rtcCommitGeometry");
    find(e.attach_geometry, "rtcAttachGeometry");
    find(e.release_geometry, "rtcReleaseGeometry");
    find(e.set_new_geometry_buffer, "rtcSetNewGeometryBuffer");
    find(e.set_primitive_count, "rtcSetGeometryUserPrimitiveCount");
    find(e.set_bounds_function, "rtcSetGeometryBoundsFunction");
    find(e.set_user_data, "rtcSetGeometryUserData");
    find(e.set_intersect_function, "rtcSetGeometryIntersectFunction");
    find(e.set_occluded_function, "rtcSetGeometryOccludedFunction");
    find(e.intersect, "rtcIntersect1");
    find(e.occluded, "rtcOccluded1");
    return e;
}

}  // namespace

const EmbreeLibrary& embree() {
    static const EmbreeLibrary library = load();
    return library;
}

}  // namespace deburr
