// Solids without rounding.
#pragma once
#include "bounds/solid.hpp"

namespace deburr::bench {

/// The solid with every radius set to 0.
Solid sharpened(const Solid& solid);

}  // namespace deburr::bench
