// The options of `deburr render`.
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

/// The options as parsed.
struct RenderOptions : Options {
    std::string via = "implicit", tolerance;
    std::string wire;  // kind of wire frame; "": none
    bool flat = false, edges = false;
    int bits = 8;  // of a PNG
    bool alpha = false;
    bool draft = false;
    std::optional<Accel> accel;
    IntegratorKind integrator = IntegratorKind::automatic;
    std::optional<double> exposure;  // of pictures for the screen, in stops
    std::optional<double> noise, seconds;
    ViewTransform view = ViewTransform::standard;
    Denoiser denoiser = Denoiser::none;
    std::optional<double> write_every;  // seconds
    std::string display_server;         // HOST:PORT; "": none
    std::string checkpoint;             // path; "": none
    bool resume = false;
    double checkpoint_every = 60;  // seconds
    std::optional<FrameRange> frames;
    std::optional<TileShare> tile;       // share of the rows
    std::optional<SampleRange> samples;  // part of the samples of --spp
    std::optional<Progress::Style> progress;
};

/// Adds `render` to the program; parsing fills `options`.
CLI::App* add_render_options(CLI::App& program, const std::shared_ptr<RenderOptions>& options);

/// Throws UsageError for contradictory options, as far as that can be known without the scene.
void check_render_options(const RenderOptions& options);

}  // namespace deburr
