#include "raytracer/util/whole_file.hpp"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "catch.hpp"
#include "raytracer/folder.hpp"
#include "raytracer/util/errors.hpp"

using namespace deburr;
using namespace deburr::test;
using Names = std::vector<std::string>;

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

TEST_CASE("a full device is an error") {
    check_writable("/dev/full");
    CHECK_THROWS_AS(write_whole_file("/dev/full", "text"), WorkError);
}
