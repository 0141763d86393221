// Ranges of a local density and of its rate of change, over boxes and other regions.
#include <algorithm>

#include "bounds/local_density.hpp"
#include "bounds/thread_memory.hpp"

namespace deburr {

Range LocalDensity::range(const Box& box) const {
    if (field_) {
        const Range f = field_->range(box);
        return {f.lo + 0.5, f.hi + 0.5};
    }
    if (convolution_) return convolution_->range(box);
    return range_from([&](int i) { return density_range(half_spaces_[i], box); });
}

Range LocalDensity::range(std::span<const Range> half_spaces) const {
    if (field_) return {0, 1};
    if (convolution_) return convolution_->range({half_spaces.begin(), half_spaces.end()});
    return range_from([&](int i) { return half_spaces[i]; });
}

template <class OfHalfSpace>
Range LocalDensity::range_from(OfHalfSpace leaf) const {
    Range* const done = memory_for<Range>(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Node& n = nodes_[i];
        const auto at = [&](int child) { return done[child]; };
        switch (n.step) {
            case Step::constant: done[i] = {n.value, n.value}; break;
            case Step::half_space: done[i] = leaf(n.a); break;
            case Step::sum: done[i] = combine(Op::sum, at(n.a), at(n.b)); break;
            case Step::difference: done[i] = combine(Op::difference, at(n.a), at(n.b)); break;
            case Step::complement: done[i] = combine(Op::complement, at(n.a), {}); break;
            case Step::product: done[i] = combine(Op::product, at(n.a), at(n.b)); break;
            case Step::decision: {
                const int* thresholds = &children_[n.a];
                const int* children = thresholds + n.b;
                Range all = at(children[n.b]), least = all;  // range of the sum; hull of the children's ranges
                for (int j = 0; j < n.b; ++j) {
                    const Range f = leaf(thresholds[j]), c = at(children[j]), next = at(children[j + 1]);
                    const double lo = c.lo - next.lo, hi = c.hi - next.hi;
                    all.lo += lo * (lo > 0 ? f.lo : f.hi);
                    all.hi += hi * (hi > 0 ? f.hi : f.lo);
                    least = {std::min(least.lo, c.lo), std::max(least.hi, c.hi)};
                }
                done[i] = {std::max(all.lo, least.lo), std::min(all.hi, least.hi)};
                break;
            }
        }
    }
    return done[nodes_.size() - 1];
}

namespace {

Range sum(Range a, Range b) { return {a.lo + b.lo, a.hi + b.hi}; }
Range difference(Range a, Range b) { return {a.lo - b.hi, a.hi - b.lo}; }
Range hull(Range a, Range b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }

Range overlap(Range a, Range b) { return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)}; }

struct RangeRate {
    Range value, rate;
};

}  // namespace

Range LocalDensity::rate_range(std::span<const Range> half_spaces, std::span<const Range> rates) const {
    if (field_) return {-infinity, infinity};
    if (convolution_) {
        Range all;
        for (std::size_t i = 0; i < rates.size(); ++i) {
            const int polarity = convolution_->polarity(i);
            if ((polarity >= 0 && rates[i].hi > 0) || (polarity <= 0 && rates[i].lo < 0)) all.hi = infinity;
            if ((polarity >= 0 && rates[i].lo < 0) || (polarity <= 0 && rates[i].hi > 0)) all.lo = -infinity;
        }
        return all;
    }
    RangeRate* const done = memory_for<RangeRate>(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Node& n = nodes_[i];
        const auto at = [&](int child) -> const RangeRate& { return done[child]; };
        switch (n.step) {
            case Step::constant: done[i] = {{n.value, n.value}, {0, 0}}; break;
            case Step::half_space: done[i] = {half_spaces[n.a], rates[n.a]}; break;
            case Step::sum: done[i] = {sum(at(n.a).value, at(n.b).value), sum(at(n.a).rate, at(n.b).rate)}; break;
            case Step::difference:
                done[i] = {difference(at(n.a).value, at(n.b).value), difference(at(n.a).rate, at(n.b).rate)};
                break;
            case Step::complement:
                done[i] = {difference({1, 1}, at(n.a).value), difference({0, 0}, at(n.a).rate)};
                break;
            case Step::product:
                done[i] = {product(at(n.a).value, at(n.b).value),
                           sum(product(at(n.a).rate, at(n.b).value), product(at(n.a).value, at(n.b).rate))};
                break;
            case Step::decision: {
                const int* thresholds = &children_[n.a];
                const int* children = thresholds + n.b;
                // V and V′ as at the head of ray_density.cpp. They are averages of the children's values and rates, and
                // so lie within the hull of these, too (V′ but for the half-spaces' own rates).
                Range value = at(children[n.b]).value, values = value, own{0, 0};
                Range rate = at(children[n.b]).rate, child_rates = rate;
                for (int j = 0; j < n.b; ++j) {
                    const std::size_t h = std::size_t(thresholds[j]);
                    const RangeRate &c = at(children[j]), &next = at(children[j + 1]);
                    Range step = difference(c.value, next.value);
                    if (polarity_[h] > 0) step.lo = std::max(step.lo, 0.0), step.hi = std::max(step.hi, 0.0);
                    if (polarity_[h] < 0) step.lo = std::min(step.lo, 0.0), step.hi = std::min(step.hi, 0.0);
                    value = sum(value, product(half_spaces[h], step));
                    own = sum(own, product(rates[h], step));
                    rate = sum(rate, product(half_spaces[h], difference(c.rate, next.rate)));
                    values = hull(values, c.value);
                    child_rates = hull(child_rates, c.rate);
                }
                done[i] = {overlap(value, values), sum(own, overlap(rate, child_rates))};
                break;
            }
        }
    }
    return done[nodes_.size() - 1].rate;
}

}  // namespace deburr
