#include "polygonizer/mesh/export_3mf.hpp"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "polygonizer/mesh/export_color.hpp"
#include "polygonizer/mesh/mesh_objects.hpp"
#include "polygonizer/mesh/zip_archive.hpp"

namespace deburr {
namespace {

constexpr const char* content_types =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>\n";

constexpr const char* relations =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";

// Materials and objects share one sequence of resource numbers.
constexpr int materials_id = 1, first_object_id = 2;

// The text as the value of an XML attribute: valid UTF-8 without characters that XML 1.0 excludes [XML §2.2].
std::string attribute(const std::string& any) {
    using Json = nlohmann::json;
    const std::string text = Json::parse(Json(any).dump(-1, ' ', false, Json::error_handler_t::replace));
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (static_cast<unsigned char>(c) < ' ')
            out += '_';
        else if (text.compare(i, 3, "\uFFFE") == 0 || text.compare(i, 3, "\uFFFF") == 0)
            out += '_', i += 2;
        else if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

// Formats text into the archive's current file, buffered.
class Text {
public:
    explicit Text(ZipArchive& archive) : archive_(archive) {}

    template <class... Values>
    void put(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(buffer_), format, std::forward<Values>(values)...);
        constexpr std::size_t enough = 1 << 16;
        if (buffer_.size() >= enough) flush();
    }
    void flush() {
        archive_.add({buffer_.data(), buffer_.size()});
        buffer_.clear();
    }

private:
    ZipArchive& archive_;
    fmt::memory_buffer buffer_;
};

// Writes the list of the materials in use and returns the index of each in it.
std::map<int, int> put_materials(Text& text, const Mesh& mesh, const MeshNotes& notes) {
    std::map<int, int> places;
    for (const Triangle& t : mesh.triangles) places[t.material] = 0;
    if (places.empty()) return places;
    text.put("<basematerials id=\"{}\">\n", materials_id);
    int count = 0;
    for (auto& [material, place] : places) {
        place = count++;
        const auto [r, g, b] = display_color(notes, material);
        text.put("<base name=\"material_{}\" displaycolor=\"#{:02X}{:02X}{:02X}\"/>\n", material, r, g, b);
    }
    text.put("</basematerials>\n");
    return places;
}

void put_object(Text& text, const Mesh& mesh, const MeshObject& object, int id, const MeshNotes& notes,
                const std::map<int, int>& materials) {
    const Triangle& first = mesh.triangles[object.begin];
    const std::size_t solid = std::size_t(first.solid);
    const std::string name = solid < notes.names.size() ? notes.names[solid] : "";
    text.put("<object id=\"{}\" type=\"model\" name=\"{}\" pid=\"{}\" pindex=\"{}\">\n<mesh>\n<vertices>\n", id,
             attribute(name.empty() ? solid_name(notes, first.solid) : name), materials_id,
             materials.at(first.material));
    for (const int v : object.positions) {
        const Vec3 x = mesh.positions[v];
        text.put("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", x.x, x.y, x.z);
    }
    text.put("</vertices>\n<triangles>\n");
    for (std::size_t i = 0; i < object.triangles.size(); ++i) {
        const auto [a, b, c] = object.triangles[i];
        const int material = mesh.triangles[object.begin + i].material;
        if (material == first.material)
            text.put("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", a, b, c);
        else
            text.put("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\" pid=\"{}\" p1=\"{}\"/>\n", a, b, c, materials_id,
                     materials.at(material));
    }
    text.put("</triangles>\n</mesh>\n</object>\n");
}

}  // namespace

std::string encode_3mf(const Mesh& mesh, const MeshNotes& notes) {
    ZipArchive archive;
    archive.begin("[Content_Types].xml");
    archive.add(content_types);
    archive.begin("_rels/.rels");
    archive.add(relations);
    archive.begin("3D/3dmodel.model");
    Text text(archive);
    text.put(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"{}\" xml:lang=\"en-US\" "
        "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
        "<metadata name=\"Application\">Deburr</metadata>\n<resources>\n",
        unit_name(notes.unit));
    const std::map<int, int> materials = put_materials(text, mesh, notes);
    int id = first_object_id;
    for_each_object(mesh, [&](const MeshObject& object) { put_object(text, mesh, object, id++, notes, materials); });
    text.put("</resources>\n<build>\n");
    for (int item = first_object_id; item < id; ++item) text.put("<item objectid=\"{}\"/>\n", item);
    text.put("</build>\n</model>\n");
    text.flush();
    return archive.finish();
}

}  // namespace deburr
