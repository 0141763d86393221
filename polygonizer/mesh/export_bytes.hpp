// Appends numbers to a string as binary formats store them: little-endian, IEEE 754.
#pragma once
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "bounds/vec.hpp"

namespace deburr {

static_assert(std::numeric_limits<float>::is_iec559 && sizeof(float) == 4);

inline void put_word(std::string& out, std::uint32_t x) {
    for (int k = 0; k < 4; ++k) out += char(x >> (8 * k) & 0xff);
}

inline void put(std::string& out, float x) {
    std::uint32_t bits;
    std::memcpy(&bits, &x, 4);
    put_word(out, bits);
}

inline void put(std::string& out, double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, 8);
    put_word(out, std::uint32_t(bits));
    put_word(out, std::uint32_t(bits >> 32));
}

inline void put_floats(std::string& out, Vec3 x) {
    for (int k = 0; k < 3; ++k) put(out, float(x[k]));
}

/// n in 32 bits. Throws std::length_error if it does not fit.
inline std::uint32_t count_of(std::size_t n) {
    if (n > std::numeric_limits<std::uint32_t>::max())
        throw std::length_error("a mesh of more than 4 294 967 295 elements does not fit the format");
    return std::uint32_t(n);
}

}  // namespace deburr
