// Every way from a scene to a file with four threads. The thread sanitizer runs this file, too.
#include "catch.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;

TEST_CASE("pictures and meshes of every road have the same bytes in 1 and 4 threads", "[threads][slow]") {
    const Folder folder;
    const std::string first = DEBURR_SOURCE_DIR "/scenes/first.lua", forms = DEBURR_SOURCE_DIR "/scenes/free_form.lua";
    const std::vector<std::string> pictures[] = {
        {"render", first, "--spp", "4"},        {"render", first, "--accel", "bvh"},
        {"render", first, "--accel", "embree"}, {"render", forms},
        {"render", first, "--via", "triage"},   {"render", forms, "--via", "octree"},
    };
    const std::vector<std::string> meshes[] = {
        {"mesh", first, "--method", "triage"},
        {"mesh", forms, "--method", "octree"},
        {"mesh", first, "--method", "marching-cubes"},
    };
    const auto bytes = [&](std::vector<std::string> call, const std::string& file, const char* threads) {
        call.insert(call.end(), {"-q", "-o", folder / file, "--threads", threads});
        if (call[0] == "render") call.insert(call.end(), {"--size", "60x38"});
        const Outcome o = run(call, {"SOURCE_DATE_EPOCH=0"});
        INFO(o.err);
        REQUIRE(o.code == 0);
        return read_file(folder / file);
    };
    for (const auto& call : pictures) {
        CAPTURE(call);
        CHECK((bytes(call, "a.exr", "1") == bytes(call, "a.exr", "4")));
    }
    for (const auto& call : meshes) {
        CAPTURE(call);
        CHECK((bytes(call, "a.ply", "1") == bytes(call, "a.ply", "4")));
    }
}
