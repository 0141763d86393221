// `deburr help NAME …`: explains a command, or a name of the scene language.
//
// Hidden options write the documents that the build installs and that docs/cli.md contains.
#include <fmt/format.h>

#include <memory>

#include "raytracer/cli/command_documents.hpp"
#include "raytracer/cli/commands.hpp"
#include "raytracer/cli/scene_page.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/nearest_name.hpp"

namespace deburr {
namespace {

struct HelpOptions {
    std::vector<std::string> names;
    std::string markdown, completion;
    bool man = false;
};

// The topics of the scene language with their entries.
std::string contents(const std::vector<PagePart>& parts) {
    std::string text, line;
    for (const PagePart& part : parts) {
        if (part.level == 1) continue;
        if (part.level == 2) {
            text += line;
            line = fmt::format("  {:<12}", part.names.front());
        } else {
            line += " " + part.names.front();
        }
        if (&part == &parts.back() || (&part)[1].level == 2) line += "\n";
    }
    return text + line;
}

const CLI::App* find_command(const CLI::App& program, const std::string& name) {
    for (const CLI::App* command : commands_of(program))
        if (command->get_name() == name) return command;
    return nullptr;
}

std::vector<std::string> all_names(const CLI::App& program, const std::vector<PagePart>& parts) {
    std::vector<std::string> names;
    for (const CLI::App* command : commands_of(program)) names.push_back(command->get_name());
    for (const PagePart& part : parts) names.insert(names.end(), part.names.begin(), part.names.end());
    for (const std::string& name : row_names(parts)) names.push_back(name);
    return names;
}

std::string help_on(const CLI::App& program, const std::vector<PagePart>& parts, const std::string& name) {
    if (const CLI::App* command = find_command(program, name)) return command->help("deburr");
    std::string text;
    for (const PagePart& part : find_parts(parts, name)) text += (text.empty() ? "" : "\n") + plain_text(part);
    if (text.empty())
        throw UsageError(
            fmt::format("help: expected a command or a name of the scene language, got '{}'{} (see deburr "
                        "help)",
                        name, suggestion(name, all_names(program, parts))));
    return text;
}

int run_help(const CLI::App& program, const HelpOptions& o) {
    if (!o.markdown.empty()) {
        const CLI::App* command = find_command(program, o.markdown);
        if (!command) throw UsageError(fmt::format("--markdown: expected a command, got '{}'", o.markdown));
        fmt::print("{}", markdown_options(*command));
        return 0;
    }
    if (!o.completion.empty()) {
        const std::string script = completion_script(program, o.completion);
        if (script.empty())
            throw UsageError(fmt::format("--completion: expected bash, zsh or fish, got '{}'", o.completion));
        fmt::print("{}", script);
        return 0;
    }
    if (o.man) {
        fmt::print("{}", man_page(program));
        return 0;
    }
    const std::vector<PagePart> parts = parts_of_page(scene_page());
    if (o.names.empty()) {
        // App::help() would print the help of the parsed subcommand.
        const std::string help = program.get_formatter()->make_help(&program, "deburr", CLI::AppFormatMode::Normal);
        fmt::print("{}\nThe scene language, deburr help TOPIC or NAME:\n{}", help, contents(parts));
        return 0;
    }
    std::string text;
    for (const std::string& name : o.names) text += (text.empty() ? "" : "\n") + help_on(program, parts, name);
    fmt::print("{}", text);
    return 0;
}

}  // namespace

Command add_help_command(CLI::App& program) {
    CLI::App* command = add_command(program, "help", "explain a command, or a name of the scene language");
    const auto options = std::make_shared<HelpOptions>();
    command
        ->add_option("NAME", options->names,
                     "a command, a topic (scene, material, light …), or any function, field or operator of a scene")
        ->type_name("");
    command->add_option("--markdown", options->markdown, "write a command's options for docs/cli.md")
        ->type_name("COMMAND")
        ->group("");
    command->add_flag("--man", options->man, "write the manual page")->group("");
    command->add_option("--completion", options->completion, "write a shell's completion script")
        ->type_name("bash|zsh|fish")
        ->group("");
    return {command, [&program, options] { return run_help(program, *options); }};
}

}  // namespace deburr
