// Smooths a noisy picture where its surfaces are smooth: edge-avoiding wavelets [Dammertz, Sewtz, Hanika & Lensch,
// Edge-Avoiding À-Trous Wavelet Transform for fast Global Illumination Filtering, 2010].
//
// Light is smoothed apart from the surfaces' colours, and not across edges of normals, of colours or of light itself.
// What is fine and only in the light, such as a reflection, loses its detail. A crop is smoothed by itself.
#pragma once
#include "raytracer/image/film.hpp"

namespace deburr {

/// Of a film that keeps guide_normal and albedo.
void denoise(Film& film);

}  // namespace deburr
