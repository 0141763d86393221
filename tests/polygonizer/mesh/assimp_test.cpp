// Mesh files read back by Assimp, an independent reader.
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <sstream>

#include "catch.hpp"
#include "polygonizer/mesh/export_obj.hpp"
#include "polygonizer/octree/octree.hpp"
#include "polygonizer/triage/triage.hpp"
#include "raytracer/folder.hpp"

using namespace deburr;

TEST_CASE("Assimp reads every format back as the same triangles, in the same place, facing the same way") {
    const SolidTree tree = flatten(Solid::rounded(0.1, Density::box(Vec3(0.0), Vec3(1.0, 1.0 / 3, 0.7))) -
                                   Solid::sharp(Density::box({0.5, -1, 0.3}, {2, 2, 2})));
    const Mesh mesh = triage(tree, polygonization_box(tree));
    Box box;
    for (const Vec3 p : mesh.positions) box = hull(box, {p, p});
    for (const std::string name : {"obj", "ply", "stl", "glb", "ase", "3mf"}) {
        CAPTURE(name);
        const std::string bytes = encode(mesh, *mesh_format("a." + name));
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFileFromMemory(
            bytes.data(), bytes.size(), aiProcess_Triangulate | aiProcess_PreTransformVertices, name.c_str());
        CAPTURE(importer.GetErrorString());
        REQUIRE(scene != nullptr);
        std::size_t triangles = 0, turned = 0;
        Box read;
        double six_volumes = 0;
        // Assimp turns files of 3ds Max (ASE) from z up to y up.
        const auto upright = [&](Vec3 v) { return name == "ase" ? Vec3(v.x, -v.z, v.y) : v; };
        for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
            const aiMesh& part = *scene->mMeshes[m];
            const auto point = [&](unsigned i) {
                const aiVector3D& v = part.mVertices[i];
                return upright({v.x, v.y, v.z});
            };
            for (unsigned f = 0; f < part.mNumFaces; ++f) {
                REQUIRE(part.mFaces[f].mNumIndices == 3);
                const unsigned* i = part.mFaces[f].mIndices;
                const Vec3 a = point(i[0]), b = point(i[1]), c = point(i[2]);
                for (const Vec3 p : {a, b, c}) read = hull(read, {p, p});
                six_volumes += glm::dot(a, glm::cross(b, c));
                if (part.HasNormals()) {
                    const aiVector3D& n = part.mNormals[i[0]];
                    turned += glm::dot(glm::cross(b - a, c - a), upright({n.x, n.y, n.z})) < 0;
                }
                ++triangles;
            }
        }
        CHECK(triangles == mesh.triangles.size());
        CHECK(turned == 0);
        CHECK(six_volumes / 6 == Approx(volume(mesh)).epsilon(1e-5));
        CHECK(glm::length(read.lo - box.lo) < 1e-6);
        CHECK(glm::length(read.hi - box.hi) < 1e-6);
    }
}

TEST_CASE("ASE keeps every vertex's digits, every corner's normal, and each solid's materials") {
    SolidTree tree = flatten(Solid::rounded(0.1, Density::box(Vec3(0.0), Vec3(1.0, 1.0 / 3, 0.7))).material(0) -
                             Solid::sharp(Density::box({0.5, -1, 0.3}, {2, 2, 2})).material(2));
    Mesh mesh = octree(tree, polygonization_box(tree), {0.1});
    mesh.append(Mesh(mesh), 1);
    const std::string text =
        encode(mesh, MeshFormat::ase, {{"", "two \"words\""}, {Vec3(0.1, 0.2, 0.3), Vec3(0.0), Vec3(1.0, 0.5, 0.25)}});
    std::istringstream in(text);
    std::string word;
    std::vector<Vec3> positions;
    std::size_t faces = 0, normals = 0;
    while (in >> word) {
        int index = 0;
        Vec3 x;
        std::string digits[3];
        if (word == "*MESH_VERTEX" || word == "*MESH_VERTEXNORMAL") {
            in >> index >> digits[0] >> digits[1] >> digits[2];
            for (int k = 0; k < 3; ++k) x[k] = std::stod(digits[k]);
            if (word == "*MESH_VERTEX") {
                positions.push_back(x);
            } else {
                CHECK(x == mesh.normals[mesh.triangles[normals / 3].normal[normals % 3]]);
                ++normals;
            }
        }
        faces += word == "*MESH_FACE";
    }
    CHECK(faces == mesh.triangles.size());
    CHECK(normals == 3 * faces);
    REQUIRE(positions.size() == mesh.positions.size());
    for (const Triangle& t : mesh.triangles)
        for (const int v : t.vertex)
            CHECK(std::find(positions.begin(), positions.end(), mesh.positions[v]) != positions.end());
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(text.data(), text.size(), aiProcess_PreTransformVertices, "ase");
    REQUIRE(scene != nullptr);
    std::size_t red = 0, blue = 0, dark = 0;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        aiColor3D color;
        scene->mMaterials[scene->mMeshes[m]->mMaterialIndex]->Get(AI_MATKEY_COLOR_DIFFUSE, color);
        (color.r == 1 ? red : color.b > 0.29f ? blue : dark) += scene->mMeshes[m]->mNumFaces;
    }
    std::size_t of_material[3] = {};
    for (const Triangle& t : mesh.triangles) ++of_material[t.material];
    CHECK(blue == of_material[0]);
    CHECK(red == of_material[2]);
    CHECK(dark == 0);
    CHECK(red > 10);
}

TEST_CASE("Assimp reads the colours and names of an OBJ with its MTL") {
    const SolidTree tree = flatten(Solid::rounded(0.1, Density::box(Vec3(0.0), Vec3(1.0, 1.0 / 3, 0.7))).material(0) -
                                   Solid::sharp(Density::box({0.5, -1, 0.3}, {2, 2, 2})).material(2));
    const Mesh mesh = triage(tree, polygonization_box(tree));
    MeshNotes notes{{"lid"}, {Vec3(0.1, 0.2, 0.3), Vec3(0.0), Vec3(1.0, 0.5, 0.25)}};
    notes.material_file = "a part.mtl";
    const deburr::test::Folder folder;
    deburr::test::write_file(folder / "a.obj", encode(mesh, MeshFormat::obj, notes));
    deburr::test::write_file(folder / notes.material_file, encode_mtl(mesh, notes));
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(folder / "a.obj", aiProcess_Triangulate);
    REQUIRE(scene != nullptr);
    REQUIRE(scene->mRootNode->mNumChildren == 1);
    CHECK(scene->mRootNode->mChildren[0]->mName.C_Str() == std::string("lid"));
    std::size_t faces[3] = {}, of_material[3] = {};
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        const aiMaterial& material = *scene->mMaterials[scene->mMeshes[m]->mMaterialIndex];
        aiColor3D color;
        REQUIRE(material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS);
        for (const std::size_t k : {0, 2}) {
            const Vec3 c = notes.colors[k];
            if (color == aiColor3D(float(c.x), float(c.y), float(c.z))) faces[k] += scene->mMeshes[m]->mNumFaces;
        }
    }
    for (const Triangle& t : mesh.triangles) ++of_material[t.material];
    CHECK(faces[0] == of_material[0]);
    CHECK(faces[2] == of_material[2]);
    CHECK(faces[2] > 4);
    CHECK(encode_mtl(mesh, notes).find("material_1") == std::string::npos);  // no triangle has this material
}

TEST_CASE("Assimp reads the colours of a PLY") {
    const SolidTree tree = flatten(Solid::rounded(0.1, Density::box(Vec3(0.0), Vec3(1.0))).material(0));
    const Mesh mesh = triage(tree, polygonization_box(tree));
    const std::string bytes = encode(mesh, MeshFormat::ply, {{}, {Vec3(1, 0, 0.21586)}});
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, "ply");
    REQUIRE(scene != nullptr);
    REQUIRE(scene->mNumMeshes == 1);
    REQUIRE(scene->mMeshes[0]->HasVertexColors(0));
    for (unsigned v = 0; v < scene->mMeshes[0]->mNumVertices; ++v)
        CHECK(scene->mMeshes[0]->mColors[0][v] == aiColor4D(1, 0, 128 / 255.0f, 1));
}
