// Results of the benchmarks: a table, JSON, and data for plots.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "raytracer/util/cpu_time.hpp"

namespace deburr::bench {

/// A limit that a figure should meet: at most or at least a value.
struct Bar {
    enum class Is { at_most, at_least };
    Is is = Is::at_most;
    double value = 0;

    /// Whether the figure x meets the limit.
    bool reached(double x) const { return is == Is::at_most ? x <= value : x >= value; }
    /// The factor by which x is better than the limit; below 1: not met.
    double margin(double x) const { return is == Is::at_most ? value / x : x / value; }
};

inline Bar at_most(double value) { return {Bar::Is::at_most, value}; }
inline Bar at_least(double value) { return {Bar::Is::at_least, value}; }

/// A measured value.
struct Figure {
    std::string name;
    double value = 0;
    std::string unit;            // "" for ratios
    std::optional<Bar> bar;      // none: only informative
    std::optional<Ratio> times;  // of a ratio: its two times
};

/// A measured curve.
struct Curve {
    std::string name, x, y;  // name of the curve, labels of its axes
    std::vector<std::pair<double, double>> points;
};

/// The results of one section.
struct SectionResult {
    std::string letter, title;
    std::vector<Figure> figures;
    std::vector<Curve> curves;
    std::vector<std::string> notes;  // what was left out, and why
};

/// Collects the results of sections while they run, and prints each row at once.
class Report {
public:
    /// Begins a section; the functions below add to it.
    void begin(const std::string& letter, const std::string& title);
    void ratio(const std::string& name, const Ratio& ratio, std::optional<Bar> bar = std::nullopt);
    void figure(const std::string& name, double value, const std::string& unit, std::optional<Bar> bar = std::nullopt);
    /// Adds a point to the curve of this name.
    void point(const std::string& curve, const std::string& x_name, const std::string& y_name, double x, double y);
    void note(const std::string& text);

    std::string json() const;
    /// The figures with a limit, as a table for docs/benchmarks.md.
    std::string markdown() const;
    /// Writes FOLDER/CURVE.dat for every curve, and FOLDER/bars.dat for every figure with a limit, for gnuplot.
    void write_plot_data(const std::string& folder) const;

private:
    void add(Figure figure);
    std::vector<SectionResult> sections_;
};

/// The machine and the compiler, such as "AMD EPYC, 2 processors; g++ 12.2".
std::string machine();

}  // namespace deburr::bench
