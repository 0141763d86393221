// Parses the values of options. Errors throw UsageError with the option, what was expected and what was found, such as
// "--spp: expected a whole number from 1 to 1048576, got '0'".
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bounds/root_finder.hpp"
#include "raytracer/image/film.hpp"
#include "raytracer/image/image_format.hpp"
#include "raytracer/mesh/mesh_settings.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/scene/keep_sharp.hpp"
#include "raytracer/trace/trace_settings.hpp"

namespace deburr {

/// Limits in pixels: sides of a whole picture, and sides and area of the part that is rendered at once.
constexpr int largest_picture_side = 1'000'000, largest_side = 65536;
constexpr std::int64_t max_pixels = std::int64_t(1) << 28;

/// A whole number in [least, most].
std::int64_t parse_whole(std::string_view option, std::string_view text, std::int64_t least, std::int64_t most);
/// A finite number > 0.
double parse_positive(std::string_view option, std::string_view text);
/// A finite number >= 0.
double parse_limit(std::string_view option, std::string_view text);
/// An exposure in stops, positive or negative.
double parse_exposure(std::string_view option, std::string_view text);
/// A direction "X,Y,Z", not all 0.
Vec3 parse_direction(std::string_view option, std::string_view text);
/// Three numbers from 0 to 1, "R,G,B".
Vec3 parse_color(std::string_view option, std::string_view text);
/// One of convex, concave, below=H, above=H and box=X,Y,Z,X,Y,Z, which is added to `keep`.
void parse_keep_sharp(std::string_view option, std::string_view text, KeepSharp& keep);
/// An axis: 'y' or 'z'.
char parse_axis(std::string_view option, std::string_view text);
/// One of `words`.
std::string parse_word(std::string_view option, std::string_view text, const std::vector<std::string>& words);
std::uint64_t parse_seed(std::string_view option, std::string_view text);
/// A size "WxH".
Size parse_size(std::string_view option, std::string_view text);
/// A window "WxH+X+Y", the geometry string of X11 and OpenImageIO; check_crop() tells whether it is within the picture.
Window parse_crop(std::string_view option, std::string_view text);
void check_crop(std::string_view option, const Window& crop, Size picture);
/// Throws UsageError if the window is too large to be rendered at once.
void check_pixels(std::string_view option, const Window& window);
/// Names of layers, separated by commas.
std::vector<ImageLayer> parse_layers(std::string_view option, std::string_view text);
Criterion parse_criterion(std::string_view option, std::string_view text);
IntegratorKind parse_integrator(std::string_view option, std::string_view text);
Accel parse_accel(std::string_view option, std::string_view text);
/// The meshing method with this name.
MeshMethod parse_mesh_method(const std::string& option, const std::string& name);
/// The value of --tolerance: a number > 0, or inf for the paper's single refinement of each edge.
double parse_tolerance(const std::string& text);
/// Settings for meshes that are rendered, from --via and --tolerance (either may be "").
MeshSettings picture_mesh_settings(const std::string& via, const std::string& tolerance);
/// "name=value", added to `defines`.
void parse_define(std::string_view option, std::string_view text, std::map<std::string, std::string>& defines);
/// Throws UsageError unless every name has an image format and no file is named twice.
void check_image_names(std::string_view option, const std::vector<std::string>& paths);
/// Throws UsageError if a file is named twice, even by different paths.
void check_distinct(const std::vector<std::string>& paths);
/// Throws UsageError if a file would be written twice, or is both read and written, by whatever paths, symbolic and
/// hard links included. Empty names stand for no file.
void check_outputs(std::vector<std::string> outputs, const std::vector<std::string>& more_outputs,
                   const std::vector<std::string>& inputs);

}  // namespace deburr
