// Fuzz target: reads any bytes as a scene, as `deburr info` does, and checks the result.
//
// Beside what the sanitizers see this is checked: a text is read, or refused with SceneError and no other exception;
// the message is one printable line that begins with the file's name; bounds and ranges of the solids are ordered
// numbers. Limits are far below a user's, so that one execution takes less than a millisecond.
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "bounds/bounding_box.hpp"
#include "bounds/solid_range.hpp"
#include "raytracer/scene/illegal_densities.hpp"
#include "raytracer/scene/scene_reader.hpp"

namespace deburr {
namespace {

constexpr SandboxLimits limits{std::size_t(8) << 20, 100'000, 2.0};
constexpr double max_leaves = 64;     // of a scene that is checked
constexpr int illegality_boxes = 50;  // cells in which the legality check looks at ranges

void require(bool promise) {
    if (!promise) std::abort();
}

void check_message(const std::string& message) {
    require(message.compare(0, 5, "f.lua") == 0);
    require(std::none_of(message.begin(), message.end(),
                         [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127; }));
}

void visit(const Scene& scene) {
    double leaves = 0;
    for (const Solid& solid : scene.solids) leaves += solid.node().leaves;
    if (leaves > max_leaves) return;
    for (const Solid& solid : scene.solids) {
        const SolidTree tree = flatten(solid);
        const Box box = bounding_box(tree);
        for (int k = 0; k < 3; ++k) require(box.empty() || box.lo[k] <= box.hi[k]);
        (void)prune(tree, box.finite() && !box.empty() ? box : Box{Vec3(-1), Vec3(1)});
    }
    (void)illegal_densities(scene, illegality_boxes);
}

}  // namespace
}  // namespace deburr

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace deburr;
    try {
        visit(read_scene_text({reinterpret_cast<const char*>(data), size}, "f.lua", {}, limits));
    } catch (const SceneError& error) {
        check_message(error.what());
    }
    return 0;
}
