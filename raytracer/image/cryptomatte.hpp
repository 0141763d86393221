// Cryptomatte: masks of solids by name for compositing programs [Friedman & Jones, Cryptomatte Specification 1.2,
// 2018], stored as pairs of a name's hash and the share of the pixel that its solid covers, the greatest first.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deburr {

constexpr std::string_view cryptomatte_layer = "CryptoObject";

/// The hash MurmurHash3_x86_32 with seed 0 [Appleby].
std::uint32_t murmur3(std::string_view text);

/// A name's hash as a 32-bit float, whose bits are changed so that it is neither infinite, NaN nor subnormal.
float cryptomatte_number(std::string_view name);

/// The header attributes of the layer: its name, hash and manifest.
std::vector<std::pair<std::string, std::string>> cryptomatte_attributes(const std::vector<std::string>& names);

}  // namespace deburr
