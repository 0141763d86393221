// Files of sums: checkpoints of a picture on its way, which are also the parts that `deburr merge` takes.
//
//   "deburr sums 1\n", bytes of the head (8, little-endian), the head as JSON, the sums (Passes::bytes), and the CRC-32
//   of all that (4). They are numbers as this kind of machine has them, for the same version of the program.
//
// The head says what was rendered: a hash of everything that pixels depend on but for window and samples (`scene`), the
// version, size, windows and samples, and what a picture's files need (`notes`).
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "raytracer/image/denoise.hpp"
#include "raytracer/image/image_file.hpp"
#include "raytracer/render/passes.hpp"

namespace deburr {

struct SumsFile {
    nlohmann::ordered_json head;
    std::string bytes;  // of the passes
};

/// Throws WorkError.
void write_sums(const std::string& path, const SumsFile& file);

/// Throws WorkError with one line: where it cannot be read, is no such file, is damaged, or of another version.
SumsFile read_sums(const std::string& path);

nlohmann::ordered_json window_head(const Window& window);
Window window_of(const nlohmann::ordered_json& head);

/// What the header of a picture says, and how its file is written.
nlohmann::ordered_json notes_head(const ImageNotes& notes, const ImageFormat& format, Denoiser denoiser);
void read_notes(const nlohmann::ordered_json& head, ImageNotes& notes, ImageFormat& format, Denoiser& denoiser);

/// Hash of texts and of files' contents, in their order [FNV-1a, 64 bits]: it tells changes, and is no protection.
class ContentHash {
public:
    void add(std::string_view text);
    /// Throws WorkError if it cannot be read.
    void add_file(const std::string& path);
    std::string text() const;

private:
    std::uint64_t hash_ = 0xcbf29ce484222325;
};

}  // namespace deburr
