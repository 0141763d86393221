#include "raytracer/cli/command_documents.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace deburr {
namespace {

// An option or argument as documents need it.
struct OptionText {
    std::vector<std::string> names;  // such as "-o", "--output"; empty for a positional argument
    std::string argument;            // metavariable of the option or name of the argument; "" for a flag
    std::string help;
    bool optional_argument = false;  // whether a positional argument may be omitted
};

OptionText text_of(const CLI::Option& option) {
    OptionText text;
    for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
    text.help = option.get_description();
    text.optional_argument = text.names.empty();
    if (text.optional_argument)
        text.argument = option.get_name();
    else if (option.get_items_expected_max() > 0)
        text.argument = option.get_type_name();
    return text;
}

std::vector<OptionText> options_of(const CLI::App& command) {
    std::vector<OptionText> options;
    for (const CLI::Option* option : command.get_options())
        if (!option->get_group().empty()) options.push_back(text_of(*option));
    return options;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

// The values that an option takes, from a type such as "exact|lobb"; empty if its type names a kind of value.
std::vector<std::string> choices_of(const OptionText& option) {
    std::vector<std::string> choices;
    if (option.argument.find('|') == std::string::npos) return choices;
    std::string rest = option.argument + "|";
    for (std::size_t end; (end = rest.find('|')) != std::string::npos; rest.erase(0, end + 1))
        choices.push_back(rest.substr(0, end));
    return choices;
}

std::string roff(const std::string& text) { return replaced(replaced(text, "\\", "\\e"), "-", "\\-"); }

std::string roff_option(const OptionText& option) {
    std::string text = ".TP\n";
    if (option.optional_argument) return text + ".I " + roff(option.argument) + "\n" + roff(option.help) + "\n";
    for (std::size_t i = 0; i < option.names.size(); ++i)
        text += fmt::format("{}\\fB{}\\fR", i ? ", " : "", roff(option.names[i]));
    if (!option.argument.empty()) text += " \\fI" + roff(option.argument) + "\\fR";
    return text + "\n" + roff(option.help) + "\n";
}

std::string bash_completion(const CLI::App& program) {
    std::string names, cases;
    for (const CLI::App* command : commands_of(program)) {
        names += (names.empty() ? "" : " ") + command->get_name();
        std::string words, values;
        for (const OptionText& option : options_of(*command)) {
            for (const std::string& name : option.names) words += (words.empty() ? "" : " ") + name;
            if (!choices_of(option).empty())
                values += fmt::format("                {}) words=\"{}\" ;;\n", fmt::join(option.names, "|"),
                                      fmt::join(choices_of(option), " "));
        }
        cases += fmt::format("        {})\n            options=\"{}\"\n", command->get_name(), words);
        if (!values.empty()) cases += "            case $previous in\n" + values + "            esac\n";
        cases += "            ;;\n";
    }
    return fmt::format(R"(# bash completion for deburr. Made by: deburr help --completion bash
_deburr() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} words= options=
    COMPREPLY=()
    if [ "$COMP_CWORD" = 1 ]; then
        COMPREPLY=($(compgen -W "{} --help --version" -- "$word"))
        return
    fi
    case ${{COMP_WORDS[1]}} in
{}    esac
    case $word in
        -*) [ -n "$words" ] || words=$options ;;
    esac
    [ -z "$words" ] || COMPREPLY=($(compgen -W "$words" -- "$word"))
}}
complete -o default -F _deburr deburr
)",
                       names, cases);
}

// Escaped for single quotes in a description of zsh's _arguments.
std::string zsh_text(const std::string& text) {
    std::string safe = replaced(text, "'", "'\\''");
    for (const char* c : {"[", "]", ":"}) safe = replaced(safe, c, std::string("\\") + c);
    return safe;
}

std::string zsh_completion(const CLI::App& program) {
    std::string names, cases;
    for (const CLI::App* command : commands_of(program)) {
        names += fmt::format("        '{}:{}'\n", command->get_name(), zsh_text(command->get_description()));
        cases += fmt::format("        {})\n            _arguments \\\n", command->get_name());
        for (const OptionText& option : options_of(*command)) {
            if (option.optional_argument) continue;
            std::string action;
            if (!option.argument.empty()) {
                const std::vector<std::string> choices = choices_of(option);
                action = fmt::format(":{}:{}", zsh_text(choices.empty() ? option.argument : "value"),
                                     choices.empty() ? "_files" : fmt::format("({})", fmt::join(choices, " ")));
            }
            for (const std::string& name : option.names)
                cases += fmt::format("                '*{}[{}]{}' \\\n", name, zsh_text(option.help), action);
        }
        cases += "                '*:file:_files'\n            ;;\n";
    }
    return fmt::format(R"(#compdef deburr
# zsh completion for deburr. Made by: deburr help --completion zsh
_deburr() {{
    local -a commands=(
{}    )
    if (( CURRENT == 2 )); then
        _describe command commands
        return
    fi
    local command=$words[2]
    shift words
    (( CURRENT-- ))
    case $command in
{}    esac
}}
_deburr "$@"
)",
                       names, cases);
}

std::string fish_completion(const CLI::App& program) {
    const auto quoted = [](const std::string& text) {
        return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
    };
    std::string text = "# fish completion for deburr. Made by: deburr help --completion fish\n";
    for (const CLI::App* command : commands_of(program))
        text += fmt::format("complete -c deburr -n __fish_use_subcommand -f -a {} -d {}\n", command->get_name(),
                            quoted(command->get_description()));
    for (const CLI::App* command : commands_of(program))
        for (const OptionText& option : options_of(*command)) {
            if (option.optional_argument) continue;
            text += fmt::format("complete -c deburr -n '__fish_seen_subcommand_from {}'", command->get_name());
            for (const std::string& name : option.names)
                text += (name.size() == 2 ? " -s " : " -l ") + name.substr(name.size() == 2 ? 1 : 2);
            if (!option.argument.empty()) text += " -r";
            if (!choices_of(option).empty()) text += fmt::format(" -f -a '{}'", fmt::join(choices_of(option), " "));
            text += fmt::format(" -d {}\n", quoted(option.help));
        }
    return text;
}

}  // namespace

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
    std::vector<const CLI::App*> commands = program.get_subcommands([](const CLI::App*) { return true; });
    commands.erase(std::remove_if(commands.begin(), commands.end(),
                                  [](const CLI::App* command) { return command->get_group().empty(); }),
                   commands.end());
    return commands;
}

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const OptionText& option : options_of(command))
        names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

std::string markdown_options(const CLI::App& command) {
    std::string text = "| option | |\n|---|---|\n";
    for (const OptionText& option : options_of(command)) {
        std::string names = fmt::format("{}", fmt::join(option.names, ", "));
        if (!option.argument.empty()) names += (names.empty() ? "" : " ") + option.argument;
        // A bar would end the table's cell even inside code quotes.
        text += fmt::format("| `{}` | {} |\n", replaced(names, "|", "\\|"), replaced(option.help, "|", "\\|"));
    }
    return text;
}

std::string man_page(const CLI::App& program) {
    std::string text = fmt::format(".TH DEBURR 1 \"\" \"deburr {}\" \"User Commands\"\n", DEBURR_VERSION);
    text += ".SH NAME\ndeburr \\- " + roff("CSG ray tracer and mesher that rounds every edge by one number") + "\n";
    text += ".SH SYNOPSIS\n";
    for (const CLI::App* command : commands_of(program))
        text += fmt::format(".B deburr {}\n[\\fIOPTION\\fR]...", roff(command->get_name())) + [&] {
            std::string words;
            for (const OptionText& option : options_of(*command))
                if (option.optional_argument) words += " [\\fI" + roff(option.argument) + "\\fR]";
            return words + "\n.br\n";
        }();
    text +=
        ".SH DESCRIPTION\n"
        "Deburr reads a scene, a model of constructive solid geometry in Lua, rounds its edges by the radius that the\n"
        "scene names, and renders it exactly or writes it as a watertight mesh. Options and files may stand in any\n"
        "order; an output's format follows from its name, and an output appears whole or not at all.\n"
        ".PP\n"
        "The scene language is described by \\fBdeburr help scene\\fR, \\fBdeburr help material\\fR and so on.\n"
        ".SH COMMANDS\n";
    for (const CLI::App* command : commands_of(program)) {
        text += fmt::format(".SS deburr {}\n{}\n", roff(command->get_name()), roff(command->get_description()));
        for (const OptionText& option : options_of(*command)) text += roff_option(option);
    }
    text +=
        ".SH EXIT STATUS\n"
        ".TP\n.B 0\nThe work is done.\n"
        ".TP\n.B 1\nThe work failed, or \\fBcompare\\fR found more than a limit allows.\n"
        ".TP\n.B 2\nThe call or the scene is wrong. Nothing is written.\n"
        ".TP\n.B 3\nThe scene needs something that is not supported.\n"
        ".TP\n.B 130\nThe run was interrupted. A picture is saved as far as it was rendered.\n"
        ".SH ENVIRONMENT\n"
        ".TP\n.B SOURCE_DATE_EPOCH\nThe date that pictures carry, in seconds since 1970. With it two runs write equal\n"
        "bytes.\n";
    return text;
}

std::string completion_script(const CLI::App& program, const std::string& shell) {
    if (shell == "bash") return bash_completion(program);
    if (shell == "zsh") return zsh_completion(program);
    if (shell == "fish") return fish_completion(program);
    return "";
}

}  // namespace deburr
