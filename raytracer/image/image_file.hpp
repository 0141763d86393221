// Writes the film as a file: EXR with its layers and attributes, or a picture for the screen.
//
//   EXR       one part, ZIP. R G B are scene-linear Rec. 709 as the film holds them, background
//             included; A is the share of samples that hit something. A crop is a data window
//             inside the whole display window.
//   8 bit     sRGB. The background is part of the picture, which is opaque and has no alpha. A crop
//             is a picture of the crop's size. A PNG has 16 bits, or alpha, on request.
//   alpha     For films without background, on request. Their colour is premultiplied by alpha, as
//             in an EXR, and is divided by it for a PNG.
//   .hdr      As 8 bit, but scene-linear.
//   exposure  Applies to pictures for the screen; scene-linear values are kept as they are.
//
// Values above 65504, the largest half, are written as 65504, so that filters meet no infinity.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "raytracer/image/image_format.hpp"
#include "raytracer/image/image_raster.hpp"
#include "raytracer/image/view_transform.hpp"
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// Information for a picture's header: its camera, and how it was made.
struct ImageNotes {
    Camera camera;
    int spp = 1;                           // samples per pixel
    std::string date;                      // UTC, "YYYY:MM:DD hh:mm:ss"; "": none
    std::optional<double> render_seconds;  // none if files are to be reproducible
    /// Pairs of "deburr.NAME" and value: the scene, its parameters, the seed and so on.
    std::vector<std::pair<std::string, std::string>> attributes;
    std::vector<std::string> solids;  // names by index, for Cryptomatte
};

/// Options of the file format.
struct ImageFormat {
    bool float_color = false;                      // EXR: 32-bit R G B A instead of half
    int threads = 1;                               // EXR: threads that compress
    int bits = 8;                                  // PNG: 8 or 16 bits per channel
    bool alpha = false;                            // PNG: with alpha; the film must be without background
    double exposure = 0;                           // for the screen: in stops, each of which doubles the light
    ViewTransform view = ViewTransform::standard;  // for the screen: applied after the exposure
};

/// Writes the whole file or nothing; throws WorkError. An EXR gets all layers that the film keeps. The format follows
/// from the file name, which image_kind() must know. `done` is called with the share that is done, from 0 to 1.
void write_image(const std::string& path, const Film& film, const ImageFormat& format, const ImageNotes& notes,
                 const ShareDone& done = {});
/// Writes a raster whose channels suit the file's format, as write_image() does.
void write_raster(const std::string& path, const ImageRaster& image, int threads = 1, const ShareDone& done = {});

/// The sRGB transfer curve [IEC 61966-2-1] in 8 bits; negative values and NaN give 0.
unsigned char srgb_byte(double linear);
/// The inverse of the sRGB transfer curve, for values from 0 to 1.
double linear_of_srgb(double value);
/// The sRGB transfer curve as in srgb_byte(), in 16 bits.
std::uint16_t srgb_word(double linear);

}  // namespace deburr
