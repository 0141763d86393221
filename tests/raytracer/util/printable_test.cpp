// Printable text: escaped control characters, and cuts between characters.
#include "raytracer/util/printable.hpp"

#include "catch.hpp"

using namespace deburr;

TEST_CASE("printable text holds no control character, whatever it is made of") {
    CHECK(printable("") == "");
    CHECK(printable("Größe 3 → ½ 名 🙂 \\ ~") == "Größe 3 → ½ 名 🙂 \\ ~");
    CHECK(printable("\33]0;owned\7\33[2J") == "\\x1b]0;owned\\x07\\x1b[2J");
    CHECK(printable(std::string("a\n\r\t\0b\177", 7)) == "a\\n\\r\\t\\x00b\\x7f");
    CHECK(printable("a\n\t\33", "\n\t") == "a\n\t\\x1b");
    CHECK(printable("\xC2\x9B"
                    "31m") == "\\u{9b}31m");          // C1 control sequence introducer
    CHECK(printable("\xE2\x80\xAE") == "\\u{202e}");  // right-to-left override
    CHECK(printable("\xE2\x80\xA8\xEF\xBB\xBF") == "\\u{2028}\\u{feff}");
    CHECK(printable("\xF3\xA0\x80\xA0") == "\\u{e0020}");
    CHECK(printable("\x9B"
                    "31m\xFF") == "\\x9b31m\\xff");                                    // the same as a single byte
    CHECK(printable("\xC0\x9B\xE0\x80\x9B\xC3") == "\\xc0\\x9b\\xe0\\x80\\x9b\\xc3");  // overlong forms; cut-off form
    CHECK(printable("\xED\xA0\x80\xF4\x90\x80\x80") == "\\xed\\xa0\\x80\\xf4\\x90\\x80\\x80");
}

TEST_CASE("every byte and every pair of bytes becomes printable, and stays as it then is") {
    for (int a = 0; a < 256; ++a)
        for (int b = 0; b < 256; ++b) {
            const std::string line = printable(std::string{char(a), char(b)});
            for (const char c : line) REQUIRE((static_cast<unsigned char>(c) >= 0x20 && c != 0x7F));
            REQUIRE(printable(line) == line);
        }
}

TEST_CASE("a shortened text ends between two characters") {
    CHECK(shortened("abc", 3) == "abc");
    CHECK(shortened("abcd", 3) == "abc…");
    CHECK(shortened("aé½", 2) == "a…");
    CHECK(shortened("a🙂b", 4) == "a…");
    CHECK(shortened("\x80\x80\x80\x80\x80", 4) == "\x80…");
}
