// 3MF files read back by lib3mf, the 3MF Consortium's own library, in its strict mode.
#include <Model/COM/NMR_DLLInterfaces.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "catch.hpp"
#include "polygonizer/mesh/export.hpp"
#include "polygonizer/triage/triage.hpp"

using namespace deburr;

namespace {

using Pointer = NMR::PLib3MFBase*;

// Owns an object of lib3mf and releases it at the end.
class Handle {
public:
    Handle() = default;
    ~Handle() {
        if (object_) NMR::lib3mf_release(object_);
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    operator Pointer() const { return object_; }
    Pointer* out() { return &object_; }

private:
    Pointer object_ = nullptr;
};

struct Object {
    std::string name;
    bool manifold = false;
    std::vector<std::array<float, 3>> vertices;
    std::vector<std::array<int, 3>> triangles;
    std::vector<std::array<int, 3>> colors;  // of the triangles, in sRGB, 0 to 255
};

struct Model {
    int unit = -1;
    unsigned warnings = 0, items = 0;
    std::vector<Object> objects;
};

Object read_object(Pointer model, Pointer mesh) {
    using namespace NMR;
    Object object;
    char name[100];
    ULONG length = 0;
    REQUIRE(lib3mf_object_getnameutf8(mesh, name, sizeof name, &length) == 0);
    object.name = name;
    BOOL is_manifold = false;
    REQUIRE(lib3mf_meshobject_ismanifoldandoriented(mesh, &is_manifold) == 0);
    object.manifold = is_manifold;
    DWORD vertices = 0, triangles = 0;
    REQUIRE(lib3mf_meshobject_getvertexcount(mesh, &vertices) == 0);
    REQUIRE(lib3mf_meshobject_gettrianglecount(mesh, &triangles) == 0);
    for (DWORD v = 0; v < vertices; ++v) {
        MODELMESHVERTEX x;
        REQUIRE(lib3mf_meshobject_getvertex(mesh, v, &x) == 0);
        object.vertices.push_back({x.m_fPosition[0], x.m_fPosition[1], x.m_fPosition[2]});
    }
    Handle defaults, properties;
    DWORD own_group = 0, own_index = 0;
    REQUIRE(lib3mf_object_createdefaultpropertyhandler(mesh, defaults.out()) == 0);
    REQUIRE(lib3mf_defaultpropertyhandler_getbasematerial(defaults, &own_group, &own_index) == 0);
    REQUIRE(lib3mf_meshobject_createpropertyhandler(mesh, properties.out()) == 0);
    for (DWORD t = 0; t < triangles; ++t) {
        MODELMESHTRIANGLE corners;
        REQUIRE(lib3mf_meshobject_gettriangle(mesh, t, &corners) == 0);
        object.triangles.push_back(
            {int(corners.m_nIndices[0]), int(corners.m_nIndices[1]), int(corners.m_nIndices[2])});
        DWORD group = 0, index = 0;
        REQUIRE(lib3mf_propertyhandler_getbasematerial(properties, t, &group, &index) == 0);
        if (group == 0) group = own_group, index = own_index;
        Handle materials;
        REQUIRE(lib3mf_model_getbasematerialbyid(model, group, materials.out()) == 0);
        BYTE r, g, b, alpha;
        REQUIRE(lib3mf_basematerial_getdisplaycolor(materials, index, &r, &g, &b, &alpha) == 0);
        object.colors.push_back({r, g, b});
    }
    return object;
}

Model read_model(std::string bytes) {
    using namespace NMR;
    Model model;
    Handle in, reader, objects, items;
    REQUIRE(lib3mf_createmodel(in.out()) == 0);
    REQUIRE(lib3mf_model_queryreader(in, "3mf", reader.out()) == 0);
    REQUIRE(lib3mf_reader_setstrictmodeactive(reader, true) == 0);
    REQUIRE(lib3mf_reader_readfrombuffer(reader, reinterpret_cast<BYTE*>(bytes.data()), bytes.size()) == 0);
    REQUIRE(lib3mf_reader_getwarningcount(reader, &model.warnings) == 0);
    DWORD unit = 0;
    REQUIRE(lib3mf_model_getunit(in, &unit) == 0);
    model.unit = int(unit);
    BOOL more = false;
    REQUIRE(lib3mf_model_getmeshobjects(in, objects.out()) == 0);
    while (lib3mf_resourceiterator_movenext(objects, &more) == 0 && more) {
        Handle mesh;
        REQUIRE(lib3mf_resourceiterator_getcurrent(objects, mesh.out()) == 0);
        model.objects.push_back(read_object(in, mesh));
    }
    REQUIRE(lib3mf_model_getbuilditems(in, items.out()) == 0);
    while (lib3mf_builditemiterator_movenext(items, &more) == 0 && more) ++model.items;
    return model;
}

Mesh two_solids() {
    const SolidTree first = flatten(Solid::rounded(0.1, Density::box(Vec3(0.0), Vec3(1.0, 1.0 / 3, 0.7))).material(0) -
                                    Solid::sharp(Density::box({0.5, -1, 0.3}, {2, 2, 2})).material(2));
    const SolidTree second = flatten(Solid::rounded(0.2, Density::box({3, 0, 0}, {4, 1, 1})).material(1));
    Mesh mesh;
    mesh.append(triage(first, polygonization_box(first)), 0);
    mesh.append(triage(second, polygonization_box(second)), 3);
    return mesh;
}

}  // namespace

TEST_CASE("lib3mf reads a 3MF back: names, vertices, triangles and colours of every solid") {
    const Mesh mesh = two_solids();
    const std::vector<Vec3> colors{{1, 0, 0.21586}, {0, 0.5, 1}, {0.0031308, 1, 0.01}};
    const Model model = read_model(encode(mesh, MeshFormat::three_mf, {{"a \"b\" & <c>\n\xff\xc3\xa9"}, colors}));
    CHECK(model.warnings == 0);
    CHECK(model.unit == NMR::MODELUNIT_MILLIMETER);
    CHECK(model.items == 2);
    REQUIRE(model.objects.size() == 2);
    CHECK(model.objects[0].name == "a \"b\" & <c>_\xef\xbf\xbd\xc3\xa9");
    CHECK(model.objects[1].name == "solid_4");
    // Colours in the file are sRGB: a linear 0.216 becomes 128 of 255.
    const std::array<int, 3> shown[3] = {{255, 0, 128}, {0, 188, 255}, {10, 255, 25}};
    std::size_t t = 0;
    std::map<std::array<int, 3>, int> used;
    for (const Object& object : model.objects) {
        CHECK(object.manifold);
        for (std::size_t i = 0; i < object.triangles.size(); ++i, ++t) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 x = mesh.positions[mesh.triangles[t].vertex[k]];
                const auto read = object.vertices[object.triangles[i][k]];
                for (int axis = 0; axis < 3; ++axis) CHECK(read[axis] == float(x[axis]));
            }
            CHECK(object.colors[i] == shown[mesh.triangles[t].material]);
            ++used[object.colors[i]];
        }
    }
    CHECK(t == mesh.triangles.size());
    CHECK(used.size() == 3);
    CHECK(model.objects[0].vertices.size() + model.objects[1].vertices.size() == mesh.positions.size());
}

TEST_CASE("lib3mf reads every unit of length back, and an empty mesh") {
    const std::pair<const char*, int> units[] = {{"micron", NMR::MODELUNIT_MICROMETER},
                                                 {"millimeter", NMR::MODELUNIT_MILLIMETER},
                                                 {"centimeter", NMR::MODELUNIT_CENTIMETER},
                                                 {"inch", NMR::MODELUNIT_INCH},
                                                 {"foot", NMR::MODELUNIT_FOOT},
                                                 {"meter", NMR::MODELUNIT_METER}};
    for (const auto& [name, unit] : units) {
        CAPTURE(name);
        REQUIRE(find_unit(name));
        CHECK(read_model(encode(Mesh{}, MeshFormat::three_mf, {{}, {}, *find_unit(name)})).unit == unit);
        CHECK(known_units().find(name) != std::string::npos);
    }
    CHECK_FALSE(find_unit("parsec"));
    CHECK_FALSE(find_unit(""));
}
