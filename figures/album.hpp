// An album: a folder of finished figures, with a record of what they were made of (figures.json) and the page that
// shows them (README.md).
#pragma once
#include <map>
#include <string>

#include "figures/figure.hpp"

namespace deburr {

/// A hash of the program's own file, any change of which may change a picture.
std::string program_fingerprint();

/// A hash of everything that a figure is made of: the program, the bytes of its scenes, and the settings. Throws
/// UsageError if a scene does not exist.
std::string fingerprint(const Figure& figure, const std::string& program, const std::string& scene_folder, bool draft);

/// The figures in one folder.
class Album {
public:
    /// Reads the album in the folder; a missing folder is an empty album, and an unreadable figures.json is ignored.
    explicit Album(std::string folder);

    /// Whether the figure was made with this fingerprint and its files are unchanged.
    bool has(const Figure& figure, const std::string& fingerprint) const;
    /// Records the figure, and writes figures.json and the page. Throws WorkError.
    void add(const Figure& figure, const std::string& fingerprint, const FigureResult& result,
             const std::string& scene_folder);
    /// Writes the page again from the record.
    void write(const std::string& scene_folder) const;

    const std::string& folder() const { return folder_; }

private:
    // The record of one figure.
    struct Entry {
        std::string fingerprint;
        FigureResult result;
        std::map<std::string, std::string> files;  // hash of the bytes, by file name
    };
    void read();

    std::string folder_;
    std::map<std::string, Entry> entries_;  // by the figure's name
};

/// The program's folder scenes/: installed with it, or in the source tree that it was built in. Throws UsageError if
/// there is none.
std::string find_scene_folder();

}  // namespace deburr
