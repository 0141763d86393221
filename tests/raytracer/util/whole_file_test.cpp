// Files that are written whole or not at all.
#include "raytracer/util/whole_file.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "catch.hpp"
#include "raytracer/folder.hpp"
#include "raytracer/program.hpp"
#include "raytracer/util/errors.hpp"

using namespace deburr;
using namespace deburr::test;

TEST_CASE("a file is written, and replaced with its mode kept") {
    const Folder folder;
    const std::string file = folder / "a";
    check_writable(file);
    CHECK(folder.names().empty());
    write_whole_file(file, "one");
    CHECK(read_file(file) == "one");
    REQUIRE(chmod(file.c_str(), 0640) == 0);
    check_writable(file);
    CHECK(read_file(file) == "one");
    write_whole_file(file, "two");
    CHECK(read_file(file) == "two");
    struct stat status {};
    REQUIRE(stat(file.c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0640);
    CHECK(folder.names() == Names{"a"});
}

TEST_CASE("a symbolic link goes on to point to the file it names") {
    const Folder folder;
    write_whole_file(folder / "a", "one");
    std::filesystem::create_symlink("a", folder / "link");
    std::filesystem::create_symlink("later", folder / "dangling");
    write_whole_file(folder / "link", "two");
    write_whole_file(folder / "dangling", "three");
    CHECK(read_file(folder / "a") == "two");
    CHECK(read_file(folder / "later") == "three");
    CHECK(std::filesystem::is_symlink(folder / "link"));
    CHECK(folder.names() == Names{"a", "dangling", "later", "link"});
}

TEST_CASE("what cannot be written is found before the work") {
    const Folder folder;
    write_file(folder / "file", "");
    CHECK_THROWS_AS(check_writable(folder / "none/a"), WorkError);
    CHECK_THROWS_AS(check_writable(folder / "file/a"), WorkError);
    CHECK_THROWS_AS(check_writable(folder / ""), WorkError);
    CHECK_THROWS_AS(check_writable(folder / std::string(300, 'x')), WorkError);
    CHECK(folder.names() == Names{"file"});
}

TEST_CASE("a write that fails leaves what was there") {
    const Folder folder;
    write_whole_file(folder / "old", "old");
    rlimit before{};
    REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
    const auto handler = signal(SIGXFSZ, SIG_IGN);
    rlimit small = before;
    small.rlim_cur = 1000;
    REQUIRE(setrlimit(RLIMIT_FSIZE, &small) == 0);
    std::string message;
    for (const char* name : {"old", "new"}) {
        try {
            write_whole_file(folder / name, std::string(5000, 'x'));
        } catch (const WorkError& error) {
            message = error.what();
        }
    }
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    CHECK(message == "cannot write '" + folder / "new" + "': File too large");
    CHECK(folder.names() == Names{"old"});
    CHECK(read_file(folder / "old") == "old");
}

TEST_CASE("files that belong together appear together, or none of them does") {
    const Folder folder;
    write_whole_files({{folder / "a", "one"}, {folder / "b", "two"}});
    CHECK(read_file(folder / "a") == "one");
    CHECK(read_file(folder / "b") == "two");
    for (const bool first : {true, false}) {
        const std::string fine = folder / "a", wrong = first ? folder / "none/b" : std::string("/dev/full");
        std::vector<FileBytes> files{{fine, "three"}, {wrong, "four"}};
        if (first) std::swap(files[0], files[1]);
        CHECK_THROWS_AS(write_whole_files(files), WorkError);
        CHECK(read_file(folder / "a") == "one");
        CHECK(folder.names() == Names{"a", "b"});
    }
    // The first file is complete when the second exceeds the limit of size.
    rlimit before{};
    REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
    const auto handler = signal(SIGXFSZ, SIG_IGN);
    rlimit small = before;
    small.rlim_cur = 1000;
    REQUIRE(setrlimit(RLIMIT_FSIZE, &small) == 0);
    CHECK_THROWS_AS(write_whole_files({{folder / "a", "three"}, {folder / "b", std::string(5000, 'x')}}), WorkError);
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    CHECK(read_file(folder / "a") == "one");
    CHECK(read_file(folder / "b") == "two");
    CHECK(folder.names() == Names{"a", "b"});
}

TEST_CASE("a full device is an error") {
    check_writable("/dev/full");
    CHECK_THROWS_AS(write_whole_file("/dev/full", "text"), WorkError);
}

TEST_CASE("the hidden file of a run that was killed is removed by the next, another's is not") {
    const Folder folder;
    // The owner of the first file has ended; this process holds the second; the others are not hidden files of the
    // program's.
    write_file(folder / ".deburr-99999999-0.tmp", "half");
    write_file(folder / ".deburr-1-0.tmp", "in work");
    write_file(folder / ".deburr-notes.tmp", "kept");
    std::filesystem::create_symlink("a", folder / ".deburr-7-0.tmp");
    const int held = open((folder / ".deburr-1-0.tmp").c_str(), O_RDWR);
    REQUIRE(flock(held, LOCK_EX) == 0);
    check_writable(folder / "a");
    CHECK(folder.names() == Names{".deburr-1-0.tmp", ".deburr-7-0.tmp", ".deburr-notes.tmp"});
    close(held);
}

TEST_CASE("a run that is killed while it writes leaves a hidden file until the next run") {
    const Folder folder;
    write_file(folder / "cube.lua", cube_scene());
    const auto hidden = [&] {
        for (const std::string& name : folder.names())
            if (name.starts_with(".deburr-")) return true;
        return false;
    };
    bool left = false;
    for (int attempt = 0; attempt < 20 && !left; ++attempt) {
        Call call({"render", folder / "cube.lua", "-q", "--size", "1500x1000", "--float", "--aov", "P,N", "-o",
                   folder / "a.exr"});
        while (call.running() && !std::filesystem::exists(folder / "a.exr") && !left) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            if (!hidden()) continue;
            call.send(SIGKILL);
            call.wait();
            left = hidden();
        }
    }
    REQUIRE(left);
    REQUIRE(run({"render", folder / "cube.lua", "-q", "-o", folder / "b.png"}).code == 0);
    CHECK_FALSE(hidden());
}
