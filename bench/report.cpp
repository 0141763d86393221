#include "bench/report.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "raytracer/util/whole_file.hpp"

namespace deburr::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string words(const Bar& bar) {
    return fmt::format("{} {:g}", bar.is == Bar::Is::at_most ? "<=" : ">=", bar.value);
}

std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

std::string data_name(std::string name) {
    for (char& c : name)
        if (c == ' ') c = '_';
    return name;
}

}  // namespace

std::string machine() {
    return fmt::format("{}, {} processors; compiler {}", processor(), std::thread::hardware_concurrency(), __VERSION__);
}

void Report::begin(const std::string& letter, const std::string& title) {
    sections_.push_back({letter, title, {}, {}, {}});
    fmt::print("\n({}) {}\n", letter, title);
    std::fflush(stdout);
}

void Report::add(Figure figure) {
    const std::string verdict = figure.bar ? fmt::format("{:>9} {}", words(*figure.bar),
                                                         figure.bar->reached(figure.value) ? "reached" : "NOT REACHED")
                                           : "";
    const std::string detail =
        figure.times ? fmt::format("{:.4g} s / {:.4g} s", figure.times->a, figure.times->b) : figure.unit;
    fmt::print("    {:<58}{:>9.4g}  {:<24}{}\n", figure.name, figure.value, detail, verdict);
    std::fflush(stdout);
    sections_.back().figures.push_back(std::move(figure));
}

void Report::ratio(const std::string& name, const Ratio& ratio, std::optional<Bar> bar) {
    add({name, ratio.value(), "", bar, ratio});
}

void Report::figure(const std::string& name, double value, const std::string& unit, std::optional<Bar> bar) {
    add({name, value, unit, bar, std::nullopt});
}

void Report::point(const std::string& curve, const std::string& x_name, const std::string& y_name, double x, double y) {
    std::vector<Curve>& curves = sections_.back().curves;
    auto place = std::find_if(curves.begin(), curves.end(), [&](const Curve& c) { return c.name == curve; });
    if (place == curves.end()) place = curves.insert(place, {curve, x_name, y_name, {}});
    place->points.push_back({x, y});
}

void Report::note(const std::string& text) {
    fmt::print("    ({})\n", text);
    std::fflush(stdout);
    sections_.back().notes.push_back(text);
}

std::string Report::json() const {
    Json j;
    j["machine"] = machine();
    j["times"] = "CPU seconds, medians of repeated runs after a warm-up";
    for (const SectionResult& section : sections_) {
        Json s;
        s["title"] = section.title;
        for (const Figure& f : section.figures) {
            Json row = {{"name", f.name}, {"value", f.value}};
            if (!f.unit.empty()) row["unit"] = f.unit;
            if (f.times) row["seconds"] = {f.times->a, f.times->b};
            if (f.bar) {
                row["bar"] = words(*f.bar);
                row["reached"] = f.bar->reached(f.value);
            }
            s["figures"].push_back(row);
        }
        for (const Curve& c : section.curves) s["curves"][c.name] = {{"x", c.x}, {"y", c.y}, {"points", c.points}};
        if (!section.notes.empty()) s["notes"] = section.notes;
        j["sections"][section.letter] = s;
    }
    return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string Report::markdown() const {
    std::string text = fmt::format("{}.\n\n| | | measured | goal | |\n|---|---|---:|---:|---|\n", machine());
    for (const SectionResult& section : sections_)
        for (const Figure& f : section.figures)
            if (f.bar)
                text += fmt::format("| {} | {} | {:.3g}{} | {} {:g} | {} |\n", section.letter, f.name, f.value,
                                    f.unit.empty() || f.unit.starts_with('(') ? "" : fmt::format(" {}", f.unit),
                                    f.bar->is == Bar::Is::at_most ? "≤" : "≥", f.bar->value,
                                    f.bar->reached(f.value) ? "reached" : "**not reached**");
    return text;
}

void Report::write_plot_data(const std::string& folder) const {
    std::string bars;
    for (const SectionResult& section : sections_) {
        for (const Figure& f : section.figures)
            if (f.bar)
                bars += fmt::format("\"{}   {}\" {:.6g} \"{:.3g}{} ({}{:g})\"\n", f.name, section.letter,
                                    f.bar->margin(f.value), f.value, f.unit == "%" ? " %" : "",
                                    f.bar->is == Bar::Is::at_most ? "≤ " : "≥ ", f.bar->value);
        for (const Curve& c : section.curves) {
            std::string lines = fmt::format("# {} against {}\n", c.y, c.x);
            for (const auto& [x, y] : c.points) lines += fmt::format("{:g} {:g}\n", x, y);
            write_whole_file(fmt::format("{}/{}.dat", folder, data_name(c.name)), lines);
        }
    }
    if (!bars.empty()) write_whole_file(fmt::format("{}/bars.dat", folder), bars);
}

}  // namespace deburr::bench
