// Where a line of a scene stands that is read from several files.
//
// Lines are counted on from one file to the next, in the order in which they are read, so that one number is a place
// everywhere: in the interpreter, in solids and in messages. Of a scene of one file it is the line itself.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

namespace deburr {

/// Of a text, the last one with or without its end.
inline int line_count(const std::string& text) { return 1 + int(std::count(text.begin(), text.end(), '\n')); }

class SourceMap {
public:
    SourceMap() = default;
    bool empty() const { return files_.empty(); }
    explicit SourceMap(const std::string& file) { add(file, 0); }

    /// Takes a file with so many lines; returns how many there are before its first.
    int add(const std::string& file, int lines) {
        const int before = lines_;
        files_.push_back({file, before});
        lines_ += lines;
        return before;
    }
    /// "lid.lua:7"; where the line is 0, which is unknown, the first file alone.
    std::string place(int line) const {
        if (files_.empty()) return "";
        if (line <= 0) return files_.front().name;
        std::size_t file = files_.size() - 1;
        while (file > 0 && files_[file].before >= line) --file;
        return files_[file].name + ":" + std::to_string(line - files_[file].before);
    }

private:
    struct File {
        std::string name;
        int before;
    };
    std::vector<File> files_;
    int lines_ = 0;
};

}  // namespace deburr
