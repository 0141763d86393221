#include "figures/command_figures.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>
#include <filesystem>
#include <memory>

#include "figures/album.hpp"
#include "figures/plot.hpp"
#include "raytracer/cli/options.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/message.hpp"
#include "raytracer/util/progress.hpp"

namespace deburr {
namespace {

namespace fs = std::filesystem;

struct FiguresOptions : Options {
    std::vector<std::string> names;
    std::string folder, scenes;
    bool list = false, again = false, draft = false;
};

int list(const std::vector<Figure>& figures) {
    for (const Figure& figure : figures) fmt::print("{:<20}{}\n", figure.name, figure.title);
    return 0;
}

struct Task {
    Figure figure;
    std::string fingerprint;
};

std::vector<Task> what_to_do(const std::vector<Figure>& figures, const Album& album, const std::string& scenes,
                             const FiguresOptions& o) {
    const std::string program = program_fingerprint();
    std::vector<Task> tasks;
    for (const Figure& figure : figures) {
        const std::string print = fingerprint(figure, program, scenes, o.draft);
        if (o.again || !album.has(figure, print)) tasks.push_back({figure, print});
    }
    return tasks;
}

void make_folder(const std::string& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw WorkError(fmt::format("cannot make the folder '{}': {}", folder, error.message()));
}

int run_figures(const FiguresOptions& o) {
    const std::vector<Figure> figures = find_figures(o.names);
    if (o.list) return list(figures);
    if (o.folder.empty()) throw UsageError("figures: expected a folder for the pictures, -o DIR");
    const std::string scenes = o.scenes.empty() ? find_scene_folder() : o.scenes;
    Album album(o.folder);
    const std::vector<Task> tasks = what_to_do(figures, album, scenes, o);
    double work = 0;
    bool plots = false;
    for (const Task& task : tasks) {
        work += task.figure.seconds;
        plots |= task.figure.plots;
    }
    if (plots) require_gnuplot();
    make_folder(o.folder);
    if (tasks.empty()) {
        album.write(scenes);
        if (!o.quiet) message(fmt::format("nothing to make: '{}' has what was asked for, unchanged", o.folder));
        return 0;
    }

    const int threads = o.threads.value_or(tbb::info::default_concurrency());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    Progress progress(work, Progress::standard_error(o.quiet));
    const auto say = [&](const std::string& line) {
        progress.stop();
        message(line);
    };
    int code = 0;
    for (const Task& task : tasks) {
        const auto start = std::chrono::steady_clock::now();
        try {
            FigureContext context(task.figure, scenes, o.folder, o.draft);
            task.figure.make(context);
            album.add(task.figure, task.fingerprint, context.result(), scenes);
        } catch (const std::exception& error) {  // the other figures can still be made
            say(fmt::format("{}: {}", task.figure.name, error.what()));
            code = 1;
        }
        if (o.verbose && !o.quiet)
            say(fmt::format("{} in {:.1f} s", task.figure.name,
                            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()));
        progress.advance(task.figure.seconds);
    }
    if (code == 0)
        progress.finish();
    else
        progress.stop();
    return code;
}

}  // namespace

Command add_figures_command(CLI::App& program) {
    CLI::App* command =
        add_command(program, "figures", "make the papers' figures and tables, with a page that shows them");
    const auto options = std::make_shared<FiguresOptions>();
    command->add_option("NAME", options->names, "figures, or papers for all of theirs; default: all")->type_name("");
    command
        ->add_option("-o,--output", options->folder,
                     "the folder for pictures and page; what is there and unchanged stays")
        ->type_name("DIR");
    command->add_flag("--list", options->list, "only print the figures' names and titles");
    command->add_flag("--again", options->again, "make also what has not changed");
    command->add_flag("--draft", options->draft, "quick and rough");
    command->add_option("--scenes", options->scenes, "the folder with the scenes; default: the program's own")
        ->type_name("DIR");
    add_run_options(*command, *options);
    return {command, [options] { return run_figures(*options); }};
}

}  // namespace deburr
