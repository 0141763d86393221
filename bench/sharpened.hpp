// Solids with every radius 0, whatever their scene says of radii.
#pragma once
#include "bounds/solid.hpp"

namespace deburr::bench {

Solid sharpened(const Solid& solid);

}  // namespace deburr::bench
