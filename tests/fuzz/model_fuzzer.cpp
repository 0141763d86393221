// Fuzz target: reads any bytes as a model, as the program does once they are in memory, and checks the result.
//
// The first byte selects how the rest is taken: as a file, whose format its first bytes or its name tell and which
// Assimp reads (the program runs Assimp in a process of its own, with limits), or as boxes, whose union is known.
// Beside what the sanitizers see this is checked: a file is read, or refused with the intended errors in one printable
// line; a solid has a volume; the union of boxes has their volume and no crossing facets.
#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <csetjmp>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "polygonizer/mesh/crossing_triangles.hpp"
#include "raytracer/model/closed_surface.hpp"
#include "raytracer/model/model_format.hpp"
#include "raytracer/util/module.hpp"
#include "raytracer/util/printable.hpp"
#include "raytracer/util/scene_error.hpp"

namespace deburr {
namespace {

constexpr const char* names[] = {"f.stl", "f.obj"};
constexpr std::size_t max_triangles = 400;  // of a surface that is checked

// In the program a fault of Assimp ends the process that Assimp runs in; here it ends only the call.
sigjmp_buf before_library;
volatile std::sig_atomic_t in_library = 0;
struct sigaction fuzzers_own[NSIG];  // the fuzzer's own handlers

void leave_library(int signal) {
    if (in_library != 0) siglongjmp(before_library, signal);
    sigaction(signal, &fuzzers_own[signal], nullptr);
    std::raise(signal);
}

void require(bool promise) {
    if (!promise) std::abort();
}

void check_line(const std::string& text) {
    require(!text.empty() && std::none_of(text.begin(), text.end(),
                                          [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127; }));
}

std::size_t crossings(const ClosedMesh& closed) {
    Mesh mesh;
    mesh.positions = closed.vertices();
    for (const auto& t : closed.triangles()) mesh.triangles.push_back({t, {0, 0, 0}});
    return crossing_triangles(mesh, TriangleTree(mesh)).size();
}

void look_at(const TriangleSoup& soup) {
    for (const auto& t : soup.triangles)
        for (const int v : t)
            if (v < 0 || std::size_t(v) >= soup.vertices.size()) return;  // read_model refuses these
    if (soup.triangles.size() > max_triangles) return;
    try {
        const ClosedSurface surface = closed_surface(soup);
        require(surface.mesh->size() > 0 && surface.mesh->volume() > 0);
        for (const std::string& mended : surface.mended) check_line(mended);
    } catch (const UnsoundSurface& error) {
        check_line(error.what());
    }
}

void read_file(std::string bytes, const std::string& name) {
    static ModelReader* const reader =
        module_function<ModelModuleEntry>("deburr_models.so", model_module_entry, "models")();
    fold_stl_text(bytes);
    std::string format;
    try {
        format = model_format(bytes, name);
    } catch (const SceneError& error) {
        check_line(error.what());
        return;
    }
    // With other formats Assimp 5.2 aborts at the first broken archive, or believes a count in the file and takes half
    // a minute. In the program that ends only Assimp's own process, and is reported.
    if (format != "stl" && format != "obj") return;
    TriangleSoup soup;
    if (sigsetjmp(before_library, 1) != 0) {
        in_library = 0;
        return;
    }
    try {
        in_library = 1;
        soup = reader(bytes, format);
        in_library = 0;
    } catch (const std::exception&) {
        in_library = 0;
        return;  // the message is Assimp's; it is made printable where it is shown
    }
    look_at(soup);
}

// Boxes on a grid from the bytes, three for each; a box of no width is left out.
void unite_boxes(const std::uint8_t* data, std::size_t size) {
    constexpr int side = 16, most = 12;
    std::bitset<side * side * side> inside;
    TriangleSoup soup;
    for (std::size_t box = 0; box < most && 3 * box + 2 < size; ++box) {
        int lo[3], hi[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint8_t byte = data[3 * box + k];
            lo[k] = std::min(byte & 15, byte >> 4);
            hi[k] = std::max(byte & 15, byte >> 4);
        }
        if (lo[0] == hi[0] || lo[1] == hi[1] || lo[2] == hi[2]) continue;
        for (int x = lo[0]; x < hi[0]; ++x)
            for (int y = lo[1]; y < hi[1]; ++y)
                for (int z = lo[2]; z < hi[2]; ++z) inside.set(std::size_t((x * side + y) * side + z));
        const int first = int(soup.vertices.size());
        for (int corner = 0; corner < 8; ++corner)
            soup.vertices.push_back({(corner & 4) != 0 ? hi[0] : lo[0], (corner & 2) != 0 ? hi[1] : lo[1],
                                     (corner & 1) != 0 ? hi[2] : lo[2]});
        constexpr int faces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                     {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
        for (const auto& f : faces) {
            soup.triangles.push_back({first + f[0], first + f[1], first + f[2]});
            soup.triangles.push_back({first + f[0], first + f[2], first + f[3]});
        }
    }
    if (soup.triangles.empty()) return;
    const ClosedSurface surface = closed_surface(soup);
    require(std::abs(surface.mesh->volume() - double(inside.count())) < 1e-9 * side * side * side);
    require(crossings(*surface.mesh) == 0);
}

}  // namespace
}  // namespace deburr

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deburr;
    static const bool is_ready = [] {
        for (const int signal : {SIGABRT, SIGSEGV, SIGFPE}) {
            struct sigaction own = {};
            own.sa_handler = leave_library;
            sigaction(signal, &own, &fuzzers_own[signal]);
        }
        return true;
    }();
    if (!is_ready || size < 1) return 0;
    const std::size_t kind = data[0] % (std::size(names) + 1);
    if (kind == std::size(names))
        unite_boxes(data + 1, size - 1);
    else
        read_file({reinterpret_cast<const char*>(data + 1), size - 1}, names[kind]);
    return 0;
}
