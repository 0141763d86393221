// Reads any bytes as a picture, as `deburr compare` would, and compares it with itself.
//
// The reader takes a path, so an input is written to a file in memory; its name says EXR where the bytes begin as one,
// and PNG elsewhere. What cannot be read must be refused with UsageError.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "raytracer/image/image_difference.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_pixels = 1 << 16;  // of a picture that is compared

// A file that is in memory as long as the program runs, under a name that ends as its format asks.
class MemoryFile {
public:
    explicit MemoryFile(const std::string& extension) : file_(memfd_create("picture", 0)) {
        path_ = fs::temp_directory_path() / ("deburr-fuzz-" + std::to_string(getpid()) + extension);
        fs::remove(path_);
        fs::create_symlink("/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(file_), path_);
    }
    ~MemoryFile() {
        std::error_code ignored;
        fs::remove(path_, ignored);
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    std::string holding(const std::uint8_t* data, std::size_t size) const {
        if (ftruncate(file_, 0) != 0 || pwrite(file_, data, size, 0) != ssize_t(size)) std::abort();
        return path_.string();
    }

private:
    int file_;
    fs::path path_;
};

}  // namespace
}  // namespace deburr

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deburr;
    static const MemoryFile exr(".exr"), png(".png");
    const bool is_exr = size >= 4 && std::memcmp(data, "\x76\x2f\x31\x01", 4) == 0;
    try {
        const Film film = read_picture((is_exr ? exr : png).holding(data, size));
        if (film.pixels.size() <= most_pixels) (void)difference(film, film, {});
    } catch (const UsageError&) {
        // Refused, in words.
    }
    return 0;
}
