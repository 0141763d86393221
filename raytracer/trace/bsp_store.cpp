#include "raytracer/trace/bsp_store.hpp"

namespace deburr {

void BspStore::begin_scene() {
    const std::lock_guard lock(mutex_);
    std::vector<Entry> used;
    for (auto& [key, entry] : entries_)
        if (entry.is_used) used.push_back(std::move(entry));
    entries_.clear();
    canonical_ = std::make_unique<CanonicalSolids>();
    asked_for_.clear();
    for (Entry& entry : used) {
        entry.is_used = false;
        std::string of = key(entry.solids, entry.root_method);
        entries_.insert_or_assign(std::move(of), std::move(entry));
    }
    kept_ = built_ = 0;
}

// The solids' canonical shapes, materials and maps; shapes have numbers that are valid in one scene only.
std::string BspStore::key(const std::vector<Solid>& solids, RootMethod root_method) {
    asked_for_.push_back(solids);
    std::string key;
    const auto append = [&key](const auto& value) { key.append(reinterpret_cast<const char*>(&value), sizeof value); };
    append(root_method);
    for (const Solid& solid : asked_for_.back()) {
        const CanonicalPlacement placed = canonical_->of(solid);
        append(placed.canonical);
        append(placed.material);
        append(placed.map);
    }
    return key;
}

// Whether the entry's BSP is what build_bsp() would return: minima below the solids' own scale have no effect.
bool BspStore::fits(const Entry& entry, double min_scale) {
    const double scale = entry.tree->tolerances.scale;
    return min_scale == entry.min_scale || (entry.min_scale < scale && min_scale < scale);
}

BspTree BspStore::bsp(const std::vector<Solid>& solids, RootMethod root_method, double min_scale) {
    std::string of;
    std::shared_ptr<const BspTree> there;
    {
        const std::lock_guard lock(mutex_);
        of = key(solids, root_method);
        const auto at = entries_.find(of);
        if (at != entries_.end() && fits(at->second, min_scale)) {
            at->second.is_used = true;
            there = at->second.tree;
            ++kept_;
        }
    }
    if (there) return *there;
    there = std::make_shared<const BspTree>(build_bsp(solids, root_method, min_scale));
    const std::lock_guard lock(mutex_);
    ++built_;
    entries_.insert_or_assign(std::move(of), Entry{solids, root_method, min_scale, there});
    return *there;
}

}  // namespace deburr
