#include "raytracer/scene/lua_sandbox.hpp"

#include <fmt/format.h>

#include <chrono>
#include <csetjmp>
#include <cstdlib>
#include <lua.hpp>

#include "raytracer/scene/lua_library.hpp"

namespace deburr {
namespace {

using Clock = std::chrono::steady_clock;

// Bytes allocated (and so written at least once) for one unit of work. Both take about 4 ns: 10⁹
// instructions under the hook took 3.5 s, fresh memory comes at some 15 GB/s.
constexpr std::size_t bytes_per_work = 64;

// Before every block: a ring of all blocks, so that an abandoned state can be freed. 16 bytes keep
// malloc's alignment.
struct alignas(16) Block {
    Block *previous, *next;
};

enum class Spent { nothing, memory, work, time };

}  // namespace

struct Sandbox::State {
    SandboxLimits limits;
    void* host = nullptr;
    lua_State* lua = nullptr;
    Block blocks{&blocks, &blocks};
    std::size_t used = 0;
    std::int64_t work = 0;
    Clock::time_point start = Clock::now();
    int line = 0;  // of the latest sample
    Spent spent = Spent::nothing;
    bool armed = false;  // escape may be jumped to
    std::jmp_buf escape;

    ~State() {
        while (blocks.next != &blocks) {
            Block* block = blocks.next;
            blocks.next = block->next;
            std::free(block);
        }
    }

    [[noreturn]] void abandon(Spent what) {
        spent = what;
        armed = false;
        std::longjmp(escape, 1);
    }

    void charge(std::int64_t amount) {
        if (amount > limits.work - work) {
            if (armed) abandon(Spent::work);
            work = limits.work;
        } else {
            work += amount;
        }
    }

    static State& of(lua_State* lua) { return **static_cast<State**>(lua_getextraspace(lua)); }
    static void* allocate(void* state, void* old, std::size_t old_size, std::size_t size);
    static void sample(lua_State* lua, lua_Debug* record);
    static int body(lua_State* lua);
    static int placed_error(lua_State* lua);
    int execute();

    // What body() runs; plain, for they are read across jumps.
    const char* text = nullptr;
    std::size_t text_size = 0;
    Prepare prepare = nullptr;
};

void* Sandbox::State::allocate(void* user, void* old, std::size_t old_size, std::size_t size) {
    State& state = *static_cast<State*>(user);
    if (!old) old_size = 0;  // then it tells the kind of object
    Block* block = old ? static_cast<Block*>(old) - 1 : nullptr;
    if (size == 0) {
        if (block) {
            block->previous->next = block->next;
            block->next->previous = block->previous;
            state.used -= old_size;
            std::free(block);
        }
        return nullptr;
    }
    if (size > old_size) {
        if (size - old_size > state.limits.memory - state.used) {
            if (state.armed) state.abandon(Spent::memory);
            return nullptr;
        }
        state.charge(std::int64_t(size / bytes_per_work));
    }
    Block *previous = &state.blocks, *next = state.blocks.next;
    if (block) {
        previous = block->previous;
        next = block->next;
    }
    auto* moved = static_cast<Block*>(std::realloc(block, sizeof(Block) + size));
    if (!moved) {
        if (size <= old_size) return old;  // shrinking must not fail
        if (state.armed) state.abandon(Spent::memory);
        return nullptr;
    }
    *moved = {previous, next};
    previous->next = next->previous = moved;
    state.used = state.used - old_size + size;
    return moved + 1;
}

void Sandbox::State::sample(lua_State* lua, lua_Debug* record) {
    State& state = of(lua);
    if (lua_getinfo(lua, "l", record) && record->currentline > 0) state.line = record->currentline;
    state.charge(sample_interval);
    const std::chrono::duration<double> elapsed = Clock::now() - state.start;
    if (elapsed.count() > state.limits.seconds && state.armed) state.abandon(Spent::time);
}

int Sandbox::State::body(lua_State* lua) {
    const State& state = of(lua);
    open_library(lua);
    if (state.prepare) state.prepare(lua);
    const char name[] = {'=', file_mark, 0};
    if (luaL_loadbufferx(lua, state.text, state.text_size, name, "t") != LUA_OK) return lua_error(lua);
    lua_call(lua, 0, 1);
    return 1;
}

// Handles an uncaught error where it is raised: those from C and from error(x, 0) have no line.
int Sandbox::State::placed_error(lua_State* lua) {
    const bool is_text = lua_type(lua, 1) == LUA_TSTRING;
    const int line = current_line(lua);
    if (line == 0 || (is_text && *lua_tostring(lua, 1) == file_mark)) return 1;
    if (is_text || lua_type(lua, 1) == LUA_TNUMBER)
        lua_pushfstring(lua, "%c:%d: %s", file_mark, line, lua_tostring(lua, 1));
    else
        lua_pushfstring(lua, "%c:%d: expected an error with a message, got one with a %s value", file_mark, line,
                        luaL_typename(lua, 1));
    return 1;
}

// No object with a destructor may live in this function, nor a local that changes after setjmp.
int Sandbox::State::execute() {
    if (setjmp(escape)) return LUA_ERRERR;
    armed = true;
    lua = lua_newstate(allocate, this);
    if (!lua) abandon(Spent::memory);
    *static_cast<State**>(lua_getextraspace(lua)) = this;
    lua_sethook(lua, sample, LUA_MASKCOUNT, sample_interval);
    lua_pushcfunction(lua, placed_error);
    lua_pushcfunction(lua, body);
    const int status = lua_pcall(lua, 0, 1, 1);
    lua_remove(lua, 1);
    armed = false;
    return status;
}

Sandbox::Sandbox(SandboxLimits limits, void* host) : state_(std::make_unique<State>()) {
    state_->limits = limits;
    state_->host = host;
}

Sandbox::~Sandbox() = default;

void* Sandbox::host(lua_State* lua) { return State::of(lua).host; }
void Sandbox::spend(lua_State* lua, std::int64_t work) {
    State& state = State::of(lua);
    if (work > state.limits.work - state.work)
        if (const int line = current_line(lua)) state.line = line;
    state.charge(work);
}
void Sandbox::allow_abandoning(lua_State* lua, bool allowed) { State::of(lua).armed = allowed; }

static std::string reason(const SandboxLimits& limits, Spent spent) {
    switch (spent) {
        case Spent::memory:
            return fmt::format("expected a scene that needs at most {} MiB, got one that needs more",
                               limits.memory >> 20);
        case Spent::time:
            return fmt::format("expected a scene that is ready within {} s, got one that is not", limits.seconds);
        default:
            return fmt::format("expected a scene that ends within {} instructions, got one that does not", limits.work);
    }
}

// The error at the top of the stack, whatever its type.
static std::string error_text(lua_State* lua) {
    if (lua_type(lua, -1) != LUA_TSTRING)
        return fmt::format("expected an error with a message, got one with a {} value", luaL_typename(lua, -1));
    std::size_t size = 0;
    const char* text = lua_tolstring(lua, -1, &size);
    return std::string(text, size);
}

lua_State* Sandbox::run(const std::string& text, const std::string& file, Prepare prepare) {
    state_->text = text.data();
    state_->text_size = text.size();
    state_->prepare = prepare;
    const int status = state_->execute();
    if (state_->spent != Spent::nothing) {
        const std::string place = state_->line > 0 ? fmt::format("{}:{}: ", file_mark, state_->line) : std::string();
        throw SceneError(one_line(place + reason(state_->limits, state_->spent), file));
    }
    if (status != LUA_OK) throw SceneError(one_line(error_text(state_->lua), file));
    return state_->lua;
}

int current_line(lua_State* lua) {
    lua_Debug record;
    for (int level = 1; lua_getstack(lua, level, &record); ++level)
        if (lua_getinfo(lua, "l", &record) && record.currentline > 0) return record.currentline;
    return 0;
}

std::string one_line(const std::string& message, const std::string& file) {
    constexpr std::size_t longest = 600;
    std::string line;
    const char mark[] = {file_mark, ':', 0};
    if (message.compare(0, 2, mark) != 0) line = file + ": ";
    for (std::size_t i = 0; i < message.size(); ++i) {
        if (message.compare(i, 2, mark) == 0)
            line += file;
        else if (static_cast<unsigned char>(message[i]) < ' ' || message[i] == 127)
            line += ' ';
        else
            line += message[i];
        if (line.size() > file.size() + longest) return line + " …";
    }
    return line;
}

}  // namespace deburr
