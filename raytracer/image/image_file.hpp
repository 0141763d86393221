// The film as a file: EXR with its layers and attributes, or a picture for the screen.
//
//   EXR       one part, ZIP. R G B are scene-linear Rec. 709 as the film holds them, background
//             included; A is the share of samples that hit something. A crop is a data window
//             inside the whole display window.
//   8 bit     sRGB. The background is part of the picture, so it is opaque and there is no alpha.
//             A crop is a picture of the crop's size. A PNG has 16 bits, or alpha, on request.
//   alpha     on request of films without background: colour has been weighed by alpha, as an EXR
//             has it, and is divided by it for a PNG.
//   .hdr      as 8 bit, but scene-linear.
//   exposure  is for pictures for the screen: scene-linear values are kept as they are.
//
// Half holds no more than 65504: what is brighter is written as that, so that no infinity reaches
// a filter.
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

/// Notes for a picture's header: its camera, and how it was made.
struct ImageNotes {
    Camera camera;
    int spp = 1;
    std::string date;                      // UTC, "YYYY:MM:DD hh:mm:ss"; "": none
    std::optional<double> render_seconds;  // nothing where files are to be reproducible
    /// "deburr.NAME" = value: the scene, its parameters, the seed, …
    std::vector<std::pair<std::string, std::string>> attributes;
    std::vector<std::string> solids;  // their names, for Cryptomatte
};

struct ImageFormat {
    bool float_color = false;                      // EXR: 32 bits for R G B A
    int threads = 1;                               // EXR: that compress
    int bits = 8;                                  // PNG: 8 or 16
    bool alpha = false;                            // PNG: there is an alpha, and the film is without background
    double exposure = 0;                           // sRGB: stops, each of which doubles the light
    ViewTransform view = ViewTransform::standard;  // of files for the screen, after the exposure
};

/// Writes the whole file or nothing; throws WorkError. An EXR gets all layers that the film keeps. The format follows
/// from the name, which image_kind() must know. `done` is told the share of it, from 0 to 1, as it proceeds.
void write_image(const std::string& path, const Film& film, const ImageFormat& format, const ImageNotes& notes,
                 const ShareDone& done = {});
/// Writes a raster of the kind that the format holds, as write_image does.
void write_raster(const std::string& path, const ImageRaster& image, int threads = 1, const ShareDone& done = {});

/// The sRGB transfer curve [IEC 61966-2-1], 8 bit; less than 0 and NaN give 0.
unsigned char srgb_byte(double linear);
/// Back from a place on the curve, from 0 to 1.
double linear_of_srgb(double value);
/// The sRGB transfer curve as srgb_byte has it, 16 bit.
std::uint16_t srgb_word(double linear);

}  // namespace deburr
