#include "raytracer/image/display_server.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <memory>

#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

enum class PacketType : char { create_image = 4, update_image = 6 };

constexpr std::string_view rgb[] = {"R", "G", "B"};

// A viewer that accepts no data for this long is given up: rendering is worth more.
constexpr timeval patience{.tv_sec = 3, .tv_usec = 0};

// Most pixels of an update, so that packets stay far below the 4 GiB that their length allows.
constexpr int max_pixels_of_packet = 1 << 18;

void add_bits(std::string& packet, std::uint64_t bits, int bytes) {
    for (int k = 0; k < bytes; ++k) packet.push_back(char(bits >> (8 * k) & 0xff));
}
void add(std::string& packet, int number) { add_bits(packet, std::uint32_t(number), 4); }
void add(std::string& packet, std::int64_t number) { add_bits(packet, std::uint64_t(number), 8); }
void add(std::string& packet, float number) { add_bits(packet, std::bit_cast<std::uint32_t>(number), 4); }
void add(std::string& packet, std::string_view text) {
    packet.append(text.substr(0, text.find('\0')));
    packet.push_back('\0');
}

// The beginning of a packet, with room for its length; it does not bring the viewer's window to the front.
std::string begun(PacketType type, const std::string& name) {
    std::string packet(4, '\0');
    packet.push_back(char(type));
    packet.push_back(0);
    add(packet, name);
    return packet;
}

struct Address {
    std::string host, port;
};

Address parse(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    Address address;
    if (colon != std::string::npos) address = {text.substr(0, colon), text.substr(colon + 1)};
    const bool is_v6 = address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']';
    if (is_v6) address.host = address.host.substr(1, address.host.size() - 2);
    const bool is_port = !address.port.empty() && address.port.size() <= 5 &&
                         address.port.find_first_not_of("0123456789") == std::string::npos &&
                         std::stoi(address.port) >= 1 && std::stoi(address.port) <= 65535;
    if (address.host.empty() || !is_port || (!is_v6 && address.host.find(':') != std::string::npos))
        throw UsageError("--display-server: expected HOST:PORT, as 127.0.0.1:14158, got '" + text + "'");
    return address;
}

}  // namespace

DisplayServer::DisplayServer(const std::string& address) : address_(address) {
    const auto [host, port] = parse(address);
    addrinfo hints{}, *first = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    const int code = getaddrinfo(host.c_str(), port.c_str(), &hints, &first);
    const auto fail = [&](const char* why) {
        throw WorkError(
            fmt::format("--display-server: expected a viewer, as tev, that listens at {}, got: {}", address, why));
    };
    if (code != 0) fail(gai_strerror(code));
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> all(first, freeaddrinfo);
    int error = 0;
    for (const addrinfo* at = first; at; at = at->ai_next) {
        socket_ = socket(at->ai_family, at->ai_socktype | SOCK_CLOEXEC, at->ai_protocol);
        if (socket_ < 0) {
            error = errno;
            continue;
        }
        setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);  // also limits connect()
        if (connect(socket_, at->ai_addr, at->ai_addrlen) == 0) return;
        error = errno == EINPROGRESS ? ETIMEDOUT : errno;
        close(socket_);
    }
    fail(std::strerror(error));
}

DisplayServer::~DisplayServer() { close(socket_); }

void DisplayServer::send(std::string& packet) {
    std::string length;
    add(length, int(packet.size()));
    packet.replace(0, 4, length);
    for (std::size_t at = 0; at < packet.size();) {
        const ssize_t sent = ::send(socket_, packet.data() + at, packet.size() - at, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent < 0) {
            const bool is_stuck = errno == EAGAIN || errno == EWOULDBLOCK;
            throw WorkError(
                fmt::format("--display-server: the viewer at {} {}", address_, is_stuck ? "takes nothing" : "is gone"));
        }
        at += std::size_t(sent);
    }
}

void DisplayServer::show(const std::string& name, const Film& film) {
    const int width = film.window.width, height = film.window.height, count = int(std::size(rgb));
    if (shown_ != name) {
        std::string packet = begun(PacketType::create_image, name);
        for (const int number : {width, height, count}) add(packet, number);
        for (const std::string_view channel : rgb) add(packet, channel);
        send(packet);
        shown_ = name;
    }
    const int rows = std::max(1, max_pixels_of_packet / width);
    for (int y = 0; y < height; y += rows) {
        const int these = std::min(rows, height - y);
        std::string packet = begun(PacketType::update_image, name);
        add(packet, count);
        for (const std::string_view channel : rgb) add(packet, channel);
        for (const int number : {0, y, width, these}) add(packet, number);
        for (int k = 0; k < count; ++k) add(packet, std::int64_t(k));      // offset of each channel
        for (int k = 0; k < count; ++k) add(packet, std::int64_t(count));  // stride of each channel
        for (int i = y * width; i < (y + these) * width; ++i)
            for (int k = 0; k < count; ++k) add(packet, float(film.pixels[std::size_t(i)].color[k]));
        send(packet);
    }
}

}  // namespace deburr
