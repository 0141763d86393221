// Asks admesh, a program that repairs STL files, what it finds to repair.
#pragma once
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace deburr {

inline bool has_admesh() { return std::system("command -v admesh >/dev/null 2>&1") == 0; }

/// The lines of admesh's report on the file `stl` that count something other than 0; "" if the file is fine. The report
/// is written to the file `log`. Throws std::runtime_error if admesh fails or its report has other lines than expected.
inline std::string admesh_repairs(const std::string& stl, const std::string& log) {
    if (std::system(("admesh '" + stl + "' >'" + log + "' 2>&1").c_str()) != 0)
        throw std::runtime_error("admesh failed on " + stl);
    std::ifstream in(log);
    std::string repairs, line;
    int counts = 0;
    while (std::getline(in, line))
        for (const char* what :
             {"Facets with 1 disconnected", "Facets with 2 disconnected", "Facets with 3 disconnected",
              "Total disconnected", "Degenerate facets", "Edges fixed", "Facets removed", "Facets added",
              "Facets reversed", "Backwards edges", "Normals fixed"}) {
            if (line.rfind(what, 0) != 0) continue;
            ++counts;
            std::istringstream numbers(line.substr(line.find(':') + 1));
            for (long n; numbers >> n;)
                if (n != 0) repairs += line + "\n";
        }
    if (counts != 11) throw std::runtime_error("admesh's report has other lines than those of 0.98.4");
    return repairs;
}

}  // namespace deburr
