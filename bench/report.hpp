// What the benchmark found: a table for people, JSON for programs, data for plots.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "raytracer/util/cpu_time.hpp"

namespace deburr::bench {

/// What a figure is to be, and what would be better still.
struct Bar {
    enum class Is { at_most, at_least };
    Is is = Is::at_most;
    double value = 0;

    bool reached(double x) const { return is == Is::at_most ? x <= value : x >= value; }
    /// How many times better than the bar; below 1: not reached.
    double margin(double x) const { return is == Is::at_most ? value / x : x / value; }
};

inline Bar at_most(double value) { return {Bar::Is::at_most, value}; }
inline Bar at_least(double value) { return {Bar::Is::at_least, value}; }

struct Figure {
    std::string name;
    double value = 0;
    std::string unit;  // "" for ratios
    std::optional<Bar> bar;
    std::optional<Ratio> times;  // of a ratio
};

struct Curve {
    std::string name, x, y;  // of the axes
    std::vector<std::pair<double, double>> points;
};

struct SectionResult {
    std::string letter, title;
    std::vector<Figure> figures;
    std::vector<Curve> curves;
    std::vector<std::string> notes;  // what was left out, and why
};

/// Filled by a section while it runs; rows are printed as they come.
class Report {
public:
    void begin(const std::string& letter, const std::string& title);
    void ratio(const std::string& name, const Ratio& ratio, std::optional<Bar> bar = std::nullopt);
    void figure(const std::string& name, double value, const std::string& unit, std::optional<Bar> bar = std::nullopt);
    /// A point of the curve of this name.
    void point(const std::string& curve, const std::string& x_name, const std::string& y_name, double x, double y);
    void note(const std::string& text);

    std::string json() const;
    /// The figures with a bar, as a table for docs/benchmarks.md.
    std::string markdown() const;
    /// FOLDER/CURVE.dat of every curve and FOLDER/bars.dat of every figure with a bar, for gnuplot.
    void write_plot_data(const std::string& folder) const;

private:
    void add(Figure figure);
    std::vector<SectionResult> sections_;
};

/// "AMD EPYC, 2 processors; g++ 12.2".
std::string machine();

}  // namespace deburr::bench
