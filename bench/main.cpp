// deburr_bench [--json FILE] [--markdown FILE] [--plot-data FOLDER] [LETTER …]: runs the benchmarks, and reports which
// limits are met.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>

#include "bench/sections.hpp"
#include "raytracer/util/whole_file.hpp"

using namespace deburr::bench;

namespace {

struct Section {
    const char* letter;
    const char* title;
    void (*run)(Report&);
};

const Section sections[] = {
    {"a", "exact implicit / triage mesh in Embree, one thread", implicit_against_embree},
    {"b", "POV-Ray / Deburr, one thread, 600 x 380 with shadows", deburr_against_povray},
    {"c", "rounded / every radius 0", rounded_against_sharp},
    {"d", "growth of tracing with objects, and with half-spaces in one", growth_of_tracing},
    {"e", "triage against flying edges at half the radius", triage_against_flying_edges},
    {"f", "growth of triage with half-spaces", growth_of_triage},
    {"g", "one thread and two", one_thread_and_two},
    {"h", "work per pixel, the same on every machine", work_per_pixel},
    {"i", "every voxel's test against the octree's", octree_against_every_voxel},
    {"j", "exact rays by Embree's BVH / by the tree of boxes, one thread", embree_against_boxes},
};

int refuse(const std::string& what) {
    fmt::print(stderr, "deburr_bench: {}\n", what);
    return 2;
}

}  // namespace

int main(int argc, char** argv) {
    std::string json, markdown, plot_data, letters;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--json" || word == "--markdown" || word == "--plot-data") {
            if (++i == argc) return refuse(word + ": expected a value, got none");
            (word == "--json" ? json : word == "--markdown" ? markdown : plot_data) = argv[i];
            continue;
        }
        const bool known =
            std::any_of(std::begin(sections), std::end(sections), [&](const Section& s) { return word == s.letter; });
        if (!known) return refuse("expected sections from a to j, got '" + word + "'");
        letters += word;
    }
    try {
        Report report;
        fmt::print("{}\nCPU time, medians of repeated runs in turns after a warm-up\n", machine());
        for (const Section& section : sections) {
            if (!letters.empty() && letters.find(section.letter) == std::string::npos) continue;
            report.begin(section.letter, section.title);
            section.run(report);
        }
        if (!json.empty()) deburr::write_whole_file(json, report.json());
        if (!markdown.empty()) deburr::write_whole_file(markdown, report.markdown());
        if (!plot_data.empty()) report.write_plot_data(plot_data);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "deburr_bench: {}\n", error.what());
        return 1;
    }
}
