// Ratios of two pieces of work, measured in turns within one run: these survive noisy machines.
#pragma once
#include <algorithm>
#include <ctime>
#include <vector>

namespace deburr {

inline double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

template <class Work>
double cpu_seconds_of(Work&& work) {
    const double start = cpu_seconds();
    work();
    return cpu_seconds() - start;
}

inline double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
    return values[values.size() / 2];
}

struct Ratio {
    double a = 0, b = 0;  // median CPU seconds

    double value() const { return a / b; }
};

/// A warm-up of each, then both in turns.
template <class A, class B>
Ratio ratio_of(A&& a, B&& b, int rounds = 7) {
    a();
    b();
    std::vector<double> times_a, times_b;
    for (int i = 0; i < rounds; ++i) {
        times_a.push_back(cpu_seconds_of(a));
        times_b.push_back(cpu_seconds_of(b));
    }
    return {median(times_a), median(times_b)};
}

}  // namespace deburr
