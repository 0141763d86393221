#include "raytracer/image/oidn.hpp"

#include <fmt/format.h>

#include <memory>

#include "raytracer/util/errors.hpp"
#include "raytracer/util/module.hpp"

namespace deburr {
namespace {

// The part of OpenImageDenoise/oidn.h that is used: opaque handles, and version 2's numeric values of types and
// formats.
using Device = struct OIDNDeviceImpl*;
using Filter = struct OIDNFilterImpl*;
constexpr int cpu_device = 1, three_floats = 3, no_error = 0;

struct Oidn {
    Device (*new_device)(int type);
    void (*set_device_int)(Device, const char* name, int value);
    void (*commit_device)(Device);
    int (*device_error)(Device, const char** message);
    void (*release_device)(Device);
    Filter (*new_filter)(Device, const char* type);
    void (*set_image)(Filter, const char* name, void* pixels, int format, std::size_t width, std::size_t height,
                      std::size_t offset, std::size_t pixel_stride, std::size_t row_stride);
    void (*set_filter_bool)(Filter, const char* name, bool value);
    void (*commit_filter)(Filter);
    void (*execute_filter)(Filter);
    void (*release_filter)(Filter);
};

Oidn load() {
    const SystemLibrary library("libOpenImageDenoise.so.2", "--denoise=oidn needs");
    Oidn o{};
    library.find(o.new_device, "oidnNewDevice");
    library.find(o.set_device_int, "oidnSetDeviceInt");
    library.find(o.commit_device, "oidnCommitDevice");
    library.find(o.device_error, "oidnGetDeviceError");
    library.find(o.release_device, "oidnReleaseDevice");
    library.find(o.new_filter, "oidnNewFilter");
    library.find(o.set_image, "oidnSetSharedFilterImage");
    library.find(o.set_filter_bool, "oidnSetFilterBool");
    library.find(o.commit_filter, "oidnCommitFilter");
    library.find(o.execute_filter, "oidnExecuteFilter");
    library.find(o.release_filter, "oidnReleaseFilter");
    return o;
}

const Oidn& oidn() {
    static const Oidn functions = load();
    return functions;
}

// The values as an array of three floats a pixel.
template <class Value>
std::vector<float> image(std::size_t pixels, const Value& value) {
    std::vector<float> floats(3 * pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const Vec3 v = value(i);
        for (std::size_t axis = 0; axis < 3; ++axis) floats[3 * i + axis] = float(v[int(axis)]);
    }
    return floats;
}

void check(Device device) {
    const char* message = nullptr;
    if (oidn().device_error(device, &message) != no_error)
        throw WorkError(fmt::format("--denoise=oidn: {}", message ? message : "the library failed"));
}

}  // namespace

void load_oidn() { oidn(); }

void denoise_by_oidn(Film& film, int threads) {
    const Oidn& o = oidn();
    const LayerPlane &normals = film.layer(ImageLayer::guide_normal), &albedos = film.layer(ImageLayer::albedo);
    const std::size_t pixels = film.pixels.size();
    std::vector<float> color = image(pixels, [&](std::size_t i) { return film.pixels[i].color; });
    std::vector<float> albedo = image(pixels, [&](std::size_t i) { return albedos.vec(i); });
    std::vector<float> normal = image(pixels, [&](std::size_t i) { return normals.vec(i); });

    const std::unique_ptr<std::remove_pointer_t<Device>, void (*)(Device)> device(o.new_device(cpu_device),
                                                                                  o.release_device);
    check(device.get());
    o.set_device_int(device.get(), "numThreads", threads);
    o.commit_device(device.get());
    check(device.get());
    const std::unique_ptr<std::remove_pointer_t<Filter>, void (*)(Filter)> filter(o.new_filter(device.get(), "RT"),
                                                                                  o.release_filter);
    check(device.get());
    const auto set = [&](const char* name, std::vector<float>& values) {
        o.set_image(filter.get(), name, values.data(), three_floats, std::size_t(film.window.width),
                    std::size_t(film.window.height), 0, 0, 0);
    };
    set("color", color);
    set("albedo", albedo);
    set("normal", normal);
    set("output", color);
    o.set_filter_bool(filter.get(), "hdr", true);
    o.commit_filter(filter.get());
    o.execute_filter(filter.get());
    check(device.get());
    for (std::size_t i = 0; i < pixels; ++i) film.pixels[i].color = {color[3 * i], color[3 * i + 1], color[3 * i + 2]};
}

}  // namespace deburr
