// What deburr render traces rays in, made from its options.
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

/// The scene and how its rays are traced. Tiles that are abandoned share in it.
struct RenderWorld {
    Scene scene;
    std::unique_ptr<RayTracer> tracer;
    std::optional<Integrator> integrator;
    std::optional<BspStatistics> bsp;
    std::vector<Stroke> strokes;  // that are drawn over the picture
};

/// The picture's size and the part of it that is rendered.
struct Frame {
    Size size;
    Window window;
    Window whole;  // of which --tile has left the window
    int spp = 0;   // 0: to be found
};

/// Throws as picture_window() does.
Frame frame_of(const RenderOptions& options, const Scene& scene);

/// Exposure of pictures for the screen, in stops; 0 for a wire frame, which is black on white.
double exposure_of(const RenderOptions& options, const Scene& scene);

/// Warns of what can be known of a scene before it is rendered.
void warn_of_scene(const Scene& scene, double aspect);

/// Makes world.tracer from world.scene, and the strokes.
void build_tracer(const RenderOptions& options, const Frame& frame, RenderWorld& world);

/// Makes world.integrator, and finds frame.spp where options leave it open.
void build_integrator(const RenderOptions& options, Frame& frame, RenderWorld& world);

/// A line on stderr with --verbose.
void say(const RenderOptions& options, const std::string& line);

}  // namespace deburr
