// Fuzz target: reads any bytes as a picture, as `deburr compare` does, and compares the picture with itself.
//
// The reader takes a path, so the input is written to a file in memory. Input that cannot be read must be refused with
// UsageError and nothing else.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "raytracer/image/image_difference.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

constexpr std::size_t max_pixels = 1 << 16;  // of a picture that is compared

// A file in memory that exists as long as the program runs.
class MemoryFile {
public:
    std::string holding(const std::uint8_t* data, std::size_t size) const {
        if (ftruncate(file_, 0) != 0 || pwrite(file_, data, size, 0) != ssize_t(size)) std::abort();
        return "/proc/self/fd/" + std::to_string(file_);
    }

private:
    int file_ = memfd_create("picture", 0);
};

}  // namespace
}  // namespace deburr

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deburr;
    static const MemoryFile file;
    try {
        const Film film = read_picture(file.holding(data, size));
        if (film.pixels.size() <= max_pixels) (void)difference(film, film, {});
    } catch (const UsageError&) {
        // It was refused with a message.
    }
    return 0;
}
