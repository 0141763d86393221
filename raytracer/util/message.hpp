// What the program tells people, apart from results: lines on stderr. That nobody can read them is
// no error.
#pragma once
#include <cstdio>
#include <string>

namespace deburr {

/// "deburr: TEXT" as one line, whatever control characters a name in it holds.
inline void message(const std::string& text) {
    std::string line = "deburr: " + text;
    for (char& c : line)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    line += '\n';
    std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace deburr
