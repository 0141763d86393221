#include "raytracer/scene/lua_sandbox.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <lua.hpp>
#include <mutex>
#include <thread>

#include "raytracer/scene/lua_library.hpp"
#include "raytracer/scene/lua_replacements.hpp"
#include "raytracer/scene/name_hints.hpp"
#include "raytracer/scene/scene_text.hpp"
#include "raytracer/util/printable.hpp"

namespace deburr {

enum class SandboxSpent { nothing, memory, system_memory, work, time, output };

// Precedes every block and links all blocks in a ring, so that an abandoned state can be freed. 16 bytes keep malloc's
// alignment.
struct alignas(16) SandboxBlock {
    SandboxBlock *previous, *next;
};

namespace {

// Bytes allocated (and so written at least once) for one unit of work. Both take about 4 ns: 10⁹
// instructions with the hook took 3.5 s, and fresh memory comes at some 15 GB/s.
constexpr std::size_t bytes_per_work = 64;

// The memory that a block takes, with its header.
std::size_t bytes_of(std::size_t size) { return block_bytes(sizeof(SandboxBlock) + size); }

// Time that a run needs to return once it has noticed that its time is over: a few instructions.
constexpr std::chrono::milliseconds grace(200);

}  // namespace

struct Sandbox::State {
    State(SandboxLimits of_limits, void* of_host) : limits(of_limits), host(of_host), memory(limits.memory) {}

    const SandboxLimits limits;
    void* const host;
    std::string text;
    Prepare prepare = nullptr;

    lua_State* lua = nullptr;
    SandboxBlock blocks{&blocks, &blocks};
    MemoryMeter memory;
    SourceMap sources;
    std::int64_t work = 0;
    std::size_t printed = 0;
    std::atomic<int> line{0};  // of the latest sample
    SandboxSpent spent = SandboxSpent::nothing;
    bool armed = false;  // whether `escape` may be jumped to
    std::jmp_buf escape;

    // Shared by the interpreter's thread and the thread that waits for it.
    std::mutex mutex;
    std::condition_variable ended;
    bool has_ended = false;
    int status = LUA_OK;
    std::mutex visiting;  // held during a HostCall
    std::atomic<bool> time_is_up{false};

    ~State() {
        while (blocks.next != &blocks) {
            SandboxBlock* block = blocks.next;
            blocks.next = block->next;
            std::free(block);
        }
    }

    [[noreturn]] void abandon(SandboxSpent what) {
        spent = what;
        armed = false;
        std::longjmp(escape, 1);
    }

    void heed_time() {
        if (time_is_up.load(std::memory_order_relaxed) && armed) abandon(SandboxSpent::time);
    }

    void charge(std::int64_t amount) {
        heed_time();
        if (amount > limits.work - work) {
            if (armed) abandon(SandboxSpent::work);
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
    SandboxSpent print_line(lua_State* lua, int first, int last) noexcept;
};

void* Sandbox::State::allocate(void* user, void* old, std::size_t old_size, std::size_t size) {
    State& state = *static_cast<State*>(user);
    SandboxBlock* block = old ? static_cast<SandboxBlock*>(old) - 1 : nullptr;
    const std::size_t held = block ? bytes_of(old_size) : 0;  // without a block, old_size is the kind of object
    if (size == 0) {
        if (block) {
            block->previous->next = block->next;
            block->next->previous = block->previous;
            state.memory.give_back(held);
            std::free(block);
        }
        return nullptr;
    }
    constexpr std::size_t largest = PTRDIFF_MAX / 2;  // so that no sum overflows
    const std::size_t needed = bytes_of(std::min(size, largest));
    if (size > largest || (needed > held && !state.memory.try_take(needed - held))) {
        if (state.armed) state.abandon(SandboxSpent::memory);
        return nullptr;
    }
    if (needed > held) {
        state.charge(std::int64_t(size / bytes_per_work));
    }
    SandboxBlock *previous = &state.blocks, *next = state.blocks.next;
    if (block) {
        previous = block->previous;
        next = block->next;
    }
    auto* moved = static_cast<SandboxBlock*>(std::realloc(block, sizeof(SandboxBlock) + size));
    if (!moved) {
        if (needed <= held) return old;  // shrinking must not fail
        if (state.armed) state.abandon(SandboxSpent::system_memory);
        state.memory.give_back(needed - held);
        return nullptr;
    }
    *moved = {previous, next};
    previous->next = next->previous = moved;
    if (needed < held) state.memory.give_back(held - needed);
    return moved + 1;
}

void Sandbox::State::sample(lua_State* lua, lua_Debug* record) {
    State& state = of(lua);
    if (lua_getinfo(lua, "l", record) && record->currentline > 0) state.line = record->currentline;
    state.charge(sample_interval);
}

int Sandbox::State::body(lua_State* lua) {
    const State& state = of(lua);
    open_library(lua);
    if (state.prepare) state.prepare(lua);
    const char name[] = {'=', file_mark, 0};
    if (luaL_loadbufferx(lua, state.text.data(), state.text.size(), name, "t") != LUA_OK) {
        const char* hint = other_language(state.text);
        lua_pushstring(lua, *hint ? hint : instead_of_syntax(lua_tostring(lua, -1)));
        lua_concat(lua, 2);
        return lua_error(lua);
    }
    lua_call(lua, 0, 1);
    return 1;
}

// Adds the line to an uncaught error where it is raised: errors from C and from error(x, 0) have none.
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

// No object with a destructor may live in this function, nor a local variable that changes after setjmp.
int Sandbox::State::execute() {
    if (setjmp(escape)) return LUA_ERRERR;
    armed = true;
    lua = lua_newstate(allocate, this);
    if (!lua) abandon(SandboxSpent::system_memory);
    *static_cast<State**>(lua_getextraspace(lua)) = this;
    lua_sethook(lua, sample, LUA_MASKCOUNT, sample_interval);
    lua_pushcfunction(lua, placed_error);
    lua_pushcfunction(lua, body);
    const int result = lua_pcall(lua, 0, 1, 1);
    lua_remove(lua, 1);
    armed = false;
    return result;
}

// Prints texts on the stack as a line. Returns what was used up by that: output or memory.
SandboxSpent Sandbox::State::print_line(lua_State* caller, int first, int last) noexcept try {
    std::string text_line;
    for (int i = first; i <= last; ++i) {
        std::size_t size = 0;
        const char* value = lua_tolstring(caller, i, &size);
        if (size > limits.output) return SandboxSpent::output;
        if (i > first) text_line += '\t';
        text_line += printable({value, size}, "\n\t");
        if (text_line.size() > limits.output) return SandboxSpent::output;
    }
    text_line += '\n';
    if (text_line.size() > limits.output - printed) return SandboxSpent::output;
    printed += text_line.size();
    if (!limits.mute) std::fwrite(text_line.data(), 1, text_line.size(), stderr);
    return SandboxSpent::nothing;
} catch (const std::bad_alloc&) {
    return SandboxSpent::system_memory;
}

Sandbox::Sandbox(SandboxLimits limits, void* host) : state_(std::make_shared<State>(limits, host)) {}

MemoryMeter& Sandbox::memory() { return state_->memory; }

const SourceMap& Sandbox::sources() const { return state_->sources; }

void Sandbox::spend(lua_State* lua, std::int64_t work) {
    State& state = State::of(lua);
    if (work > state.limits.work - state.work)
        if (const int line = current_line(lua)) state.line = line;
    state.charge(work);
}

void Sandbox::print(lua_State* lua, int first, int last) {
    State& state = State::of(lua);
    state.heed_time();
    const SandboxSpent what = state.print_line(lua, first, last);
    if (what == SandboxSpent::nothing) return;
    if (const int line = current_line(lua)) state.line = line;
    state.abandon(what);
}

HostCall HostCall::enter(lua_State* lua) {
    Sandbox::State& state = Sandbox::State::of(lua);
    state.visiting.lock();
    if (state.time_is_up) {
        state.visiting.unlock();
        state.abandon(SandboxSpent::time);
    }
    state.armed = false;
    return {state.host, &state.memory, &state.sources, state.limits.work - state.work, lua};
}

void HostCall::leave(std::int64_t work, Memory of_visit) const {
    Sandbox::State& state = Sandbox::State::of(lua_);
    state.armed = true;
    state.visiting.unlock();
    Sandbox::spend(lua_, work);
    if (of_visit == Memory::enough) return;
    if (const int line = current_line(lua_)) state.line = line;
    state.abandon(of_visit == Memory::spent ? SandboxSpent::memory : SandboxSpent::system_memory);
}

static std::string reason(const SandboxLimits& limits, SandboxSpent spent) {
    switch (spent) {
        case SandboxSpent::memory:
            return fmt::format("expected a scene that needs at most {} MiB, got one that needs more",
                               limits.memory >> 20);
        case SandboxSpent::time:
            return fmt::format("expected a scene that is ready within {} s, got one that is not", limits.seconds);
        case SandboxSpent::output:
            return fmt::format("expected a scene that prints at most {} bytes, got one that prints more",
                               limits.output);
        default:
            return fmt::format("expected a scene that ends within {} instructions, got one that does not", limits.work);
    }
}

// The message of the error at the top of the stack, whatever its type.
static std::string error_text(lua_State* lua) {
    if (lua_type(lua, -1) != LUA_TSTRING)
        return fmt::format("expected an error with a message, got one with a {} value", luaL_typename(lua, -1));
    std::size_t size = 0;
    const char* text = lua_tolstring(lua, -1, &size);
    return std::string(text, size);
}

std::string Sandbox::memory_reason() const { return reason(state_->limits, SandboxSpent::memory); }

lua_State* Sandbox::run(std::string text, const std::string& file, Prepare prepare) {
    State& state = *state_;
    const auto fail = [&](SandboxSpent spent) {
        const int line = state.line;
        const std::string location = line > 0 ? fmt::format("{}:{}: ", file_mark, line) : std::string();
        return SceneError(one_line(location + reason(state.limits, spent), state.sources));
    };
    state.sources = SourceMap();
    state.sources.add(file, line_count(text));
    text = with_length_by_content(text);
    if (!state.memory.try_take(text.size())) throw fail(SandboxSpent::memory);
    state.text = std::move(text);
    state.prepare = prepare;
    std::thread thread([state = state_] {
        const int status = state->execute();
        const std::lock_guard lock(state->mutex);
        state->status = status;
        state->has_ended = true;
        state->ended.notify_one();
    });
    {
        constexpr double max_seconds = 1e6;  // as much as a clock's count can hold
        const auto ended = [&] { return state.has_ended; };
        std::unique_lock lock(state.mutex);
        if (!state.ended.wait_for(lock, std::chrono::duration<double>(std::min(state.limits.seconds, max_seconds)),
                                  ended)) {
            lock.unlock();
            {
                const std::lock_guard no_visit(state.visiting);
                state.time_is_up = true;
            }
            lock.lock();
            if (!state.ended.wait_for(lock, grace, ended)) {
                thread.detach();
                throw fail(SandboxSpent::time);
            }
        }
    }
    thread.join();
    if (state.spent == SandboxSpent::system_memory || state.status == LUA_ERRMEM) throw std::bad_alloc();
    if (state.spent != SandboxSpent::nothing) throw fail(state.spent);
    if (state.status != LUA_OK) throw SceneError(one_line(error_text(state.lua), state.sources));
    return state.lua;
}

const void* host_of(lua_State* lua) { return Sandbox::State::of(lua).host; }

int current_line(lua_State* lua) {
    lua_Debug record;
    for (int level = 1; lua_getstack(lua, level, &record); ++level)
        if (lua_getinfo(lua, "l", &record) && record.currentline > 0) return record.currentline;
    return 0;
}

}  // namespace deburr
