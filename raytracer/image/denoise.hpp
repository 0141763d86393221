// Denoises a picture by edge-avoiding wavelets [Dammertz, Sewtz, Hanika & Lensch, Edge-Avoiding À-Trous Wavelet
// Transform for fast Global Illumination Filtering, 2010].
//
// Light is smoothed separately from the surfaces' colours, and not across edges in normals, colours or the light
// itself. Fine detail that is only in the light, such as a reflection, is lost. A crop is smoothed without its
// surroundings.
#pragma once
#include <optional>
#include <string_view>

#include "raytracer/image/film.hpp"

namespace deburr {

/// The available denoisers.
enum class Denoiser { none, wavelets, oidn };

/// The denoiser's name on the command line: "none", "wavelets" or "oidn".
const char* name(Denoiser denoiser);
/// The denoiser with this name, if there is one.
std::optional<Denoiser> find_denoiser(std::string_view name);

/// Denoises a film by wavelets. The film must keep the layers guide_normal and albedo.
void denoise(Film& film);
/// Denoises a film by the given denoiser on `threads` threads. Throws as denoise_by_oidn() does.
void denoise(Film& film, Denoiser denoiser, int threads);

}  // namespace deburr
