#include "bounds/density_part.hpp"

#include <algorithm>

namespace deburr {

DensityTree part_below(const DensityTree& tree, int root) {
    std::vector<int> below{root};
    for (std::size_t k = 0; k < below.size(); ++k) {
        const TreeNode& n = tree.nodes[below[k]];
        if (n.op == Op::half_space || n.op == Op::constant) continue;
        below.push_back(n.a);
        if (n.b >= 0) below.push_back(n.b);
    }
    std::sort(below.begin(), below.end());
    const auto new_index = [&](int old) {
        return int(std::lower_bound(below.begin(), below.end(), old) - below.begin());
    };
    DensityTree part;
    part.rounds = tree.rounds;
    for (const int i : below) {
        TreeNode n = tree.nodes[i];
        if (n.op == Op::half_space) {
            part.half_spaces.push_back(tree.half_spaces[n.a]);
            n.a = int(part.half_spaces.size()) - 1;
        } else if (n.op != Op::constant) {
            n.a = new_index(n.a);
            if (n.b >= 0) n.b = new_index(n.b);
        }
        if (n.support >= 0) {
            part.supports.push_back(tree.supports[n.support]);
            n.support = int(part.supports.size()) - 1;
        }
        part.nodes.push_back(n);
    }
    return part;
}

std::vector<int> summands(const DensityTree& tree) {
    std::vector<int> open{tree.root()}, found;
    while (!open.empty()) {
        const int node = open.back();
        open.pop_back();
        const TreeNode& n = tree.nodes[node];
        if (n.op == Op::sum || n.op == Op::disjunction) {
            open.push_back(n.b);
            open.push_back(n.a);
        } else {
            found.push_back(node);
        }
    }
    return found;
}

}  // namespace deburr
