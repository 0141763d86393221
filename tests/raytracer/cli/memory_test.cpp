// The program under limits of memory.
#include <algorithm>
#include <cstdlib>

#include "bounds/in_parallel.hpp"
#include "catch.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;

TEST_CASE("of errors in a parallel loop that of the least index is thrown, and one is kept at a time") {
    struct Counted {
        std::size_t index;
        static std::atomic<int>& alive() {
            static std::atomic<int> n{0};
            return n;
        }
        explicit Counted(std::size_t i) : index(i) { ++alive(); }
        Counted(const Counted& o) : index(o.index) { ++alive(); }
        ~Counted() { --alive(); }
    };
    std::atomic<int> most{0};
    try {
        deburr::in_parallel(100'000, [&](std::size_t i) {
            if (i < 17) return;
            int n = Counted::alive();
            for (int seen = most; n > seen && !most.compare_exchange_weak(seen, n);) {
            }
            throw Counted(i);
        });
        FAIL("nothing was thrown");
    } catch (const Counted& error) {
        CHECK(error.index == 17);
    }
    CHECK(Counted::alive() == 0);
    CHECK(most < 100);  // at most one per running thread, and the one that is kept
}

// Sanitizers need more address space than these limits allow.
#if !DEBURR_IS_SANITIZED
TEST_CASE("running out of memory is one line and exit code 1, at whatever limit", "[slow]") {
    const Folder folder;
    write_file(folder / "s.lua", R"(
        local all = {}
        for i = 1, 1200 do all[i] = rounded(0.1, box({i, 0, 0}, {i + 0.6, 0.6, 0.6})) end
        return { camera = { eye = {-40, 20, 30}, target = {0, 0, 0} }, solids = all })");
    // Memory is taken by Lua's values, by what C++ makes of them, and by what is printed.
    write_file(folder / "t.lua", R"(
        local points, texts = {}, {}
        for i = 1, 30000 do points[i] = {i, i * i % 97, i % 13} end
        for i = 1, 300 do texts[i] = ('x'):rep(50000) .. i end
        for i = 1, 5 do convex(points) end
        return { solids = { cube():name(texts[300]:sub(1, 9)) } })");
    const std::string commands[] = {"render s.lua -q --size 40x30 -o a.png", "mesh s.lua -q --tolerance inf -o a.stl",
                                    "render s.lua -q --size 40x30 --accel embree -o a.exr", "info t.lua >/dev/null"};
    int failed = 0, done = 0;
    for (const std::string& command : commands)
        // Around the limit where there is a scene but no room for its PNG, memory ends at many places.
        for (int kib = 36'000; kib < 330'000; kib += &command == commands && kib < 48'000 ? 500 : kib / 3) {
            // Core dumps are off, as they take seconds to write.
            const std::string call = "cd '" + folder / "" + "' && ulimit -c 0 -v " + std::to_string(kib) +
                                     " && exec timeout 60 '" DEBURR_PROGRAM "' " + command + " 2>err";
            const int status = std::system(("bash -c \"" + call + "\"").c_str());
            const std::string err = read_file(folder / "err");
            CAPTURE(command, kib, err);
            REQUIRE(WIFEXITED(status));
            const int code = WEXITSTATUS(status);
            CHECK((code == 0 || code == 1));
            CHECK(err == (code == 0 ? "" : "deburr: out of memory\n"));
            failed += code == 1;
            done += code == 0;
        }
    CHECK(failed > 2);
    CHECK(done > 2);
}

TEST_CASE("threads share memory where the address space is limited") {
    const Folder folder;
    write_file(folder / "s.lua", R"(
        local all = {}
        for i = 1, 1200 do all[i] = rounded(0.1, box({i, 0, 0}, {i + 0.6, 0.6, 0.6})) end
        return { solids = all })");
    // The mesh and its two threads need less than 80 MB; an arena for each thread would reserve 64 MB more.
    const std::string call = "cd '" + folder / "" +
                             "' && ulimit -c 0 -v 100000 && exec timeout 60 '" DEBURR_PROGRAM
                             "' mesh s.lua -q --tolerance inf --threads 2 -o a.stl 2>err";
    const int status = std::system(("bash -c \"" + call + "\"").c_str());
    CAPTURE(read_file(folder / "err"));
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("two thousand half-spaces that reach one another everywhere are meshed and checked in 800 MB") {
    const Folder folder;
    write_file(folder / "s.lua", R"(
        local n, all = 2000
        for i = 0, n - 1 do
            local y, a = 1 - 2 * (i + 0.5) / n, i * 2.399963229728653
            local q = math.sqrt(1 - y * y)
            local h = halfspace({q * math.cos(a), y, q * math.sin(a)}, 1)
            all = all and all * h or h
        end
        return { solids = { rounded(0.05, all) } })");
    // The limit is on address space; 230 MB of it are used.
    const std::string call = "cd '" + folder / "" +
                             "' && ulimit -c 0 -v 800000 && exec timeout 60 '" DEBURR_PROGRAM
                             "' mesh s.lua -q --threads 1 -o a.stl 2>err";
    const int status = std::system(("bash -c \"" + call + "\"").c_str());
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
    CHECK(read_file(folder / "err").empty());
}
#endif
