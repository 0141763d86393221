// --checkpoint, --resume, --tile, --samples, --frames and merge, as a scheduler uses them.
#include <signal.h>

#include <filesystem>
#include <random>
#include <string>

#include "catch.hpp"
#include "raytracer/cli/farm_options.hpp"
#include "raytracer/cli/scene_folder.hpp"

using namespace deburr::test;

namespace {

struct FarmFolder : SceneFolder {
    Words words(const Words& more) const {
        Words all = {"render", scene, "-q"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    Outcome render(const Words& more, const Words& environment = {}) const {
        Words all = {"SOURCE_DATE_EPOCH=0"};
        all.insert(all.end(), environment.begin(), environment.end());
        return run(words(more), all);
    }
    Outcome merge(const Words& more) const {
        Words all = {"merge"};
        all.insert(all.end(), more.begin(), more.end());
        return run(all, {"SOURCE_DATE_EPOCH=0"});
    }
    std::string bytes(const std::string& name) const { return read_file(*this / name); }
};

const Words layer_options = {"--aov", "P,N,Z,albedo,normal,id,crypto"};

// The CRC-32 of gzip, as four bytes in little-endian order.
std::string crc32_bytes(const std::string& text) {
    std::uint32_t crc = ~0u;
    for (const char c : text) {
        crc ^= static_cast<unsigned char>(c);
        for (int k = 0; k < 8; ++k) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    crc = ~crc;
    std::string bytes;
    for (int k = 0; k < 4; ++k) bytes.push_back(char(crc >> (8 * k) & 0xff));
    return bytes;
}

Words with(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

// Kills a run at random moments and resumes it until it ends, until `kills` runs were killed. The picture must have the
// bytes of an uninterrupted run. The file of sums is small, so that runs write it often before they are killed.
void check_kills(int kills, unsigned seed) {
    const FarmFolder place;
    const Words call = with(layer_options, {"--size", "60x40", "--spp", "100"});
    REQUIRE(place.render(with(call, {"-o", place / "whole.exr"})).code == 0);
    const Words kept = with(
        call, {"-o", place / "a.exr", "--checkpoint", place / "a.sums", "--checkpoint-every", "0.005", "--resume"});
    std::mt19937 random(seed);
    int killed = 0, ended = 0, had_resumed = 0, had_written = 0;
    while (killed < kills) {
        const std::string before = place.bytes("a.sums");
        Call run(place.words(kept), {"SOURCE_DATE_EPOCH=0"});
        pause_for(0.001 * double(random() % 150));
        if (run.running()) {
            run.send(SIGKILL);
            run.wait();
            ++killed;
            had_resumed += !before.empty();
            had_written += place.bytes("a.sums") != before;
            continue;
        }
        const Outcome o = run.wait();
        CAPTURE(o.err);
        REQUIRE(o.code == 0);
        CHECK(place.bytes("a.exr") == place.bytes("whole.exr"));
        ++ended;
        std::filesystem::remove(place / "a.sums");
        std::filesystem::remove(place / "a.exr");
    }
    CAPTURE(ended);
    if (kills >= 100) {  // or the test said nothing; of few kills on a busy machine all may come too early
        CHECK(had_resumed > 0);
        CHECK(had_written > 0);
    }
    const Outcome last = place.render(kept);
    CAPTURE(last.err);
    CHECK(last.code == 0);
    CHECK(place.bytes("a.exr") == place.bytes("whole.exr"));
    CHECK(place.names() == Words{"a.exr", "a.sums", "cube.lua", "whole.exr"});
}

}  // namespace

TEST_CASE("a run that is killed at random moments and resumed makes the picture of an uninterrupted one", "[slow]") {
    check_kills(10, 1);
}

TEST_CASE("200 kills at random moments lose nothing", "[slow]") { check_kills(200, 2); }

TEST_CASE("SIGTERM leaves a checkpoint and exit code 75, SIGINT 130, and --resume goes on to the same bytes",
          "[slow]") {
    for (const int signal : {SIGTERM, SIGINT}) {
        const FarmFolder place;
        const Words call = {"--size", "200x200", "--spp", "100"};
        Call run(place.words(with(
                     call, {"-o", place / "a.exr", "--checkpoint", place / "a.sums", "--checkpoint-every", "0.05"})),
                 {"SOURCE_DATE_EPOCH=0"});
        for (int i = 0; i < 3000 && !std::filesystem::exists(place / "a.sums"); ++i) pause_for(0.01);
        run.send(signal);
        CHECK(run.wait().code == (signal == SIGTERM ? 75 : 130));
        REQUIRE(std::filesystem::exists(place / "a.sums"));
        const Words resumed = with(call, {"-o", place / "a.exr", "--checkpoint", place / "a.sums", "--resume"});
        REQUIRE(place.render(resumed).code == 0);
        REQUIRE(place.render(with(call, {"-o", place / "b.exr"})).code == 0);
        CHECK(place.bytes("a.exr") == place.bytes("b.exr"));
        // When all samples are in the checkpoint, the picture is written without tracing a ray.
        std::filesystem::remove(place / "a.exr");
        REQUIRE(place.render(with(resumed, {"--stats-json", place / "s.json"})).code == 0);
        CHECK(place.bytes("s.json").find("\"build\"") == std::string::npos);
        CHECK(place.bytes("a.exr") == place.bytes("b.exr"));
    }
}

TEST_CASE("SIGUSR1 asks for a checkpoint at once") {
    const FarmFolder place;
    Call run(place.words({"--size", "200x200", "--spp", "100000", "--checkpoint", place / "a.sums"}));
    REQUIRE(run.handles(SIGUSR1));
    run.send(SIGUSR1);
    for (int i = 0; i < 500 && !std::filesystem::exists(place / "a.sums"); ++i) pause_for(0.01);
    CHECK(std::filesystem::exists(place / "a.sums"));
    CHECK(run.running());
    run.send(SIGTERM);
    CHECK(run.wait().code == 75);
}

TEST_CASE("a checkpoint of something else is refused with one line") {
    const FarmFolder place;
    const Words call = {"--spp", "4", "-o", place / "a.png", "--checkpoint", place / "a.sums", "--resume"};
    REQUIRE(place.render(call).code == 0);
    const auto refused = [&](const Words& more, int code, const std::string& line) {
        const Outcome o = place.render(more);
        CAPTURE(o.err);
        CHECK(o.code == code);
        CHECK(o.err.find(line) != std::string::npos);
        CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    };
    refused(with(call, {"--seed", "1"}), 2, "a.sums: expected a checkpoint of this scene and these options");
    refused(with(call, {"-D", "r=0.05"}), 2, "a.sums: expected a checkpoint of this scene and these options");
    refused(with(call, {"--tile", "0/2"}), 2, "a.sums: expected a checkpoint of this part of the picture");
    refused(with(call, {"--samples", "0-2"}), 2, "a.sums: expected a checkpoint of the samples 0-2, got one of 0-4");
    const std::string scene = read_file(place.scene), sums = place.bytes("a.sums");
    write_file(place.scene, scene + "\n");
    refused(call, 2, "a.sums: expected a checkpoint of this scene");
    write_file(place.scene, scene);
    std::string damaged = sums;
    damaged[damaged.size() / 2] ^= 1;
    write_file(place / "a.sums", damaged);
    refused(call, 1, "a.sums: expected the sums that were written, got a damaged file");
    write_file(place / "a.sums", sums.substr(0, sums.size() - 9));
    refused(call, 1, "a.sums: expected the sums that were written, got a damaged file");
    write_file(place / "a.sums", "");
    refused(call, 1, "a.sums: expected a file of sums by --checkpoint, got another one");
    // A valid file of sums by another version.
    std::string older = sums;
    const std::size_t version = older.find("\"version\":\"") + 11;
    REQUIRE(older.compare(version, 6, "0.1.0\"") == 0);
    older.replace(version, 5, "0.0.9");
    older.replace(older.size() - 4, 4, crc32_bytes(older.substr(0, older.size() - 4)));
    write_file(place / "a.sums", older);
    refused(call, 1, "a.sums: expected sums of deburr 0.1.0, got those of 0.0.9");
    write_file(place / "a.sums", sums);
    CHECK(place.render(call).code == 0);
    refused({"--spp", "4", "-o", place / "a.png", "--resume"}, 2, "--resume: expected --checkpoint FILE");
    refused({"--time", "3", "-o", place / "a.png", "--checkpoint", place / "b.sums"}, 2,
            "--checkpoint: expected no --time");
    refused({"--samples", "0-2", "--checkpoint", place / "b.sums"}, 2, "--samples: expected --spp N beside it");
}

TEST_CASE("a disk that is full is told, and the picture is made all the same") {
    const FarmFolder place;
    const Outcome o = place.render({"--spp", "4", "-o", place / "a.png", "--checkpoint", "/dev/full"});
    CHECK(o.code == 0);
    CHECK(o.err == "deburr: warning: cannot write '/dev/full': No space left on device; going on without\n");
    CHECK(std::filesystem::exists(place / "a.png"));
}

TEST_CASE("tiles and ranges of samples merge to the bytes of the whole picture") {
    const FarmFolder place;
    const Words call = with(layer_options, {"--float", "--spp", "40"});
    REQUIRE(place.render(with(call, {"-o", place / "whole.exr"})).code == 0);
    Words tiles, ranges, both;
    for (const std::string i : {"0", "1", "2"}) {
        tiles.push_back(place / ("tile" + i));
        REQUIRE(place.render(with(call, {"--tile", i + "/3", "--checkpoint", tiles.back()})).code == 0);
    }
    for (const std::string range : {"7-40", "0-3", "3-7"}) {
        ranges.push_back(place / ("range" + range));
        REQUIRE(place.render(with(call, {"--samples", range, "--checkpoint", ranges.back()})).code == 0);
    }
    for (const std::string i : {"0", "1"})
        for (const std::string range : {"0-16", "16-40"}) {
            both.push_back(place / ("both" + i + range));
            REQUIRE(
                place.render(with(call, {"--tile", i + "/2", "--samples", range, "--checkpoint", both.back()})).code ==
                0);
        }
    for (const Words& parts : {tiles, ranges, both}) {
        const Outcome o = place.merge(with(parts, {"-o", place / "merged.exr"}));
        CAPTURE(o.err);
        REQUIRE(o.code == 0);
        CHECK(place.bytes("merged.exr") == place.bytes("whole.exr"));
    }
    const auto refused = [&](const Words& parts, const std::string& line) {
        const Outcome o = place.merge(with(parts, {"-o", place / "no.exr"}));
        CAPTURE(o.err);
        CHECK(o.code == 2);
        CHECK(o.err.find(line) != std::string::npos);
        CHECK_FALSE(std::filesystem::exists(place / "no.exr"));
    };
    refused({tiles[0], tiles[2]}, "merge: expected all parts, got none with the samples 0-40 of the rows 13 to 25");
    refused({ranges[0], ranges[1]}, "merge: expected all parts, got none with the samples 3-7 of the rows 0 to 39");
    refused({ranges[1], ranges[2]}, "got none with the samples 7-40 of the rows 0 to 39");
    refused({tiles[0], tiles[1], tiles[2], tiles[1]}, "merge: expected parts that do not overlap, got ");
    refused({ranges[0], ranges[1], ranges[2], both[0]}, "merge: expected parts that do not overlap, got ");
    REQUIRE(place.render(with(call, {"--seed", "1", "--tile", "1/3", "--checkpoint", place / "other"})).code == 0);
    refused({tiles[0], place / "other", tiles[2]}, "other: expected a part of the picture that ");
}

TEST_CASE("tiles of a picture with a noise bound merge to the whole, too") {
    const FarmFolder place;
    const Words call = {"--noise", "0.05", "--spp", "64"};
    REQUIRE(place.render(with(call, {"-o", place / "whole.exr"})).code == 0);
    Words parts;
    for (const std::string i : {"0", "1", "2"}) {
        parts.push_back(place / i);
        REQUIRE(place.render(with(call, {"--tile", i + "/3", "--checkpoint", parts.back()})).code == 0);
    }
    REQUIRE(place.merge(with(parts, {"-o", place / "merged.exr"})).code == 0);
    CHECK(place.bytes("merged.exr") == place.bytes("whole.exr"));
}

TEST_CASE("--tile auto reads the environment of a job's array") {
    const FarmFolder place;
    const Words call = {"--draft", "-o", place / "a.png"};
    const auto same = [&](const std::string& tile, const std::string& given, const Words& environment) {
        REQUIRE(place.render({"--draft", "-o", place / "b.png", "--tile", given}).code == 0);
        const Outcome o = place.render(with(call, {"--tile", tile}), environment);
        CAPTURE(o.err);
        CHECK(o.code == 0);
        CHECK(place.bytes("a.png") == place.bytes("b.png"));
    };
    same("auto", "2/4", {"SLURM_ARRAY_TASK_ID=2", "SLURM_ARRAY_TASK_COUNT=4"});
    same("auto", "2/4", {"SLURM_ARRAY_TASK_ID=3", "SLURM_ARRAY_TASK_MIN=1", "SLURM_ARRAY_TASK_COUNT=4"});
    same("auto/5", "3/5", {"JOB_COMPLETION_INDEX=3"});
    same("auto/5", "0/5", {"CUE_IFRAME=0"});
    const auto refused = [&](const std::string& tile, const Words& environment, const std::string& line) {
        const Outcome o = place.render(with(call, {"--tile", tile}), environment);
        CAPTURE(o.err);
        CHECK(o.code == 2);
        CHECK(o.err.find(line) != std::string::npos);
    };
    refused("auto", {}, "--tile: expected auto/N where the environment has no SLURM_ARRAY_TASK_COUNT, got auto");
    refused("auto/4", {}, "--tile: expected SLURM_ARRAY_TASK_ID, JOB_COMPLETION_INDEX or CUE_IFRAME");
    refused("auto/4", {"CUE_IFRAME=4"}, "--tile: expected a number from 0 to 3 in the environment, got 4");
    refused("4/4", {}, "--tile: expected a whole number from 0 to 3, got '4'");
    refused("4", {}, "--tile: expected i/N, auto or auto/N, got '4'");
    refused("0/41", {}, "--tile: expected at most one share for each of the 40 rows, got 41");
}

TEST_CASE("--frames renders an animation, in one run or as an array, with t from 0 to less than 1") {
    const FarmFolder place;
    std::string scene = cube_scene();
    scene.replace(scene.find("0.1"), 3, "0.1 + 0.3 * param(\"t\", 0) + 0 * param(\"frame\", 1)");
    scene.replace(scene.find("param(\"r\", "), 11, "(");
    write_file(place.scene, scene);
    REQUIRE(place.render({"--frames", "1-4", "-o", place / "a.###.png"}).code == 0);
    CHECK(place.names() == Words{"a.001.png", "a.002.png", "a.003.png", "a.004.png", "cube.lua"});
    REQUIRE(place.render({"-D", "t=0.5", "-D", "frame=3", "-o", place / "b.png"}).code == 0);
    CHECK(place.bytes("a.003.png") == place.bytes("b.png"));
    CHECK(place.bytes("a.001.png") != place.bytes("a.002.png"));
    REQUIRE(place.render({"--frames", "3-3/4", "-o", place / "c.#.png"}).code == 0);
    CHECK(place.bytes("c.3.png") == place.bytes("b.png"));
    REQUIRE(place.render({"--frames", "auto/4", "-o", place / "d#.png"}, {"JOB_COMPLETION_INDEX=2"}).code == 0);
    CHECK(place.bytes("d3.png") == place.bytes("b.png"));
    const auto refused = [&](const Words& more, const std::string& line) {
        const Outcome o = place.render(more);
        CAPTURE(o.err);
        CHECK(o.code == 2);
        CHECK(o.err.find(line) != std::string::npos);
    };
    refused({"--frames", "1-4", "-o", place / "a.png"},
            "--frames: expected names with # for the frame's number, got '");
    refused({"--frames", "3", "-o", place / "a.#.png"}, "--frames: expected a-b, a-b/N or auto/N, got '3'");
    refused({"--frames", "3-5/4", "-o", place / "a.#.png"}, "--frames: expected a whole number from 3 to 4, got '5'");
    write_file(place.scene, cube_scene());
    refused({"--frames", "1-4", "-o", place / "a.#.png"},
            "cube.lua: expected a scene with param(\"frame\", 1) or param(\"t\", 0)");
}

TEST_CASE("threads follow the scheduler's and the control group's limits") {
    const FarmFolder place;
    const auto threads = [&](const Words& environment, const Words& more = {}) {
        const Outcome o =
            run(with({"render", place.scene, "-v", "--spp", "1", "-o", place / "a.png"}, more), environment);
        const std::size_t end = o.err.find(" threads\n"), begin = o.err.rfind(' ', end - 1);
        REQUIRE(end != std::string::npos);
        return std::stoi(o.err.substr(begin + 1, end - begin - 1));
    };
    const int all = threads({});
    CHECK(threads({"SLURM_CPUS_PER_TASK=1"}) == 1);
    CHECK(threads({"SLURM_CPUS_PER_TASK=100000"}) == all);
    CHECK(threads({"SLURM_CPUS_PER_TASK="}) == all);
    CHECK(threads({"SLURM_CPUS_PER_TASK=1"}, {"--threads", "3"}) == 3);

    const auto quota = [&] { return deburr::control_group_quota(place / "groups", place / "cgroup"); };
    std::filesystem::create_directories(place / "groups/a/b");
    std::filesystem::create_directories(place / "groups/cpu");
    write_file(place / "cgroup", "0::/a/b\n");
    CHECK(!quota());
    write_file(place / "groups/a/b/cpu.max", "max 100000\n");
    CHECK(!quota());
    write_file(place / "groups/a/cpu.max", "350000 100000\n");
    CHECK(quota() == 3.5);
    write_file(place / "groups/cpu.max", "120000 100000\n");
    CHECK(quota() == 1.2);
    std::filesystem::remove_all(place / "groups/a");
    std::filesystem::remove(place / "groups/cpu.max");
    write_file(place / "groups/cpu/cpu.cfs_quota_us", "-1\n");
    write_file(place / "groups/cpu/cpu.cfs_period_us", "100000\n");
    CHECK(!quota());
    write_file(place / "groups/cpu/cpu.cfs_quota_us", "200000\n");
    CHECK(quota() == 2.0);
}
