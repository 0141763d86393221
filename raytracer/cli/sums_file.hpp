// Files of sums: checkpoints of a rendering, which are also the parts that `deburr merge` combines.
//
//   "deburr sums 1\n", the size of the header (8 bytes, little-endian), the header as JSON, the sums (Passes::bytes),
//   and the CRC-32 of all that (4 bytes). Sums are stored as in memory, for machines of the same kind and the same
//   version.
//
// The header tells what was rendered: `scene` is a hash of everything that pixels depend on except window and samples;
// further the version, size, windows and samples, and the information for picture files (`notes`).
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "raytracer/image/denoise.hpp"
#include "raytracer/image/image_file.hpp"
#include "raytracer/render/passes.hpp"

namespace deburr {

/// The content of a file of sums.
struct SumsFile {
    nlohmann::ordered_json head;
    std::string bytes;  // of the passes
};

/// Writes the file. Throws WorkError.
void write_sums(const std::string& path, const SumsFile& file);

/// Reads a file. Throws WorkError with one line if it cannot be read, is not such a file, is damaged, or is of another
/// version.
SumsFile read_sums(const std::string& path);

nlohmann::ordered_json window_head(const Window& window);
Window window_of(const nlohmann::ordered_json& head);

/// The information for a picture's header and file format, as part of the file's header, and its inverse.
nlohmann::ordered_json notes_head(const ImageNotes& notes, const ImageFormat& format, Denoiser denoiser);
void read_notes(const nlohmann::ordered_json& head, ImageNotes& notes, ImageFormat& format, Denoiser& denoiser);

/// A hash of texts and of files' contents, in order [FNV-1a, 64 bits]: it detects changes, but does not protect against
/// attacks.
class ContentHash {
public:
    void add(std::string_view text);
    /// Adds a file's content. Throws WorkError if it cannot be read.
    void add_file(const std::string& path);
    std::string text() const;

private:
    std::uint64_t hash_ = 0xcbf29ce484222325;
};

}  // namespace deburr
