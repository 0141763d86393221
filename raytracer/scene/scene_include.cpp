// include("part.lua"): runs another file of the scene's folder in the same interpreter, under the same limits.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <lua.hpp>

#include "raytracer/scene/lua_replacements.hpp"
#include "raytracer/scene/lua_sandbox.hpp"
#include "raytracer/scene/name_hints.hpp"
#include "raytracer/scene/scene_functions.hpp"
#include "raytracer/scene/scene_text.hpp"

namespace deburr {

const SceneBuilder::Part& SceneBuilder::part(const std::string& name) {
    namespace fs = std::filesystem;
    const std::string path = files_.path_of(name);
    std::error_code none;
    if (!fs::is_regular_file(path, none)) throw std::runtime_error(fmt::format("expected a file, got '{}'", name));
    const auto [at, is_new] = parts_.try_emplace(fs::canonical(path, none).string());
    Part& part = at->second;
    if (!is_new) return part;
    const std::string text = scene_text(text_of_file(path), path);
    part_text_bytes_ += text.size();
    if (part_text_bytes_ > largest_file)
        throw std::runtime_error(
            fmt::format("expected files of at most {} MiB together, got more", largest_file >> 20));
    part.text = with_length_by_content(text);
    memory->take(block_bytes(part.text.size()));
    part.lines_before = sources->add(path, line_count(text));
    part.name = name;
    files_read_.push_back(path);
    return part;
}

namespace {

SceneResult find_part(SceneCall& call) {
    call.at_most(1);
    call.builder.latest_part = nullptr;
    const SceneBuilder::Part& part = call.builder.part(text(call.argument(0), call.name));
    call.builder.latest_part = &part;
    return (long long)(part.lines_before);
}

constexpr SceneFunction find_function{SceneFunction::Kind::global, "include", "", find_part};

// A Lua reader that returns as many newlines as there are lines before the part, then the part, so that line numbers
// fit.
struct PartReader {
    const char* text;
    std::size_t size;
    int lines_before;
};

constexpr int lines_at_once = 256;

const char* read_piece(lua_State* lua, void* data, std::size_t* size) {
    static const std::string ends(lines_at_once, '\n');
    auto* reader = static_cast<PartReader*>(data);
    Sandbox::spend(lua, lines_at_once / 8);
    if (reader->lines_before > 0) {
        *size = std::size_t(std::min(reader->lines_before, lines_at_once));
        reader->lines_before -= int(*size);
        return ends.data();
    }
    *size = reader->size;
    reader->size = 0;
    return *size > 0 ? reader->text : nullptr;
}

}  // namespace

// The registry keeps the result of each part by the number of its first line; for a part that is still running, `true`.
int include_part(lua_State* lua) {
    call_scene_function(lua, find_function);  // pushes the first line's number, which identifies the part
    const SceneBuilder* builder = static_cast<const SceneBuilder*>(host_of(lua));
    const SceneBuilder::Part* part = builder->latest_part;
    const lua_Integer key = lua_tointeger(lua, -1);
    luaL_getsubtable(lua, LUA_REGISTRYINDEX, "deburr.parts");
    const int parts = lua_gettop(lua);
    const int kind = lua_rawgeti(lua, parts, key);
    if (kind == LUA_TBOOLEAN)
        return luaL_error(lua, "include: expected a file that is not being read already, got '%s'", part->name.c_str());
    if (kind == LUA_TTABLE) {
        lua_rawgeti(lua, -1, 1);
        return 1;
    }
    lua_pushboolean(lua, 1);
    lua_rawseti(lua, parts, key);
    PartReader reader{part->text.data(), part->text.size(), part->lines_before};
    const char name[] = {'=', file_mark, 0};
    if (lua_load(lua, read_piece, &reader, name, "t") != LUA_OK) {
        const char* hint = other_language(part->text);
        lua_pushstring(lua, *hint ? hint : instead_of_syntax(lua_tostring(lua, -1)));
        lua_concat(lua, 2);
        return lua_error(lua);
    }
    lua_call(lua, 0, 1);
    lua_createtable(lua, 1, 0);
    lua_pushvalue(lua, -2);
    lua_rawseti(lua, -2, 1);
    lua_rawseti(lua, parts, key);
    return 1;
}

}  // namespace deburr
