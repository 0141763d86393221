// BSPs of one scene, kept for the next: where a part of it is as it was, its BSP is not built again.
//
// For a scene that is edited while it is looked at (`deburr view`). Solids are the same if they are equal in form,
// place and material (canonical_solids.hpp), so that a file that is read anew finds what it did not change.
#pragma once
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "bounds/canonical_solids.hpp"
#include "raytracer/trace/bsp_tree.hpp"

namespace deburr {

class BspStore {
public:
    /// Begins a scene: what the last one did not use is forgotten.
    void begin_scene();

    /// What build_bsp() makes of the solids, to the bit. Several threads may ask at a time.
    BspTree bsp(const std::vector<Solid>& solids, RootMethod root_method, double min_scale);

    /// How many of this scene's BSPs were taken over from the last, and how many were built.
    std::size_t kept() const { return kept_; }
    std::size_t built() const { return built_; }

private:
    struct Entry {
        std::vector<Solid> solids;
        RootMethod root_method;
        double min_scale;
        std::shared_ptr<const BspTree> tree;
        bool is_used = true;  // by this scene
    };
    std::string key(const std::vector<Solid>& solids, RootMethod root_method);
    static bool fits(const Entry& entry, double min_scale);

    std::mutex mutex_;
    std::unordered_map<std::string, Entry> entries_;
    std::vector<std::vector<Solid>> asked_for_;  // canonical_ knows them by their addresses
    std::unique_ptr<CanonicalSolids> canonical_ = std::make_unique<CanonicalSolids>();
    std::size_t kept_ = 0, built_ = 0;
};

}  // namespace deburr
