#include "raytracer/cli/mesh_statistics.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "polygonizer/mesh/metrics.hpp"
#include "raytracer/util/printable.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Spread& s) { return {{"mean", s.mean}, {"max", s.max}}; }

Json json_of(const MeshMetrics& m) {
    const Topology& t = m.topology;
    return {{"vertices", t.vertices},
            {"edges", t.edges},
            {"triangles", t.triangles},
            {"polygons", m.polygons},
            {"closed", t.closed()},
            {"manifold", t.manifold()},
            {"open_edges", t.open_edges},
            {"nonmanifold_edges", t.nonmanifold_edges},
            {"nonmanifold_vertices", t.nonmanifold_vertices},
            {"shells", t.shells},
            {"euler", t.euler},
            {"area", m.area},
            {"volume", m.volume},
            {"vertex_distance_mean", m.vertex_distance_mean},
            {"vertex_distance_max", m.vertex_distance},
            {"vertex_normal_degrees", json_of(m.vertex_normal_degrees)},
            {"triangle_distance_first_order", json_of(m.first_order)},
            {"triangle_distance", json_of(m.distance)},
            {"triangle_normal_degrees", json_of(m.normal_degrees)},
            {"inverted", m.inverted},
            {"degenerate", m.degenerate},
            {"edge_length_mean", m.edge_mean},
            {"edge_length_spread", m.edge_spread}};
}

void print_table(const Json& j, const std::string& prefix = "") {
    for (const auto& [name, value] : j.items()) {
        if (value.is_object())
            print_table(value, prefix + name + " ");
        else if (value.is_number_float())
            fmt::print("{:<40}{:.6g}\n", prefix + name, value.get<double>());
        else if (!value.is_array())
            fmt::print("{:<40}{}\n", printable(prefix + name),
                       printable(value.is_string() ? value.get<std::string>() : value.dump()));
    }
}

Json json_of(const MeshFault& f) {
    Json j{{"count", f.count}};
    if (f.count > 0) j["place"] = {f.location.x, f.location.y, f.location.z};
    if (f.line > 0) j["line"] = f.line;
    return j;
}

Json json_of(const std::vector<MeshCheck>& checks, std::size_t made_again) {
    Json solids = Json::array();
    MeshCheck sum;
    for (const MeshCheck& c : checks) {
        sum.facets += c.facets;
        sum.pairs += c.pairs;
        sum.points += c.points;
        sum.open.count += c.faults();
        solids.push_back({{"open", json_of(c.open)},
                          {"inward", json_of(c.inward)},
                          {"crossing", json_of(c.crossing)},
                          {"missing", json_of(c.missing)},
                          {"added", json_of(c.added)}});
    }
    return {{"faults", sum.open.count}, {"made_again", made_again}, {"facets", sum.facets},
            {"pairs", sum.pairs},       {"points", sum.points},     {"solids", solids}};
}

// The settings of the run and the measures of the mesh, without times.
Json statistics(const Scene& scene, const SceneMesh& mesh) {
    Json j;
    j["scene"] = scene.file;
    j["method"] = mesh.method_names();
    j["parameters"] = scene.parameters;
    j["mesh"] = json_of(combined(measure_parts(mesh)));
    if (mesh.triage.cells)
        j["triage"] = {
            {"cells", mesh.triage.cells}, {"open_cells", mesh.triage.open_cells}, {"rounds", mesh.triage.rounds}};
    if (const OctreeStatistics& t = mesh.octree; t.cells)
        j["octree"] = {{"level", t.level},
                       {"edge", t.edge},
                       {"range_tests", t.range_tests},
                       {"cells", t.cells},
                       {"open_cells", t.open_cells},
                       {"hard_points", t.hard_points},
                       {"partitions", t.partitions},
                       {"rounds", t.rounds}};
    if (!mesh.checks.empty()) j["check"] = json_of(mesh.checks, mesh.made_again);
    return j;
}

}  // namespace

void report_statistics(const MeshCommandOptions& o, const Scene& scene, const SceneMesh& mesh, PhaseClock& clock) {
    if (!o.stats && o.stats_json.empty()) return;
    clock.begin("measure");
    Json j = statistics(scene, mesh);
    clock.end();
    for (const PhaseTime& t : clock.times()) j["seconds"][t.name] = t.wall;
    if (o.stats) print_table(j);
    if (!o.stats_json.empty())
        write_whole_file(o.stats_json, j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace deburr
