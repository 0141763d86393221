// From the text of an option to its value. What is wrong throws UsageError with the option, what
// was expected, and what was found: "--spp: expected a whole number from 1 to 1048576, got '0'".
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

/// Limits, in pixels: sides of a whole picture and of what is rendered of it at once; and the area of the latter.
constexpr int largest_picture_side = 1'000'000, largest_side = 65536;
constexpr std::int64_t max_pixels = std::int64_t(1) << 28;

std::int64_t parse_whole(std::string_view option, std::string_view text, std::int64_t least, std::int64_t most);
/// A number > 0.
double parse_positive(std::string_view option, std::string_view text);
/// A number >= 0.
double parse_limit(std::string_view option, std::string_view text);
/// Stops, either way.
double parse_exposure(std::string_view option, std::string_view text);
/// X,Y,Z, not all 0.
Vec3 parse_direction(std::string_view option, std::string_view text);
/// Three numbers from 0 to 1.
Vec3 parse_color(std::string_view option, std::string_view text);
/// convex, concave, below=H, above=H or box=X,Y,Z,X,Y,Z, added to `keep`.
void parse_keep_sharp(std::string_view option, std::string_view text, KeepSharp& keep);
/// 'y' or 'z'.
char parse_axis(std::string_view option, std::string_view text);
/// One of these.
std::string parse_word(std::string_view option, std::string_view text, const std::vector<std::string>& words);
std::uint64_t parse_seed(std::string_view option, std::string_view text);
/// WxH
Size parse_size(std::string_view option, std::string_view text);
/// WxH+X+Y, the geometry string of X11 and of OpenImageIO; whether it fits is for check_crop.
Window parse_crop(std::string_view option, std::string_view text);
void check_crop(std::string_view option, const Window& crop, Size picture);
/// Throws if it is too much to be rendered at once.
void check_pixels(std::string_view option, const Window& window);
/// Names with commas between them.
std::vector<ImageLayer> parse_layers(std::string_view option, std::string_view text);
Criterion parse_criterion(std::string_view option, std::string_view text);
IntegratorKind parse_integrator(std::string_view option, std::string_view text);
Accel parse_accel(std::string_view option, std::string_view text);
/// The name of a method that makes meshes.
MeshMethod parse_mesh_method(const std::string& option, const std::string& name);
/// --tolerance: a number > 0, or inf for the paper's one refinement of each edge.
double parse_tolerance(const std::string& text);
/// The settings of meshes that are made to be rendered, from --via and --tolerance (which may be empty).
MeshSettings picture_mesh_settings(const std::string& via, const std::string& tolerance);
/// name=value, added to `defines`.
void parse_define(std::string_view option, std::string_view text, std::map<std::string, std::string>& defines);
/// Throws unless every name is that of an image and no file is named twice.
void check_image_names(std::string_view option, const std::vector<std::string>& paths);
/// Throws if one file is named twice, be it in different words.
void check_distinct(const std::vector<std::string>& paths);
/// Throws if one file is to be written twice, or one that is read is to be written: by whatever names, symbolic and
/// hard links included. Empty names stand for no file.
void check_outputs(std::vector<std::string> outputs, const std::vector<std::string>& more_outputs,
                   const std::vector<std::string>& inputs);

}  // namespace deburr
