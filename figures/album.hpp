// A folder of finished figures: which are there and what they were made of (figures.json), and the
// page that shows them (README.md).
#pragma once
#include <map>
#include <string>

#include "figures/figure.hpp"

namespace deburr {

/// Of the program's own file: whatever changes in it may change a picture.
std::string program_fingerprint();

/// Of all that a figure is made of: the program, its scenes' bytes and the settings. Throws
/// UsageError for a scene that is not there.
std::string fingerprint(const Figure& figure, const std::string& program, const std::string& scene_folder, bool draft);

class Album {
public:
    /// Reads what is in the folder; a folder that is not there is an empty one. A figures.json that
    /// cannot be understood counts as none.
    explicit Album(std::string folder);

    /// The figure was made with this fingerprint, and its files are as they were written.
    bool has(const Figure& figure, const std::string& fingerprint) const;
    /// Remembers the figure and writes both files. Throws WorkError.
    void add(const Figure& figure, const std::string& fingerprint, const FigureResult& result,
             const std::string& scene_folder);
    /// Writes the page anew, from what is remembered.
    void write(const std::string& scene_folder) const;

    const std::string& folder() const { return folder_; }

private:
    struct Entry {
        std::string fingerprint;
        FigureResult result;
        std::map<std::string, std::string> files;  // hash of the bytes, by name
    };
    void read();

    std::string folder_;
    std::map<std::string, Entry> entries_;  // by the figure's name
};

/// The folder scenes/ that belongs to the program: installed beside it, or of the checkout it was
/// built in. Throws UsageError if there is none.
std::string find_scene_folder();

}  // namespace deburr
