// The picture files of `deburr render`, and the information in their headers.
#pragma once
#include "raytracer/cli/render_world.hpp"
#include "raytracer/image/image_file.hpp"
#include "raytracer/util/progress.hpp"

namespace deburr {

/// The work of writing a pixel to a file, relative to tracing one sample of it: a guess, for the progress bar.
constexpr double writing_work = 0.1;

/// Throws UsageError if the environment variable SOURCE_DATE_EPOCH is invalid.
void check_source_date_epoch();

/// The date for a picture's header: that of SOURCE_DATE_EPOCH, or now.
std::string picture_date();

/// The header's information for a picture whose pixels have `spp` samples and took `trace_seconds`.
ImageNotes notes_of(const RenderOptions& options, const RenderWorld& world, int spp, double trace_seconds);

/// The file format that the options ask for.
ImageFormat format_of(const RenderOptions& options, double exposure, int threads);

/// Writes the film to all files that can be written, since rendering it was expensive, and then throws WorkError with
/// the first error. `work` is told the work done, writing_work for each pixel and file in total.
void write_pictures(const std::vector<std::string>& paths, const Film& film, const ImageFormat& format,
                    const ImageNotes& notes, const std::function<void(double)>& work);

}  // namespace deburr
