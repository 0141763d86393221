// Denoises with Intel's Open Image Denoise, version 2, if the system has it: a trained network that is guided by the
// albedo and normals that a film keeps for it. Debian does not package it, and none of its files is needed to build.
#pragma once
#include "raytracer/image/film.hpp"

namespace deburr {

/// Loads the library. Throws UnsupportedError if the system has none.
void load_oidn();

/// Replaces the colours of a film, which must keep guide_normal and albedo; alpha and layers stay. Runs on the CPU, on
/// `threads` threads. Throws UnsupportedError as load_oidn() does, and WorkError with the library's message if it
/// fails.
void denoise_by_oidn(Film& film, int threads);

}  // namespace deburr
