#include "raytracer/cli/command_line.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "bounds/decision_diagram.hpp"
#include "polygonizer/triage/triage.hpp"
#include "raytracer/cli/command_documents.hpp"
#include "raytracer/cli/commands.hpp"
#include "raytracer/render/render_tiles.hpp"
#include "raytracer/scene/scene_reader.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/interrupt.hpp"
#include "raytracer/util/message.hpp"
#include "raytracer/util/nearest_name.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

int fail(int code, const std::string& what) {
    message(what);
    return code;
}

// Opens closed standard files. Otherwise the next file that is opened would take their place, and messages would be
// written to it.
void open_standard_files() {
    for (int descriptor = 0; descriptor < 3; ++descriptor)
        if (fcntl(descriptor, F_GETFD) < 0 && open("/dev/null", O_RDWR) < 0) _exit(1);
}

// The message if a thread cannot start; usually memory for its stack is lacking.
constexpr const char* no_thread = "out of memory, or no further thread may be started";

bool is_no_thread(const std::exception& error) {
    const auto* known = dynamic_cast<const std::system_error*>(&error);
    return known && known->code() == std::errc::resource_unavailable_try_again;
}

// The terminate handler: reports an exception that cannot be propagated, such as one of a library's thread or one that
// cannot be thrown for lack of memory; otherwise the program would abort without a message.
[[noreturn]] void end_with_error() {
    char line[256] = "deburr: out of memory\n";  // used if nothing could be thrown
    constexpr const char* inside = "deburr: an error inside the program: %.200s\n";
    if (const std::exception_ptr error = std::current_exception()) try {
            std::rethrow_exception(error);
        } catch (const std::bad_alloc&) {
        } catch (const std::exception& known) {
            if (is_no_thread(known))
                std::snprintf(line, sizeof line, "deburr: %s\n", no_thread);
            else
                std::snprintf(line, sizeof line, inside, known.what());
        } catch (...) {
            std::snprintf(line, sizeof line, inside, "an exception was not caught");
        }
    [[maybe_unused]] const auto n = write(STDERR_FILENO, line, std::strlen(line));
    remove_unfinished_files();
    _exit(1);
}

// Throws UsageError for the first word that the command did not use, suggesting the nearest of its options or of
// `words`.
void refuse_rest(const CLI::App& app, const std::string& name, const char* kind,
                 const std::vector<std::string>& words = {}) {
    bool options = true;  // until "--", which CLI11 leaves among the rest
    for (const std::string& given : app.remaining()) {
        if (options && given == "--") {
            options = false;
            continue;
        }
        const bool option = options && given.size() > 1 && given[0] == '-';
        const std::string word = option ? given.substr(0, given.find('=')) : given;
        std::string nearest = suggestion(word, option ? option_names(app) : words);
        // Where a command is missing, the first word may be a scene or a model.
        if (!option && !words.empty() && nearest.empty() && word.find('.') != std::string::npos)
            nearest = ", did you mean render " + word + "?";
        throw UsageError(
            fmt::format("{} '{}'{} (see {} --help)", option ? "unknown option" : kind, word, nearest, name));
    }
}

// Turns CLI11's error message into this program's form. The errors contain option and value only in their text, which
// tests check with every supported version: it begins with the option, as in "--size: 1 required WxH missing", or, if a
// flag was given a value, is like "Could not convert: --quiet = foo".
std::string in_our_words(const CLI::ParseError& error) {
    const std::string what = error.what();
    const std::string option = what.substr(0, what.find(':'));
    if (const std::size_t flag = what.find("--"), equals = what.find(" = ");
        dynamic_cast<const CLI::ConversionError*>(&error) && equals < what.size() && flag < equals)
        return fmt::format("{}: expected no value, got '{}'", what.substr(flag, equals - flag),
                           what.substr(equals + 3));
    if (!dynamic_cast<const CLI::ArgumentMismatch*>(&error)) return what;
    if (what.find("missing") != std::string::npos) return option + ": expected a value, got none";
    return option + ": expected once, got it several times";
}

int run(CLI::App& program, const std::vector<Command>& commands, int argc, char** argv) {
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& asked) {  // --help or --version was given
        program.exit(asked);
        return 0;
    } catch (const CLI::ParseError& error) {
        throw UsageError(in_our_words(error));
    }
    for (const Command& command : commands) {
        if (!command.app->parsed()) continue;
        refuse_rest(program, "deburr", "unexpected argument");
        refuse_rest(*command.app, "deburr " + command.app->get_name(), "unexpected argument");
        return command.run();
    }
    std::vector<std::string> names;
    for (const Command& command : commands) names.push_back(command.app->get_name());
    refuse_rest(program, "deburr", "unknown command", names);
    throw UsageError(fmt::format("expected a command: {} (see deburr --help)", fmt::join(names, ", ")));
}

// If threads are still working on abandoned tiles, no object that they use may be destroyed.
int leave(int code) {
    if (!any_tiles_abandoned()) return code;
    std::fflush(nullptr);
    _exit(code);
}

// The allocator reserves 64 MiB of address space for an arena of each thread. Where a limit (`ulimit -v`) leaves no
// room for one, every allocation of the thread asks the system four times in vain: a mesh then takes several times as
// long, and runs out of memory that other arenas have. So there is one arena for each GiB of the limit.
void limit_arenas() {
#ifdef M_ARENA_MAX
    rlimit space{};
    if (getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur == RLIM_INFINITY) return;
    mallopt(M_ARENA_MAX, int(std::clamp<rlim_t>(space.rlim_cur >> 30, 1, 1024)));
#endif
}

int answer(int argc, char** argv, const std::vector<Command (*)(CLI::App&)>& more) {
    limit_arenas();
    std::set_terminate(end_with_error);
    end_on_interrupt();
    open_standard_files();
    signal(SIGXFSZ, SIG_IGN);  // writing a file that grows too large then fails with an error
    try {
        CLI::App program("Deburr renders CSG models with every edge rounded.", "deburr");
        program.set_version_flag("--version", "deburr " DEBURR_VERSION);
        program.footer("deburr help NAME explains a command, or a name of the scene language.");
        program.allow_extras();
        program.require_subcommand(0, 1);  // "help render" names one command, and a scene may be called "mesh"
        std::vector<Command> commands = {add_render_command(program),     add_mesh_command(program),
                                         add_compare_command(program),    add_info_command(program),
                                         add_export_pov_command(program), add_merge_command(program),
                                         add_view_command(program),       add_help_command(program)};
        for (const auto add : more) commands.push_back(add(program));
        for (const Command& command : commands) command.app->allow_extras();
        const int code = run(program, commands, argc, argv);
        if (std::fflush(stdout) != 0 || std::ferror(stdout)) return fail(1, "cannot write to the standard output");
        return code;
    } catch (const Cancelled&) {
        return fail(interrupted_exit_code, "interrupted: nothing is written");
    } catch (const UsageError& error) {
        return fail(2, error.what());
    } catch (const SceneError& error) {
        return fail(2, error.what());
    } catch (const UnsupportedError& error) {
        return fail(3, error.what());
    } catch (const TooEntangled& error) {
        return fail(3, error.what());
    } catch (const TooManyHalfSpaces& error) {
        return fail(3, error.what());
    } catch (const std::bad_alloc&) {
        return fail(1, "out of memory");
    } catch (const std::exception& error) {
        return fail(1, is_no_thread(error) ? no_thread : error.what());
    }
}

}  // namespace

CLI::App* add_command(CLI::App& program, const std::string& name, const std::string& description) {
    return program.add_subcommand(name, description);
}

int run_program(int argc, char** argv, const std::vector<Command (*)(CLI::App&)>& more) {
    return leave(answer(argc, argv, more));
}

}  // namespace deburr
