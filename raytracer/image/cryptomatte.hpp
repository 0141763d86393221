// Masks of solids by name, as compositing programs read them [Friedman & Jones, Cryptomatte Specification 1.2, 2018]:
// pairs of a name's hash and the share of the pixel that its solid covers, the greatest first.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deburr {

constexpr std::string_view cryptomatte_layer = "CryptoObject";

/// MurmurHash3_x86_32 with the seed 0 [Appleby].
std::uint32_t murmur3(std::string_view text);

/// A name's hash as the file holds it, a 32-bit float that is neither infinite nor subnormal nor no number.
float cryptomatte_number(std::string_view name);

/// What the header says of the layer: its name, hash and manifest.
std::vector<std::pair<std::string, std::string>> cryptomatte_attributes(const std::vector<std::string>& names);

}  // namespace deburr
