// The scene, tracer and integrator of `deburr render`, built from its options.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "raytracer/cli/render_options.hpp"
#include "raytracer/mesh/wire_frame.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

namespace deburr {

/// The scene and its tracer and integrator. It is shared with tiles that are abandoned.
struct RenderWorld {
    Scene scene;
    std::unique_ptr<RayTracer> tracer;
    std::optional<Integrator> integrator;
    std::optional<BspStatistics> bsp;
    std::vector<Stroke> strokes;  // drawn over the picture
};

/// The picture's size, and the part of it that is rendered.
struct Frame {
    Size size;
    Window window;
    Window whole;  // the window before --tile took a share of it
    int spp = 0;   // 0: still to be chosen
};

/// The frame that the options ask for. Throws as picture_window() does.
Frame frame_of(const RenderOptions& options, const Scene& scene);

/// The exposure of pictures for the screen, in stops; 0 for wire frames, which are black on white.
double exposure_of(const RenderOptions& options, const Scene& scene);

/// Prints warnings about the scene that are known before rendering; `aspect` is width / height.
void warn_of_scene(const Scene& scene, double aspect);

/// Sets world.tracer and world.strokes from world.scene.
void build_tracer(const RenderOptions& options, const Frame& frame, RenderWorld& world);

/// Sets world.integrator, and frame.spp if the options do not give it.
void build_integrator(const RenderOptions& options, Frame& frame, RenderWorld& world);

/// Prints a line on stderr if --verbose was given.
void say(const RenderOptions& options, const std::string& line);

}  // namespace deburr
