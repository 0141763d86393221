// Measures the ratio of two pieces of work in CPU time. They run in alternation within one process, so that noise of
// the machine affects both alike.
#pragma once
#include <algorithm>
#include <ctime>
#include <vector>

namespace deburr {

/// CPU seconds that this process has used, all threads together.
inline double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

/// CPU seconds that a call of `work` takes.
template <class Work>
double cpu_seconds_of(Work&& work) {
    const double start = cpu_seconds();
    work();
    return cpu_seconds() - start;
}

/// The median (the upper one of two); `values` must not be empty.
inline double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
    return values[values.size() / 2];
}

/// Two median times, and their quotient.
struct Ratio {
    double a = 0, b = 0;  // median seconds

    double value() const { return a / b; }
};

/// The median times of `a` and `b`, each of which returns the seconds it took: one warm-up each, then `rounds` calls of
/// both in alternation.
template <class A, class B>
Ratio ratio_of_times(A&& a, B&& b, int rounds) {
    a();
    b();
    std::vector<double> times_a, times_b;
    for (int i = 0; i < rounds; ++i) {
        times_a.push_back(a());
        times_b.push_back(b());
    }
    return {median(times_a), median(times_b)};
}

/// ratio_of_times() where the times are this process's CPU time.
template <class A, class B>
Ratio ratio_of(A&& a, B&& b, int rounds = 5) {
    return ratio_of_times([&] { return cpu_seconds_of(a); }, [&] { return cpu_seconds_of(b); }, rounds);
}

/// The median CPU seconds of `rounds` calls, after a warm-up.
template <class Work>
double seconds_of(Work&& work, int rounds = 5) {
    work();
    std::vector<double> times;
    for (int i = 0; i < rounds; ++i) times.push_back(cpu_seconds_of(work));
    return median(times);
}

/// Keeps the compiler from optimizing away the computation of `value`.
template <class T>
void keep(const T& value) {
    asm volatile("" : : "g"(&value) : "memory");
}

}  // namespace deburr
