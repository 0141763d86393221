#include "raytracer/image/image_module.hpp"

#include "raytracer/util/module.hpp"

namespace deburr {

const ImageModule& image_module() {
    static const ImageModule* const module =
        module_function<ImageModuleEntry>(DEBURR_IMAGE_MODULE, image_module_entry, "pictures other than EXR and PNG")();
    return *module;
}

ExrEncoder* exr_encoder() {
    static ExrEncoder* const encoder =
        module_function<ExrModuleEntry>(DEBURR_EXR_MODULE, exr_module_entry, "EXR pictures")();
    return encoder;
}

}  // namespace deburr
