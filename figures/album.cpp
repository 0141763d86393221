#include "figures/album.hpp"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "figures/page.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Increased when the meaning of the record changes.
constexpr int format_version = 1;
constexpr const char* memory_name = "figures.json";

std::optional<std::string> contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file || (file.peek(), file.bad())) return std::nullopt;
    std::ostringstream out;
    out << file.rdbuf();
    return out.str();
}

// FNV-1a: detects changes, not forgery.
std::string hash_of(const std::string& bytes) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    return fmt::format("{:016x}", hash);
}

Json json_of(const FigureItem& i) {
    if (i.file.empty()) return {{"head", i.table.head}, {"rows", i.table.rows}};
    return {{"file", i.file}, {"others", i.others}, {"caption", i.caption}, {"width", i.width}};
}

FigureItem item_of(const Json& j) {
    FigureItem i;
    if (!j.contains("file")) {
        i.table.head = j.at("head").get<std::vector<std::string>>();
        i.table.rows = j.at("rows").get<std::vector<std::vector<std::string>>>();
        return i;
    }
    i.file = j.at("file");
    i.others = j.at("others").get<std::vector<std::string>>();
    i.caption = j.at("caption");
    i.width = j.at("width");
    return i;
}

}  // namespace

std::string program_fingerprint() {
    const auto bytes = contents("/proc/self/exe");
    if (!bytes) throw WorkError("cannot read the program's own file");
    return hash_of(*bytes);
}

std::string fingerprint(const Figure& figure, const std::string& program, const std::string& scene_folder, bool draft) {
    std::string all = program + (draft ? " draft" : " full");
    for (const std::string& name : figure.scenes) {
        const fs::path path = fs::path(scene_folder) / name;
        const auto bytes = contents(path);
        if (!bytes) throw UsageError(fmt::format("{}: cannot read its scene '{}'", figure.name, path.string()));
        all += " " + name + " " + hash_of(*bytes);
    }
    return hash_of(all);
}

Album::Album(std::string folder) : folder_(std::move(folder)) {
    try {
        read();
    } catch (const Json::exception&) {
        entries_.clear();
    }
}

void Album::read() {
    const auto text = contents(fs::path(folder_) / memory_name);
    if (!text) return;
    const Json all = Json::parse(*text);
    if (all.at("version") != format_version) return;
    for (const auto& [name, j] : all.at("figures").items()) {
        Entry entry;
        entry.fingerprint = j.at("fingerprint");
        entry.result.columns = j.at("columns");
        entry.result.measured = j.at("measured").get<std::vector<std::string>>();
        for (const Json& item : j.at("items")) entry.result.items.push_back(item_of(item));
        entry.files = j.at("files").get<std::map<std::string, std::string>>();
        entries_.emplace(name, std::move(entry));
    }
}

bool Album::has(const Figure& figure, const std::string& fingerprint) const {
    const auto entry = entries_.find(figure.name);
    if (entry == entries_.end() || entry->second.fingerprint != fingerprint) return false;
    for (const auto& [name, hash] : entry->second.files) {
        const auto bytes = contents(fs::path(folder_) / name);
        if (!bytes || hash_of(*bytes) != hash) return false;
    }
    return true;
}

void Album::add(const Figure& figure, const std::string& fingerprint, const FigureResult& result,
                const std::string& scene_folder) {
    Entry entry{fingerprint, result, {}};
    for (const FigureItem& item : result.items) {
        std::vector<std::string> names = item.others;
        if (!item.file.empty()) names.push_back(item.file);
        for (const std::string& name : names) {
            const auto bytes = contents(fs::path(folder_) / name);
            if (!bytes) throw WorkError(fmt::format("cannot read '{}'", (fs::path(folder_) / name).string()));
            entry.files[name] = hash_of(*bytes);
        }
    }
    entries_[figure.name] = std::move(entry);
    write(scene_folder);
}

void Album::write(const std::string& scene_folder) const {
    Json all;
    all["version"] = format_version;
    all["figures"] = Json::object();
    std::vector<ShownFigure> shown;
    for (const Figure& figure : all_figures()) {  // figures that no longer exist are dropped
        const auto found = entries_.find(figure.name);
        if (found == entries_.end()) continue;
        const Entry& entry = found->second;
        Json& j = all["figures"][figure.name];
        j["fingerprint"] = entry.fingerprint;
        j["columns"] = entry.result.columns;
        j["measured"] = entry.result.measured;
        j["items"] = Json::array();
        for (const FigureItem& item : entry.result.items) j["items"].push_back(json_of(item));
        j["files"] = entry.files;
        shown.push_back({&figure, &entry.result});
    }
    const fs::path folder(folder_);
    write_whole_file((folder / memory_name).string(), all.dump(1) + "\n");
    write_whole_file((folder / "README.md").string(), page_of(shown, folder_, scene_folder));
}

std::string find_scene_folder() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const auto holds_scenes = [](const fs::path& folder) { return fs::exists(folder / "csg_examples.lua"); };
    // Installed: PREFIX/bin/deburr and PREFIX/share/deburr/scenes. Built: anywhere in the source tree.
    const fs::path installed = program.parent_path().parent_path() / DEBURR_DATA_FOLDER / "scenes";
    if (holds_scenes(installed)) return installed.string();
    for (fs::path folder = program.parent_path(); !folder.empty(); folder = folder.parent_path()) {
        if (holds_scenes(folder / "scenes")) return (folder / "scenes").string();
        if (folder == folder.root_path()) break;
    }
    throw UsageError(
        fmt::format("figures: expected the folder scenes beside '{}' or above it (see --scenes)", program.string()));
}

}  // namespace deburr
