// Smooths a noisy picture where its surfaces are smooth: edge-avoiding wavelets [Dammertz, Sewtz, Hanika & Lensch,
// Edge-Avoiding À-Trous Wavelet Transform for fast Global Illumination Filtering, 2010].
//
// Light is smoothed apart from the surfaces' colours, and not across edges of normals, of colours or of light itself.
// What is fine and only in the light, such as a reflection, loses its detail. A crop is smoothed by itself.
#pragma once
#include <optional>
#include <string_view>

#include "raytracer/image/film.hpp"

namespace deburr {

/// What takes the noise out of a picture.
enum class Denoiser { none, wavelets, oidn };

/// "wavelets", "oidn", as the command line says them, and "none".
const char* name(Denoiser denoiser);
/// The denoiser of this name, if there is one.
std::optional<Denoiser> find_denoiser(std::string_view name);

/// Smooths a film that keeps guide_normal and albedo by wavelets.
void denoise(Film& film);
/// The same by whichever denoiser, on `threads` threads. Throws what denoise_by_oidn does.
void denoise(Film& film, Denoiser denoiser, int threads);

}  // namespace deburr
