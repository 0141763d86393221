// Makes text from outside (names, a scene's output, messages that quote either) safe to show on a terminal.
//
// A scene's author chooses what the program prints about it. Control characters would let them move the cursor, rename
// the window or reverse the writing direction, so each is shown as an escape.
#pragma once
#include <string>
#include <string_view>

namespace deburr {

/// `text` with control characters written as \n, \r, \t, \xHH or, beyond ASCII, \u{H…}: C0 and C1 controls, DEL, marks
/// of writing direction, line separators, and bytes that are not UTF-8. The result is one line, and printable() leaves
/// it unchanged. Control characters in `kept` stay, such as "\n\t" for a text of several lines.
std::string printable(std::string_view text, std::string_view kept = "");

/// At most the first `bytes` bytes of `text`, with "…" if some were cut off; no UTF-8 sequence is split.
std::string shortened(std::string_view text, std::size_t bytes);

}  // namespace deburr
