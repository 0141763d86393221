// --display-server against a viewer that decodes the packets of tev's protocol itself: https://github.com/Tom94/tev
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <map>
#include <thread>

#include "catch.hpp"
#include "raytracer/image/image_difference.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;

namespace {

struct Image {
    int width = 0, height = 0, updates = 0;
    std::map<std::string, std::vector<float>> channels;
};

// Reads the numbers and texts of a packet in order.
class ReceivedPacket {
public:
    explicit ReceivedPacket(std::string bytes) : bytes_(std::move(bytes)) {}
    template <class T>
    T next() {
        REQUIRE(at_ + sizeof(T) <= bytes_.size());
        T value;
        std::memcpy(&value, bytes_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }
    std::string text() {
        const std::size_t end = bytes_.find('\0', at_);
        REQUIRE(end != std::string::npos);
        const std::string all = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        return all;
    }
    bool at_end() const { return at_ == bytes_.size(); }
    std::size_t left() const { return bytes_.size() - at_; }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

// A viewer on a port of its own that stores what one client sends.
class Viewer {
public:
    // Closes the connection after `most` bytes.
    explicit Viewer(std::size_t most = std::size_t(1) << 40) {
        listener_ = socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        REQUIRE(bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
        socklen_t size = sizeof address;
        REQUIRE(getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
        REQUIRE(listen(listener_, 1) == 0);
        port_ = ntohs(address.sin_port);
        thread_ = std::thread([this, most] {
            const int client = accept(listener_, nullptr, nullptr);
            char buffer[65'536];
            ssize_t got = 0;
            while (received_.size() < most && (got = recv(client, buffer, sizeof buffer, 0)) > 0)
                received_.append(buffer, std::size_t(got));
            close(client);
        });
    }
    ~Viewer() {
        if (thread_.joinable()) thread_.join();
        close(listener_);
    }
    std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

    // The images received, by name; waits until the client has gone.
    std::map<std::string, Image> images() {
        thread_.join();
        std::map<std::string, Image> images;
        for (std::size_t at = 0; at < received_.size();) {
            std::uint32_t size = 0;
            REQUIRE(at + 4 <= received_.size());
            std::memcpy(&size, received_.data() + at, 4);
            REQUIRE(size >= 5);
            REQUIRE(at + size <= received_.size());
            ReceivedPacket packet(received_.substr(at + 4, size - 4));
            at += size;
            const char type = packet.next<char>();
            REQUIRE((type == 4 || type == 6));
            CHECK(packet.next<char>() == 0);  // false: the viewer keeps its focus
            Image& image = images[packet.text()];
            if (type == 4)
                create(packet, image);
            else
                update(packet, image);
            CHECK(packet.at_end());
        }
        return images;
    }

private:
    static void create(ReceivedPacket& packet, Image& image) {
        image = {};
        image.width = packet.next<std::int32_t>();
        image.height = packet.next<std::int32_t>();
        const int count = packet.next<std::int32_t>();
        for (int k = 0; k < count; ++k)
            image.channels[packet.text()].resize(std::size_t(image.width) * std::size_t(image.height));
    }
    static void update(ReceivedPacket& packet, Image& image) {
        ++image.updates;
        const std::size_t count = std::size_t(packet.next<std::int32_t>());
        std::vector<std::string> names;
        for (std::size_t k = 0; k < count; ++k) names.push_back(packet.text());
        const int x0 = packet.next<std::int32_t>(), y0 = packet.next<std::int32_t>();
        const int width = packet.next<std::int32_t>(), height = packet.next<std::int32_t>();
        std::vector<std::int64_t> offsets(count), strides(count);
        for (auto& offset : offsets) offset = packet.next<std::int64_t>();
        for (auto& stride : strides) stride = packet.next<std::int64_t>();
        REQUIRE((x0 >= 0 && y0 >= 0 && x0 + width <= image.width && y0 + height <= image.height));
        std::vector<float> data(packet.left() / sizeof(float));
        for (float& number : data) number = packet.next<float>();
        for (std::size_t k = 0; k < count; ++k) {
            REQUIRE(image.channels.count(names[k]) == 1);
            for (int i = 0; i < width * height; ++i)
                image.channels[names[k]][std::size_t((y0 + i / width) * image.width + x0 + i % width)] =
                    data.at(std::size_t(offsets[k] + i * strides[k]));
        }
    }

    int listener_ = -1, port_ = 0;
    std::string received_;
    std::thread thread_;
};

}  // namespace

TEST_CASE("a viewer that speaks tev's protocol has the picture in the end, as the EXR has it") {
    const Folder folder;
    const std::string scene = folder / "cube.lua", exr = folder / "a.exr";
    write_file(scene, cube_scene());
    // An image of 700 × 500 takes two packets.
    const std::vector<std::string> sizes = GENERATE(values<std::vector<std::string>>(
        {{"--size", "700x500", "--spp", "1"}, {"--spp", "24"}, {"--spp", "2", "--crop", "20x30+7+9"}}));
    Viewer viewer;
    std::vector<std::string> words = {"render",           scene,           "-q", "--float", "-o", exr,
                                      "--display-server", viewer.address()};
    words.insert(words.end(), sizes.begin(), sizes.end());
    const Outcome outcome = run(words);
    CHECK(outcome.err == "");
    REQUIRE(outcome.code == 0);
    const auto images = viewer.images();
    REQUIRE(images.size() == 1);
    CHECK(images.begin()->first == exr);
    const Image& image = images.begin()->second;
    const deburr::Film film = deburr::read_picture(exr);
    REQUIRE(image.width == film.window.width);
    REQUIRE(image.height == film.window.height);
    CHECK(image.updates >= (image.width == 700 ? 2 : 1));
    int different = 0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i)
        for (int k = 0; k < 3; ++k)
            different += image.channels.at(std::string(1, "RGB"[k]))[i] != float(film.pixels[i].color[k]);
    CHECK(different == 0);
}

TEST_CASE("samples reach the viewer as they come") {
    const Folder folder;
    const std::string scene = folder / "cube.lua";
    write_file(scene, cube_scene());
    Viewer viewer;
    REQUIRE(
        run({"render", scene, "-q", "--size", "300x200", "--time", "2.5", "--display-server", viewer.address()}).code ==
        0);
    const auto images = viewer.images();
    REQUIRE(images.size() == 1);
    CHECK(images.begin()->first == scene);
    CHECK(images.begin()->second.updates >= 2);
}

TEST_CASE("without a viewer a run ends at once, and one that leaves is not the picture's end") {
    const Folder folder;
    const std::string scene = folder / "cube.lua", png = folder / "a.png";
    write_file(scene, cube_scene());
    const auto render = [&](const std::string& address, const std::string& size = "60x40") {
        return run({"render", scene, "-q", "--spp", "1", "--size", size, "-o", png, "--display-server", address});
    };
    const Outcome nobody = render("127.0.0.1:1");
    CHECK(nobody.code == 1);
    CHECK(nobody.err ==
          "deburr: --display-server: expected a viewer, as tev, that listens at 127.0.0.1:1, got: "
          "Connection refused\n");
    for (const std::string address :
         {"127.0.0.1", ":14158", "localhost:", "localhost:0", "localhost:70000", "::1:14158", "a:b"}) {
        const Outcome wrong = render(address);
        CAPTURE(address);
        CHECK(wrong.code == 2);
        CHECK(wrong.err == "deburr: --display-server: expected HOST:PORT, as 127.0.0.1:14158, got '" + address + "'\n");
    }
    CHECK(!std::filesystem::exists(png));
    Viewer leaves(1000);
    const Outcome alone = render(leaves.address(), "1500x1000");
    CHECK(alone.code == 0);
    CHECK(alone.err ==
          "deburr: warning: --display-server: the viewer at " + leaves.address() + " is gone; going on without\n");
    CHECK(std::filesystem::exists(png));
}
