#include "raytracer/image/cryptomatte.hpp"

#include <fmt/format.h>

#include <bit>
#include <nlohmann/json.hpp>

namespace deburr {

std::uint32_t murmur3(std::string_view text) {
    constexpr std::uint32_t c1 = 0xcc9e2d51, c2 = 0x1b873593;
    std::uint32_t h = 0, tail = 0;
    const auto byte = [&](std::size_t i) { return std::uint32_t(static_cast<unsigned char>(text[i])); };
    const std::size_t whole = text.size() / 4 * 4;
    for (std::size_t i = 0; i < whole; i += 4) {
        std::uint32_t k = byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24;
        h ^= std::rotl(k * c1, 15) * c2;
        h = std::rotl(h, 13) * 5 + 0xe6546b64;
    }
    for (std::size_t i = text.size(); i > whole; --i) tail = tail << 8 | byte(i - 1);
    h ^= std::rotl(tail * c1, 15) * c2;
    h ^= std::uint32_t(text.size());
    h = (h ^ h >> 16) * 0x85ebca6b;
    h = (h ^ h >> 13) * 0xc2b2ae35;
    return h ^ h >> 16;
}

// An exponent of all zeros or all ones is avoided by inverting its lowest bit [specification, "uint32_to_float32"].
float cryptomatte_number(std::string_view name) {
    std::uint32_t hash = murmur3(name);
    const std::uint32_t exponent = hash >> 23 & 255;
    if (exponent == 0 || exponent == 255) hash ^= 1u << 23;
    return std::bit_cast<float>(hash);
}

std::vector<std::pair<std::string, std::string>> cryptomatte_attributes(const std::vector<std::string>& names) {
    nlohmann::ordered_json manifest = nlohmann::ordered_json::object();
    for (const std::string& name : names)
        manifest[name] = fmt::format("{:08x}", std::bit_cast<std::uint32_t>(cryptomatte_number(name)));
    const std::string key =
        fmt::format("cryptomatte/{}/", fmt::format("{:08x}", murmur3(cryptomatte_layer)).substr(0, 7));
    return {{key + "name", std::string(cryptomatte_layer)},
            {key + "hash", "MurmurHash3_32"},
            {key + "conversion", "uint32_to_float32"},
            {key + "manifest", manifest.dump()}};
}

}  // namespace deburr
