// The options of deburr render.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "raytracer/cli/farm_options.hpp"
#include "raytracer/cli/options.hpp"
#include "raytracer/image/denoise.hpp"
#include "raytracer/image/view_transform.hpp"
#include "raytracer/util/progress.hpp"

namespace deburr {

struct RenderOptions : Options {
    std::string via = "implicit", tolerance;
    std::string wire;  // "": no wire frame
    bool flat = false, edges = false;
    int bits = 8;  // of a PNG
    bool alpha = false;
    bool draft = false;
    std::optional<Accel> accel;
    IntegratorKind integrator = IntegratorKind::automatic;
    std::optional<double> exposure;  // of pictures for the screen
    std::optional<double> noise, seconds;
    ViewTransform view = ViewTransform::standard;
    Denoiser denoiser = Denoiser::none;
    std::optional<double> write_every;  // seconds
    std::string display_server;         // "": none
    std::string checkpoint;             // "": none
    bool resume = false;
    double checkpoint_every = 60;  // seconds
    std::optional<FrameRange> frames;
    std::optional<TileShare> tile;       // of the rows
    std::optional<SampleRange> samples;  // of those that --spp says
    std::optional<Progress::Style> progress;
};

/// Adds `render` to the program. The options come to life with it.
CLI::App* add_render_options(CLI::App& program, const std::shared_ptr<RenderOptions>& options);

/// Throws UsageError where options are wrong together, as far as can be known without the scene.
void check_render_options(const RenderOptions& options);

}  // namespace deburr
