#include "figures/figure.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

struct Paper {
    std::string prefix, title;
};

const std::array<Paper, 4>& papers() {
    static const std::array<Paper, 4> all = {
        {{"lobb", "Lobb: Quasi-Convolutional Smoothing of Polyhedra (1996)"},
         {"triage", "Wünsche and Lobb: Polygonization of Quasi-Convolutionally Smoothed Polyhedra (1997)"},
         {"vyatkin", "Vyatkin: Polygonization Method for Functionally Defined Objects (2015)"},
         {"beyond", "Beyond the papers"}}};
    return all;
}

std::string prefix_of(const Figure& figure) { return figure.name.substr(0, figure.name.find('-')); }

std::size_t paper_index(const Figure& figure) {
    std::size_t i = 0;
    while (i < papers().size() && papers()[i].prefix != prefix_of(figure)) ++i;
    return i;
}

// Order of names: numbers by value, and before words: lobb-2, lobb-12, lobb-table-1.
bool name_less(const std::string& a, const std::string& b) {
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        if (digit(a[i]) && digit(b[j])) {
            std::size_t p = i, q = j;
            while (p < a.size() && digit(a[p])) ++p;
            while (q < b.size() && digit(b[q])) ++q;
            const int x = std::stoi(a.substr(i, p - i)), y = std::stoi(b.substr(j, q - j));
            if (x != y) return x < y;
            i = p, j = q;
        } else {
            if (a[i] != b[j]) return a[i] < b[j];
            ++i, ++j;
        }
    }
    return a.size() - i < b.size() - j;
}

std::vector<Figure>& registry() {
    static std::vector<Figure> figures;
    return figures;
}

}  // namespace

RegisteredFigure::RegisteredFigure(Figure figure) {
    assert(paper_index(figure) < papers().size() && figure.make);
    registry().push_back(std::move(figure));
}

const std::vector<Figure>& all_figures() {
    static const std::vector<Figure> sorted = [] {
        std::vector<Figure> figures = registry();
        std::sort(figures.begin(), figures.end(), [](const Figure& a, const Figure& b) {
            const std::size_t p = paper_index(a), q = paper_index(b);
            return p != q ? p < q : name_less(a.name, b.name);
        });
        return figures;
    }();
    return sorted;
}

std::vector<Figure> find_figures(const std::vector<std::string>& words) {
    std::vector<bool> wanted(all_figures().size(), words.empty());
    for (const std::string& word : words) {
        bool found = false;
        for (std::size_t i = 0; i < all_figures().size(); ++i) {
            const Figure& figure = all_figures()[i];
            if (figure.name != word && prefix_of(figure) != word) continue;
            wanted[i] = found = true;
        }
        if (!found)
            throw UsageError(fmt::format(
                "figures: expected the name of a figure or of a paper (see deburr figures --list), got '{}'", word));
    }
    std::vector<Figure> figures;
    for (std::size_t i = 0; i < wanted.size(); ++i)
        if (wanted[i]) figures.push_back(all_figures()[i]);
    return figures;
}

std::string paper_of(const Figure& figure) { return papers()[paper_index(figure)].title; }

}  // namespace deburr
