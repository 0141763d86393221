// Runs a scene's Lua text with bounded memory and work.
//
// A run that spends its budget is abandoned, not interrupted by a Lua error: control jumps out of
// the interpreter to run(), nothing of the state is entered again, and its memory goes back as a
// whole. So there is nothing that pcall, xpcall, coroutines, __close or error handlers could catch
// or prolong. Finalizers, which Lua runs with hooks off, are refused where they would be set.
//
// Work inside a single call of a library function is charged to the budget before it is done, and
// allocation by the byte. Not promised: the exact line at which memory ran out; it is the line of
// the latest sample.
//
// The interpreter is compiled as C: its errors are longjmp. A function registered in prepare() must
// therefore hold no object with a destructor when it calls anything of Lua that can raise.
#pragma once
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

struct lua_State;

namespace deburr {

/// what() is one line that starts with the file's name and, where known, the line.
class SceneError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct SandboxLimits {
    std::size_t memory = std::size_t(256) << 20;  // bytes
    std::int64_t work = 250'000'000;              // instructions, and what costs about as much
    double seconds = 20.0;                        // by the clock, whatever the work
};

class Sandbox {
public:
    /// Called with the state ready and the library open. May raise Lua errors.
    using Prepare = void (*)(lua_State*);

    /// `host` is for the functions that prepare() registers; see host(lua_State*).
    explicit Sandbox(SandboxLimits limits = {}, void* host = nullptr);
    ~Sandbox();
    Sandbox(const Sandbox&) = delete;
    Sandbox& operator=(const Sandbox&) = delete;

    /// Runs `text`, named `file` in messages, once; its first result is at index 1 of the state
    /// that is returned, and may be read with functions of Lua that neither raise nor allocate.
    /// Throws SceneError.
    lua_State* run(const std::string& text, const std::string& file, Prepare prepare = nullptr);

    /// Instructions between two looks at the budget, in each coroutine by itself. A shorter
    /// interval costs little more: any count hook makes a loop of additions take 2.2 times as long.
    static constexpr int sample_interval = 1000;

    static void* host(lua_State* lua);
    /// Charges work to the budget; does not return if that is spent. Call it with no object with a
    /// destructor on the stack.
    static void spend(lua_State* lua, std::int64_t work);

    /// Functions that hold objects with destructors call this first with false, and with true when
    /// they are gone: in between, allocation by Lua fails instead of abandoning the run.
    static void allow_abandoning(lua_State* lua, bool allowed);

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Stands for the file's name in messages and positions inside the interpreter, which would cut
/// long names.
constexpr char file_mark = '\1';

/// Line of the scene that is being executed; 0 if there is none.
int current_line(lua_State* lua);

/// One printable line: marks become the file's name, and that goes first if it is not there.
std::string one_line(const std::string& message, const std::string& file);

}  // namespace deburr
