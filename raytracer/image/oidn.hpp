// Intel's Open Image Denoise, version 2, where a system has it: a trained network that removes a picture's noise,
// guided by the albedo and the normals that a film keeps for it. Debian has no package of it; none of its files is
// needed to build.
#pragma once
#include "raytracer/image/film.hpp"

namespace deburr {

/// Loads the library. Throws UnsupportedError if the system has none.
void load_oidn();

/// Replaces the colours of a film that keeps guide_normal and albedo; alpha and layers stay. It runs on the processor,
/// on `threads` threads. Throws UnsupportedError as load_oidn does, WorkError with the library's words if it fails.
void denoise_by_oidn(Film& film, int threads);

}  // namespace deburr
