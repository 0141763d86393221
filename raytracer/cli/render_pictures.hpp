// The files of deburr render, and what their headers say.
#pragma once
#include "raytracer/cli/render_world.hpp"
#include "raytracer/image/image_file.hpp"
#include "raytracer/util/progress.hpp"

namespace deburr {

/// Work to write a pixel into a file, where tracing one sample of it is 1: a guess, for the bar.
constexpr double writing_work = 0.1;

/// Throws UsageError if the environment's SOURCE_DATE_EPOCH is wrong.
void check_source_date_epoch();

/// The date for a picture's header: the environment's, or now.
std::string picture_date();

/// `spp`: samples that all pixels have.
ImageNotes notes_of(const RenderOptions& options, const RenderWorld& world, int spp, double trace_seconds);

/// How the options want files written.
ImageFormat format_of(const RenderOptions& options, double exposure, int threads);

/// Writes every file that can be written, for the picture was dear, and throws WorkError with the first error then.
/// `work` is told of what is done, writing_work for a pixel and file in all.
void write_pictures(const std::vector<std::string>& paths, const Film& film, const ImageFormat& format,
                    const ImageNotes& notes, const std::function<void(double)>& work);

}  // namespace deburr
