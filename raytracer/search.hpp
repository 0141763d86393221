// How the implicit road finds roots.
#pragma once

namespace deburr {

/// Which densities' roots are searched for by the bounds M, L and G.
enum class Search {
    where_needed,  // those that are neither products of half-spaces nor sums of few
    always         // of more than one half-space; for measuring the search itself
};

}  // namespace deburr
