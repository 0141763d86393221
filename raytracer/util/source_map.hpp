// Maps line numbers to files for a scene that is read from several files.
//
// Lines are numbered consecutively through all files in the order in which they are read, so that one number is a place
// everywhere: in the interpreter, in solids and in messages. In a scene of one file it is the line itself.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

namespace deburr {

/// The number of lines of a text; a final newline begins another, empty one.
inline int line_count(const std::string& text) { return 1 + int(std::count(text.begin(), text.end(), '\n')); }

/// The files of a scene with their line numbers.
class SourceMap {
public:
    SourceMap() = default;
    bool empty() const { return files_.empty(); }
    explicit SourceMap(const std::string& file) { add(file, 0); }

    /// Adds a file with this number of lines; returns the number of lines before its first.
    int add(const std::string& file, int lines) {
        const int before = lines_;
        files_.push_back({file, before});
        lines_ += lines;
        return before;
    }
    /// The file and line of a line number, such as "lid.lua:7"; for 0 (unknown), the first file's name only.
    std::string place(int line) const {
        if (files_.empty()) return "";
        if (line <= 0) return files_.front().name;
        std::size_t file = files_.size() - 1;
        while (file > 0 && files_[file].before >= line) --file;
        return files_[file].name + ":" + std::to_string(line - files_[file].before);
    }

private:
    // A file of the scene.
    struct File {
        std::string name;
        int before;  // lines in the files before it
    };
    std::vector<File> files_;
    int lines_ = 0;
};

}  // namespace deburr
