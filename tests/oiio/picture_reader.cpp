// The module behind raytracer/picture_file.hpp: all code of the tests that calls OpenImageIO.
#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "raytracer/picture_file.hpp"

namespace deburr::test {
namespace {

using OIIO::TypeDesc;

ImageAttribute::second_type value_of(const OIIO::ParamValue& attribute) {
    if (attribute.type() == TypeDesc::INT) return attribute.get_int();
    if (attribute.type() == TypeDesc::FLOAT) return attribute.get_float();
    if (attribute.type() == OIIO::TypeMatrix44) {
        Matrix44 matrix;
        static_assert(sizeof matrix == 16 * sizeof(float));
        std::memcpy(&matrix, attribute.data(), sizeof matrix);
        return matrix;
    }
    return attribute.get_string();
}

}  // namespace
}  // namespace deburr::test

extern "C" __attribute__((visibility("default"))) void deburr_read_picture(const char* path,
                                                                           deburr::test::PictureFile& picture) {
    using namespace deburr::test;
    OIIO::attribute("threads", 1);  // a pool's threads may outlive what they use when the process ends
    OIIO::attribute("exr_threads", -1);
    OIIO::ImageSpec as_it_is;
    as_it_is.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::open(path, &as_it_is);
    if (!input) throw std::runtime_error(OIIO::geterror());
    const OIIO::ImageSpec& spec = input->spec();
    picture.x = spec.x, picture.y = spec.y, picture.width = spec.width, picture.height = spec.height;
    picture.full_x = spec.full_x, picture.full_y = spec.full_y;
    picture.full_width = spec.full_width, picture.full_height = spec.full_height;
    picture.channels = spec.channelnames;
    const int channels = spec.nchannels;
    for (int c = 0; c < channels; ++c) picture.types.push_back(spec.channelformat(c).c_str());
    for (const OIIO::ParamValue& a : spec.extra_attribs) picture.attributes[a.name().string()] = value_of(a);

    const auto read = [&](int first, int end, TypeDesc type, void* to) {
        if (!input->read_image(0, 0, first, end, type, to)) throw std::runtime_error(input->geterror());
    };
    picture.bytes.resize(spec.image_bytes(true));
    read(0, channels, TypeDesc::UNKNOWN, picture.bytes.data());
    const std::size_t pixels = std::size_t(spec.image_pixels());
    std::vector<float> numbers(pixels * std::size_t(channels));
    read(0, channels, TypeDesc::FLOAT, numbers.data());
    picture.values.assign(numbers.begin(), numbers.end());
    std::vector<std::uint32_t> whole(pixels);
    for (int c = 0; c < channels; ++c) {
        if (spec.channelformat(c) != TypeDesc::UINT32) continue;  // as floats they would be divided, and rounded
        read(c, c + 1, TypeDesc::UINT32, whole.data());
        for (std::size_t i = 0; i < pixels; ++i) picture.values[i * std::size_t(channels) + std::size_t(c)] = whole[i];
    }
}
