#include "raytracer/model/model_file.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>

#include "raytracer/model/closed_surface.hpp"
#include "raytracer/model/model_format.hpp"
#include "raytracer/model/openscad.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/module.hpp"
#include "raytracer/util/printable.hpp"
#include "raytracer/util/scene_error.hpp"

namespace deburr {
namespace {

constexpr std::size_t largest_file = std::size_t(2) << 30;  // bytes

// Memory that a reader may use for each byte of a file, and in addition. The densest text is "f 1 2 3".
constexpr std::size_t memory_per_byte = 48, least_memory = std::size_t(1) << 30;
constexpr std::size_t bytes_per_second = std::size_t(1) << 20, least_seconds = 20;

std::string file_bytes(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) refuse_model(path, "expected a model, got a directory");
    const auto close = [](std::FILE* f) { std::fclose(f); };
    const std::unique_ptr<std::FILE, decltype(close)> input(std::fopen(path.c_str(), "rb"), close);
    if (!input) refuse_model(path, std::string("expected a model, got: ") + std::strerror(errno));
    std::string bytes;
    std::vector<char> buffer(1 << 20);
    while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), input.get())) {
        bytes.append(buffer.data(), size);
        if (bytes.size() > largest_file)
            refuse_model(path, fmt::format("expected a model of at most {} MiB, got more", largest_file >> 20));
    }
    if (std::ferror(input.get())) refuse_model(path, std::string("expected a model, got: ") + std::strerror(errno));
    return bytes;
}

// Complete reads and writes on pipes; false if the other end is gone.

bool put(int to, const void* data, std::size_t size) {
    const char* at = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t done = write(to, at, size);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return false;
        at += done;
        size -= std::size_t(done);
    }
    return true;
}

bool get(int from, void* data, std::size_t size) {
    char* at = static_cast<char*>(data);
    while (size > 0) {
        const ssize_t done = read(from, at, size);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return false;
        at += done;
        size -= std::size_t(done);
    }
    return true;
}

// Precedes the data that the reader's process sends; a message means that it failed.
struct Sizes {
    std::uint64_t vertices = 0, triangles = 0, message = 0;
};

// Runs in the reader's own process: sets its limits, reads the bytes and sends the result.
[[noreturn]] void serve(int to, ModelReader* reader, const std::string& bytes, const std::string& format) {
    const auto limit = [](int what, std::size_t most) {
        rlimit l{};
        getrlimit(static_cast<__rlimit_resource>(what), &l);
        l.rlim_cur = std::min<rlim_t>(l.rlim_max, most);
        setrlimit(static_cast<__rlimit_resource>(what), &l);
    };
    std::signal(SIGTERM, SIG_DFL);
    std::signal(SIGINT, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    limit(RLIMIT_CORE, 0);
    const std::size_t seconds = least_seconds + bytes.size() / bytes_per_second;
    limit(RLIMIT_CPU, seconds);
    alarm(unsigned(10 * seconds));  // a reader that waits uses no CPU time
#if !DEBURR_IS_SANITIZED            // its shadow memory needs all addresses
    // Memory that is mapped already counts, too, such as the program's own arenas.
    limit(RLIMIT_AS, least_memory + memory_per_byte * bytes.size() + (std::size_t(8) << 30));
    limit(RLIMIT_DATA, least_memory + memory_per_byte * bytes.size() + bytes.size());
#endif
    Sizes sizes;
    std::string message;
    TriangleSoup soup;
    try {
        soup = reader(bytes, format);
        sizes.vertices = soup.vertices.size();
        sizes.triangles = soup.triangles.size();
    } catch (const std::bad_alloc&) {
        message = "its reader ran out of memory";
    } catch (const std::exception& error) {
        message = error.what();
        if (message.empty()) message = "its reader gave no reason";
    }
    sizes.message = message.size();
    put(to, &sizes, sizeof sizes) && put(to, message.data(), message.size()) &&
        put(to, soup.vertices.data(), soup.vertices.size() * sizeof soup.vertices[0]) &&
        put(to, soup.triangles.data(), soup.triangles.size() * sizeof soup.triangles[0]);
    _exit(0);
}

TriangleSoup read_apart(const std::string& bytes, const std::string& format, const std::string& path) {
    ModelReader* const reader = module_function<ModelModuleEntry>(DEBURR_MODEL_MODULE, model_module_entry, "models")();
    int ends[2];
    if (pipe(ends) != 0) throw WorkError(std::string("pipe: ") + std::strerror(errno));
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) {
        const int why = errno;
        close(ends[0]);
        close(ends[1]);
        throw WorkError(std::string("fork: ") + std::strerror(why));
    }
    if (child == 0) {
        close(ends[0]);
        serve(ends[1], reader, bytes, format);
    }
    close(ends[1]);
    Sizes sizes;
    TriangleSoup soup;
    std::string message;
    bool whole = get(ends[0], &sizes, sizeof sizes);
    // No file holds more than a triangle for every byte, or more than three vertices.
    if (whole && sizes.triangles <= bytes.size() && sizes.vertices <= 3 * bytes.size()) {
        message.resize(sizes.message);
        soup.vertices.resize(sizes.vertices);
        soup.triangles.resize(sizes.triangles);
        whole = get(ends[0], message.data(), message.size()) &&
                get(ends[0], soup.vertices.data(), soup.vertices.size() * sizeof(Vec3)) &&
                get(ends[0], soup.triangles.data(), soup.triangles.size() * sizeof(soup.triangles[0]));
    } else if (whole) {
        message = "it claims more than its size allows";
    }
    close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!message.empty()) refuse_model(path, fmt::format("expected {} data, got: {}", format, printable(message)));
    if (!whole) {
        const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
        refuse_model(
            path, fmt::format("expected {} data, got a file that {}", format,
                              signal == SIGXCPU || signal == SIGALRM || signal == SIGKILL ? "takes its reader too long"
                              : signal != 0 ? fmt::format("stops its reader (signal {})", signal)
                                            : "stops its reader"));
    }
    return soup;
}

}  // namespace

Model read_model(const std::string& path) {
    Model model;
    std::string bytes = is_openscad_path(path) ? openscad_output(path) : file_bytes(path);
    fold_stl_text(bytes);
    model.format = model_format(bytes, is_openscad_path(path) ? path + ".stl" : path);
    const TriangleSoup soup = read_apart(bytes, model.format, path);
    for (const auto& t : soup.triangles)
        for (const int v : t)
            if (v < 0 || std::size_t(v) >= soup.vertices.size())
                refuse_model(path, "expected triangles of the file's vertices, got one beyond them");
    try {
        ClosedSurface surface = closed_surface(soup);
        model.mesh = std::move(surface.mesh);
        model.mended = std::move(surface.mended);
    } catch (const UnsoundSurface& error) {
        throw UnsupportedError(one_line(fmt::format("{}: {}", file_mark, error.what()), path));
    }
    return model;
}

}  // namespace deburr
