// `deburr view` as a browser uses it, over HTTP, while its file is edited.
#include <httplib.h>
#include <signal.h>
#include <zlib.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;
using nlohmann::json;

namespace {

struct Frame {
    json head;
    std::string rgba;
};

// A running `deburr view` and a client that plays its page.
struct Page : Folder {
    std::string scene = *this / "cube.lua";
    std::unique_ptr<Call> call;
    std::unique_ptr<httplib::Client> client;
    std::string root, host;
    int seen = 0;

    explicit Page(const std::vector<std::string>& more = {}) {
        write_file(scene, cube_scene());
        begin(more);
    }
    // Shows another file, which a script in the place of openscad reads.
    Page(const std::string& name, const std::string& text, const std::string& openscad) {
        scene = *this / name;
        write_file(scene, text);
        const std::string program = *this / "openscad";
        write_file(program, openscad);
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        begin({"--size", "60x40", "--spp", "1"},
              {"PATH=" + std::filesystem::path(program).parent_path().string() + ":/usr/bin:/bin"});
    }

    void begin(const std::vector<std::string>& more, const std::vector<std::string>& environment = {}) {
        std::vector<std::string> words = {"view", scene};
        words.insert(words.end(), more.begin(), more.end());
        std::vector<std::string> all = {"SOURCE_DATE_EPOCH=0"};
        all.insert(all.end(), environment.begin(), environment.end());
        call = std::make_unique<Call>(words, all);
        const std::string address = call->first_line();
        const std::string start = "http://127.0.0.1:";
        REQUIRE(address.substr(0, start.size()) == start);
        const std::size_t slash = address.find('/', start.size());
        host = address.substr(7, slash - 7);
        root = address.substr(slash);
        client = std::make_unique<httplib::Client>("http://" + host);
        client->set_read_timeout(60);
    }

    httplib::Result get(const std::string& path) { return client->Get((root + path).c_str()); }
    int post(const std::string& path, const std::string& body) {
        const auto answer = client->Post((root + path).c_str(), body, "application/json");
        return answer ? answer->status : -1;
    }
    // The first frame from now on for which test(frame) is true.
    template <class Test>
    Frame frame(Test test) {
        for (int i = 0; i < 2000; ++i) {
            const auto answer = get("frame?after=" + std::to_string(seen));
            REQUIRE(answer);
            if (answer->status == 204) continue;
            REQUIRE(answer->status == 200);
            const std::string& body = answer->body;
            std::size_t size = 0;
            for (int k = 3; k >= 0; --k) size = size << 8 | static_cast<unsigned char>(body[std::size_t(k)]);
            Frame frame{json::parse(body.substr(4, size)), body.substr(4 + size)};
            CHECK(frame.head["number"] > seen);
            seen = frame.head["number"];
            CHECK(frame.rgba.size() ==
                  4 * frame.head["width"].get<std::size_t>() * frame.head["height"].get<std::size_t>());
            if (test(frame)) return frame;
        }
        FAIL("no such frame came");
        return {};
    }
    Frame finished() {
        return frame([](const Frame& f) { return f.head["finished"] == true && f.head["error"] == ""; });
    }
};

}  // namespace

TEST_CASE("a camera that moves is answered by a picture before its samples") {
    Page page({"--spp", "20"});
    // A late request gets only the latest frame; of many pictures at least one is seen at its beginning.
    bool coarse = false;
    for (int i = 0; i < 100 && !coarse; ++i) {
        coarse = page.frame([](const Frame&) { return true; }).head["samples"] == 0;
        const char* const camera = i % 2 ? "null" : R"({"eye": [4, 1, 1], "target": [0, 0, 0], "up": [0, 1, 0]})";
        REQUIRE(page.post("camera", camera) == 200);
    }
    CHECK(coarse);
}

TEST_CASE("a page sees the picture refined to the bytes of render") {
    Page page({"--spp", "20"});
    const Frame last = page.finished();
    CHECK(last.head["width"] == 60);
    CHECK(last.head["samples"] == 20);
    const auto exr = page.get("picture.exr");
    REQUIRE(exr);
    REQUIRE(run({"render", page.scene, "-q", "--spp", "20", "-o", page / "a.exr", "-o", page / "a.png"},
                {"SOURCE_DATE_EPOCH=0"})
                .code == 0);
    CHECK(exr->body == read_file(page / "a.exr"));
    CHECK(page.get("picture.png")->body == read_file(page / "a.png"));
    CHECK(page.get("picture.stl")->body.size() > 1000);
    const json scene = json::parse(page.get("scene")->body);
    CHECK(scene["file"] == "cube.lua");
    CHECK(scene["parameters"]["r"] == "0.1");
    page.call->send(SIGINT);
    CHECK(page.call->wait().code == 0);
}

TEST_CASE("only who knows the token, by this host's name, gets anything") {
    Page page;
    const auto html = page.get("");
    REQUIRE(html);
    CHECK(html->status == 200);
    CHECK(html->body.find("<!doctype html>") == 0);
    CHECK(html->body.find("http://") == std::string::npos);  // nothing is loaded from elsewhere
    CHECK(html->body.find("https://") == std::string::npos);
    for (const char* header : {"Content-Security-Policy", "X-Content-Type-Options", "Referrer-Policy"})
        CHECK(html->has_header(header));
    for (const std::string path : {"/", "/frame", "/scene", "/picture.exr", "/00000000000000000000000000000000/"})
        CHECK(page.client->Get(path.c_str())->status == 404);
    for (const std::string path :
         {"../cube.lua", "cube.lua", "picture.lua", "..%2f..%2fetc%2fpasswd", "picture.exr/../x"})
        CHECK(page.get(path)->status == 404);
    for (const std::string host : {"evil.example", "evil.example:80", "127.0.0.1", ""})
        CHECK(page.client->Get(page.root.c_str(), {{"Host", host}})->status == 403);
    CHECK(page.post("camera", "{\"eye\": [0, 0, 0]}") == 400);
    CHECK(page.post("camera", "{\"eye\": [1, 1, 1], \"target\": [1, 1, 1], \"up\": [0, 1, 0]}") == 400);
    CHECK(page.post("camera", "nonsense") == 400);
    CHECK(page.post("parameters", "[]") == 400);
    CHECK(page.post("camera", std::string(100'000, ' ')) == 413);
    CHECK(page.get("scene")->status == 200);
}

TEST_CASE("the camera, parameters and the place that is clicked are answered") {
    Page page;
    const Frame before = page.finished();
    REQUIRE(page.post("camera", R"({"eye": [4, 1, 1], "target": [0.5, 0.5, 0.5], "up": [0, 1, 0]})") == 200);
    const Frame moved = page.finished();
    CHECK(moved.rgba != before.rgba);
    REQUIRE(page.post("camera", "null") == 200);
    CHECK(page.finished().rgba == before.rgba);
    REQUIRE(page.post("camera", R"({"eye": [4, 1, 1], "target": [0.5, 0.5, 0.5], "up": [0, 1, 0]})") == 200);
    CHECK(page.finished().rgba == moved.rgba);
    REQUIRE(page.post("parameters", R"({"r": "0.3"})") == 200);
    const Frame rounder = page.frame(
        [&](const Frame& f) { return f.head["finished"] == true && f.head["scene"] != before.head["scene"]; });
    CHECK(rounder.rgba != moved.rgba);  // the camera is kept, too
    REQUIRE(page.post("camera", "null") == 200);
    const json hit = json::parse(page.get("pick?x=30&y=20")->body);
    CHECK(hit["solid"] == "solid 1");
    CHECK(hit["radii"] == json::array({0.3}));
    CHECK(hit["place"] == page.scene + ":8");
    CHECK(json::parse(page.get("pick?x=1&y=1")->body).is_null());
    REQUIRE(page.post("parameters", R"({"q": "1"})") == 200);
    page.frame([](const Frame& f) { return f.head["error"] != ""; });
}

TEST_CASE("a page behind a slow line gets its frames compressed") {
    Page page;
    page.finished();
    page.client->set_decompress(false);
    const auto whole = page.get("frame?after=0"), packed = page.get("frame?after=0&packed=1");
    REQUIRE(whole);
    REQUIRE(packed);
    CHECK(packed->get_header_value("Content-Encoding") == "deflate");
    std::string body(whole->body.size(), '\0');
    uLongf size = body.size();
    REQUIRE(uncompress(reinterpret_cast<Bytef*>(body.data()), &size,
                       reinterpret_cast<const Bytef*>(packed->body.data()), packed->body.size()) == Z_OK);
    CHECK(size == body.size());
    CHECK(body == whole->body);
    CHECK(packed->body.size() < whole->body.size());
}

TEST_CASE("a file that is edited, broken, mended, replaced, deleted and there again is followed") {
    Page page;
    const Frame first = page.finished();
    const auto scene = first.head["scene"];
    write_file(page.scene, "return {\n  solids = { rounded(-1, cube()) }\n}\n");
    const Frame broken = page.frame([](const Frame& f) { return f.head["error"] != ""; });
    CHECK(broken.head["error"].get<std::string>().find("cube.lua:2: ") != std::string::npos);
    CHECK(broken.rgba == first.rgba);  // the last picture stays
    std::string other = cube_scene();
    other.replace(other.find("0.1"), 3, "0.4");
    write_file(page / "new", other);  // as editors write files
    std::filesystem::rename(page / "new", page.scene);
    const Frame mended = page.finished();
    CHECK(mended.head["scene"] > scene);
    CHECK(mended.rgba != first.rgba);
    std::filesystem::remove(page.scene);
    page.frame([](const Frame& f) { return f.head["error"] != ""; });
    write_file(page.scene, cube_scene());
    CHECK(page.finished().rgba == first.rgba);
}

TEST_CASE("two pages see the same, and closing them ends nothing") {
    Page page;
    const Frame a = page.finished();
    page.seen = 0;
    const Frame b = page.finished();
    CHECK(a.rgba == b.rgba);
    page.client.reset();
    page.client = std::make_unique<httplib::Client>("http://" + page.host);
    CHECK(page.get("scene")->status == 200);
    CHECK(run({"view", page / "none.lua"}).code == 2);
    const Outcome taken = run({"view", page.scene, "--port", page.host.substr(page.host.find(':') + 1)});
    CHECK(taken.code == 1);
    CHECK(taken.err.find("the port is taken") != std::string::npos);
}

// A script in the place of OpenSCAD: for `cube(N);` it makes a tetrahedron of size N, for all else an error.
constexpr const char* openscad_for_tests = R"(#!/bin/sh
s=$(sed -n 's/^cube(\([0-9]*\));$/\1/p' "$3")
if [ -z "$s" ]; then echo "ERROR: Parser error: syntax error in file $3, line 1" >&2; exit 1; fi
{
    echo solid s
    for f in "0 0 0 0 $s 0 $s 0 0" "0 0 0 $s 0 0 0 0 $s" "0 0 0 0 0 $s 0 $s 0" "$s 0 0 0 $s 0 0 0 $s"; do
        set -- "$1" "$2" "$3" $f
        echo "facet normal 0 0 0 outer loop vertex $4 $5 $6 vertex $7 $8 $9 vertex ${10} ${11} ${12} endloop endfacet"
    done
    echo endsolid s
} >"$2"
)";

TEST_CASE("a program for OpenSCAD is shown, and followed while it is edited") {
    Page page("part.scad", "cube(2);\n", openscad_for_tests);
    const Frame first = page.finished();
    write_file(page.scene, "cube(2;\n");
    const Frame broken = page.frame([](const Frame& f) { return f.head["error"] != ""; });
    CHECK(broken.head["error"].get<std::string>().find("Parser error") != std::string::npos);
    CHECK(broken.rgba == first.rgba);
    write_file(page.scene, "cube(3);\n");
    const Frame mended = page.finished();
    CHECK(mended.head["scene"] > first.head["scene"]);
    const auto stl = page.get("picture.stl");
    REQUIRE(stl);
    CHECK(stl->body.size() == 84 + 50 * 4);
}
