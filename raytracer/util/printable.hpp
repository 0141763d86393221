// Text from outside (names, a scene's output, messages that quote either) as a terminal may show it.
//
// A scene's author chooses what the program prints about it. Control characters would let them move the cursor, rename
// the window or turn the direction of writing; each is shown as an escape instead.
#pragma once
#include <string>
#include <string_view>

namespace deburr {

/// `text` with every control character written as \n, \r, \t or \xHH, and a Unicode one as \u{H…}: C0 and C1 controls,
/// DEL, marks of writing direction, separators of lines, and bytes that are not UTF-8. The result is one line and, read
/// again, unchanged. `kept` are control characters that stay, such as "\n\t" in a text of several lines.
std::string printable(std::string_view text, std::string_view kept = "");

/// The first `bytes` bytes of `text` at most, with "…" where some are missing; no UTF-8 sequence is cut.
std::string shortened(std::string_view text, std::size_t bytes);

}  // namespace deburr
