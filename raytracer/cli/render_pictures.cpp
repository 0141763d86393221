#include "raytracer/cli/render_pictures.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <ctime>
#include <new>

#include "raytracer/cli/option_values.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

// The time that SOURCE_DATE_EPOCH gives; see https://reproducible-builds.org/specs/source-date-epoch/.
std::optional<std::time_t> source_date_epoch() {
    const char* text = std::getenv("SOURCE_DATE_EPOCH");
    if (!text || !*text) return std::nullopt;
    constexpr std::int64_t last = 253402300799;  // the end of the year 9999
    return std::time_t(parse_whole("SOURCE_DATE_EPOCH", text, 0, last));
}

std::string date_text(std::time_t time) {
    std::tm utc{};
    gmtime_r(&time, &utc);
    char text[sizeof "YYYY:MM:DD hh:mm:ss"];
    std::strftime(text, sizeof text, "%Y:%m:%d %H:%M:%S", &utc);
    return text;
}

}  // namespace

void check_source_date_epoch() { source_date_epoch(); }

std::string picture_date() { return date_text(source_date_epoch().value_or(std::time(nullptr))); }

ImageNotes notes_of(const RenderOptions& o, const RenderWorld& world, int spp, double trace_seconds) {
    const auto epoch = source_date_epoch();
    const Scene& scene = world.scene;
    ImageNotes notes;
    notes.camera = scene.camera;
    notes.spp = spp;
    for (std::size_t i = 0; i < scene.solids.size(); ++i)
        notes.solids.push_back(scene.names[i].empty() ? fmt::format("solid {}", i + 1) : scene.names[i]);
    notes.date = picture_date();
    if (!epoch) notes.render_seconds = trace_seconds;
    notes.attributes = {{"scene", scene.file},
                        {"seed", fmt::format("{}", o.seed)},
                        {"via", o.via},
                        {"criterion", o.criterion == Criterion::lobb ? "lobb" : "exact"}};
    if (o.denoiser != Denoiser::none)
        notes.attributes.push_back({"denoised", o.denoiser == Denoiser::wavelets ? "a-trous" : name(o.denoiser)});
    if (const double exposure = exposure_of(o, scene))
        notes.attributes.push_back({"exposure", fmt::format("{}", exposure)});
    if (o.noise) notes.attributes.push_back({"noise", fmt::format("{}", *o.noise)});
    if (o.view != ViewTransform::standard) notes.attributes.push_back({"view", "agx"});
    if (o.via == "implicit") notes.attributes.push_back({"accel", name(o.accel.value_or(Accel::bvh))});
    for (const auto& [name, value] : scene.parameters) notes.attributes.push_back({"parameter." + name, value});
    return notes;
}

ImageFormat format_of(const RenderOptions& o, double exposure, int threads) {
    return {o.float_color, threads, o.bits, o.alpha, exposure, o.view};
}

void write_pictures(const std::vector<std::string>& paths, const Film& film, const ImageFormat& format,
                    const ImageNotes& notes, const std::function<void(double)>& work) {
    std::string error;
    bool lacks_memory = false;
    for (const std::string& path : paths) {
        const double all = writing_work * double(film.pixels.size());
        double reported = 0;
        try {
            write_image(path, film, format, notes, [&](double share) {
                work(all * (share - reported));
                reported = share;
            });
        } catch (const std::bad_alloc&) {
            lacks_memory = true;
        } catch (const std::exception& e) {
            if (error.empty()) error = e.what();
        }
    }
    if (!error.empty()) throw WorkError(error);
    if (lacks_memory) throw std::bad_alloc();
}

}  // namespace deburr
