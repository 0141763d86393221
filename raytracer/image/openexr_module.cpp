// A module behind raytracer/image/image_module.hpp: encodes EXR by OpenEXR directly. OpenImageIO would call it, too,
// but takes ten times as long to load as this takes to write a picture.
#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <algorithm>
#include <cstring>

#include "raytracer/image/image_module.hpp"

namespace deburr {
namespace {

class Memory final : public Imf::OStream {
public:
    Memory() : OStream("memory") {}
    void write(const char c[], int n) override {
        if (at_ + std::size_t(n) > bytes_.size()) bytes_.resize(at_ + std::size_t(n));
        std::memcpy(bytes_.data() + at_, c, std::size_t(n));
        at_ += std::size_t(n);
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t to) override { at_ = std::size_t(to); }
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

Imf::PixelType pixel_type(ChannelType type) {
    return type == ChannelType::half_float ? Imf::HALF : type == ChannelType::whole ? Imf::UINT : Imf::FLOAT;
}

struct AddAttribute {
    Imf::Header& header;
    const char* name;

    void operator()(int value) const { header.insert(name, Imf::IntAttribute(value)); }
    void operator()(float value) const { header.insert(name, Imf::FloatAttribute(value)); }
    void operator()(const std::string& value) const { header.insert(name, Imf::StringAttribute(value)); }
    void operator()(const Matrix44& m) const {
        float rows[4][4];
        std::memcpy(rows, m.data(), sizeof rows);
        header.insert(name, Imf::M44fAttribute(Imath::M44f(rows)));
    }
};

Imath::Box2i box(int x, int y, int width, int height) {
    return {Imath::V2i(x, y), Imath::V2i(x + width - 1, y + height - 1)};
}

std::string encode_exr(const ImageRaster& image, int threads, const ShareDone& done) {
    const Window& w = image.window;
    Imf::Header header(box(0, 0, image.width, image.height), box(w.x, w.y, w.width, w.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [name, value] : image.attributes) std::visit(AddAttribute{header, name.c_str()}, value);
    std::size_t pixel_size = 0;
    for (const ImageChannel& c : image.channels) {
        header.channels().insert(c.name, Imf::Channel(pixel_type(c.type)));
        pixel_size += size_of(c.type);
    }
    Imf::setGlobalThreadCount(threads > 1 ? threads : 0);
    Memory memory;
    {
        Imf::OutputFile file(memory, header, threads > 1 ? threads : 0);
        std::vector<char> bytes(pixel_size * std::size_t(w.width) * std::size_t(std::min(rows_at_once, w.height)));
        by_rows(image, done, [&](int row, int end) {
            Imf::FrameBuffer frame;
            std::size_t at = 0;
            const std::size_t first = std::size_t(row) * std::size_t(w.width),
                              count = std::size_t(end - row) * std::size_t(w.width);
            for (const ImageChannel& c : image.channels) {
                c.write(first, count, &bytes[at], pixel_size);
                frame.insert(c.name,
                             Imf::Slice::Make(pixel_type(c.type), &bytes[at], box(w.x, w.y + row, w.width, end - row),
                                              pixel_size, pixel_size * std::size_t(w.width)));
                at += size_of(c.type);
            }
            file.setFrameBuffer(frame);
            file.writePixels(end - row);
        });
    }
    return memory.take();
}

}  // namespace
}  // namespace deburr

extern "C" __attribute__((visibility("default"))) deburr::ExrEncoder* deburr_exr_module() { return deburr::encode_exr; }
