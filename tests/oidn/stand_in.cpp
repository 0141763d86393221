// A stand-in for Open Image Denoise 2 with the functions that Deburr calls, for tests without the library. Its output
// is ½ of the colour + 0.3 of the albedo + 0.2 of the normal. Missing calls are errors as in the library, and so are
// more than eight threads, so that there is an error to test.
#include <cstddef>
#include <map>
#include <string>

struct OIDNDeviceImpl {
    int threads = 0;
    bool committed = false;
    const char* error = nullptr;
};

struct OIDNFilterImpl {
    struct Image {
        float* pixels;
        std::size_t width, height;
    };
    OIDNDeviceImpl* device;
    std::map<std::string, Image> images;
    bool hdr = false, committed = false;
};

extern "C" {

OIDNDeviceImpl* oidnNewDevice(int type) { return type == 1 ? new OIDNDeviceImpl : nullptr; }
void oidnReleaseDevice(OIDNDeviceImpl* device) { delete device; }
void oidnSetDeviceInt(OIDNDeviceImpl* device, const char* name, int value) {
    if (name == std::string("numThreads")) device->threads = value;
}
void oidnCommitDevice(OIDNDeviceImpl* device) {
    device->committed = true;
    if (device->threads > 8) device->error = "too many threads";
}
int oidnGetDeviceError(OIDNDeviceImpl* device, const char** message) {
    if (!device) return 5;
    *message = device->error;
    return device->error ? 2 : 0;
}
OIDNFilterImpl* oidnNewFilter(OIDNDeviceImpl* device, const char* type) {
    if (!device->committed || type != std::string("RT")) {
        device->error = "the device is not committed";
        return nullptr;
    }
    return new OIDNFilterImpl{.device = device};
}
void oidnReleaseFilter(OIDNFilterImpl* filter) { delete filter; }
void oidnSetSharedFilterImage(OIDNFilterImpl* filter, const char* name, void* pixels, int format, std::size_t width,
                              std::size_t height, std::size_t offset, std::size_t pixel_stride,
                              std::size_t row_stride) {
    if (format != 3 || offset != 0 || pixel_stride != 0 || row_stride != 0)
        filter->device->error = "expected three floats, densely";
    else
        filter->images[name] = {static_cast<float*>(pixels), width, height};
}
void oidnSetFilterBool(OIDNFilterImpl* filter, const char* name, bool value) {
    if (name == std::string("hdr")) filter->hdr = value;
}
void oidnCommitFilter(OIDNFilterImpl* filter) { filter->committed = true; }
void oidnExecuteFilter(OIDNFilterImpl* filter) {
    if (!filter->committed || !filter->hdr || filter->images.size() != 4) {
        filter->device->error = "the filter is not complete";
        return;
    }
    const auto &color = filter->images["color"], &albedo = filter->images["albedo"], &normal = filter->images["normal"],
               &output = filter->images["output"];
    for (std::size_t i = 0; i < 3 * output.width * output.height; ++i)
        output.pixels[i] = 0.5f * color.pixels[i] + 0.3f * albedo.pixels[i] + 0.2f * normal.pixels[i];
}

}  // extern "C"
