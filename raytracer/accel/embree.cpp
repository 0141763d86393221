#include "raytracer/accel/embree.hpp"

#include "raytracer/util/module.hpp"

namespace deburr {
namespace {

EmbreeLibrary load() {
    const SystemLibrary library(DEBURR_EMBREE_LIBRARY, "meshes and --accel embree need");
    EmbreeLibrary e{};
    library.find(e.new_device, "rtcNewDevice");
    library.find(e.release_device, "rtcReleaseDevice");
    library.find(e.device_error, "rtcGetDeviceError");
    library.find(e.new_scene, "rtcNewScene");
    library.find(e.release_scene, "rtcReleaseScene");
    library.find(e.set_scene_flags, "rtcSetSceneFlags");
    library.find(e.set_scene_build_quality, "rtcSetSceneBuildQuality");
    library.find(e.commit_scene, "rtcCommitScene");
    library.find(e.new_geometry, "rtcNewGeometry");
    library.find(e.commit_geometry, "rtcCommitGeometry");
    library.find(e.attach_geometry, "rtcAttachGeometry");
    library.find(e.release_geometry, "rtcReleaseGeometry");
    library.find(e.set_new_geometry_buffer, "rtcSetNewGeometryBuffer");
    library.find(e.set_primitive_count, "rtcSetGeometryUserPrimitiveCount");
    library.find(e.set_bounds_function, "rtcSetGeometryBoundsFunction");
    library.find(e.set_user_data, "rtcSetGeometryUserData");
    library.find(e.set_intersect_function, "rtcSetGeometryIntersectFunction");
    library.find(e.set_occluded_function, "rtcSetGeometryOccludedFunction");
    library.find(e.intersect, "rtcIntersect1");
    library.find(e.occluded, "rtcOccluded1");
    return e;
}

}  // namespace

const EmbreeLibrary& embree() {
    static const EmbreeLibrary library = load();
    return library;
}

}  // namespace deburr
