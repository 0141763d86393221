#include "raytracer/util/printable.hpp"

#include <fmt/format.h>

namespace deburr {
namespace {

struct Character {
    std::size_t bytes = 0;  // 0: not UTF-8
    char32_t code = 0;
};

// The UTF-8 sequence at the beginning of `text`, if it is valid: the shortest form of its code, no surrogate, at most
// U+10FFFF.
Character first_character(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    if (byte(0) < 0x80) return {1, byte(0)};
    const std::size_t bytes = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
    if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < bytes) return {};
    char32_t code = byte(0) & (0x7Fu >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return {};
        code = code << 6 | (byte(i) & 0x3F);
    }
    constexpr char32_t least[5] = {0, 0, 0x80, 0x800, 0x10000};
    if (code < least[bytes] || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return {};
    return {bytes, code};
}

bool is_control(char32_t code) {
    const auto between = [code](char32_t first, char32_t last) { return code >= first && code <= last; };
    return code < 0x20 || between(0x7F, 0x9F)                     // C0, DEL, C1
           || code == 0x061C || between(0x200B, 0x200F)           // marks of direction, of no width
           || between(0x2028, 0x202E) || between(0x2060, 0x206F)  // separators, embeddings, isolates
           || code == 0xFEFF || between(0xFFF9, 0xFFFB)           // byte order mark, annotations
           || between(0xE0000, 0xE007F);                          // tags
}

std::string escape(char32_t code) {
    switch (code) {
        case '\n': return "\\n";
        case '\r': return "\\r";
        case '\t': return "\\t";
        default:
            if (code < 0x80) return fmt::format("\\x{:02x}", std::uint32_t(code));
            return fmt::format("\\u{{{:x}}}", std::uint32_t(code));
    }
}

}  // namespace

std::string printable(std::string_view text, std::string_view kept) {
    std::string line;
    line.reserve(text.size());
    while (!text.empty()) {
        const Character c = first_character(text);
        if (c.bytes == 0) {
            line += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
        } else if (is_control(c.code) && kept.find(text.substr(0, c.bytes)) == std::string_view::npos) {
            line += escape(c.code);
        } else {
            line += text.substr(0, c.bytes);
        }
        text.remove_prefix(c.bytes == 0 ? 1 : c.bytes);
    }
    return line;
}

std::string shortened(std::string_view text, std::size_t bytes) {
    if (text.size() <= bytes) return std::string(text);
    // Continuation bytes are 10xxxxxx; a sequence has at most three.
    for (int i = 0; i < 3 && bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80; ++i) --bytes;
    return std::string(text.substr(0, bytes)) + "…";
}

}  // namespace deburr
