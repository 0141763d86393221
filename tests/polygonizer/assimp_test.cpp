// Files of meshes read back by another program's reader.
#include <algorithm>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "catch.hpp"
#include "polygonizer/export.hpp"
#include "polygonizer/triage.hpp"

using namespace deburr;

TEST_CASE("Assimp reads every format back as the same triangles, in the same place, facing the same way") {
    const SolidTree tree = flatten(Solid::rounded(0.1, Density::box(Vec3(0.0), Vec3(1.0, 1.0 / 3, 0.7))) -
                                   Solid::sharp(Density::box({0.5, -1, 0.3}, {2, 2, 2})));
    const Mesh mesh = triage(tree, polygonization_box(tree));
    Box box;
    for (const Vec3 p : mesh.positions) box = hull(box, {p, p});
    for (const char* name : {"obj", "ply", "stl", "glb"}) {
        CAPTURE(name);
        const std::string bytes = encode(mesh, *mesh_format(std::string("a.") + name));
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFileFromMemory(
            bytes.data(), bytes.size(), aiProcess_Triangulate | aiProcess_PreTransformVertices, name);
        CAPTURE(importer.GetErrorString());
        REQUIRE(scene != nullptr);
        std::size_t triangles = 0, turned = 0;
        Box read;
        double six_volumes = 0;
        for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
            const aiMesh& part = *scene->mMeshes[m];
            const auto point = [&](unsigned i) {
                const aiVector3D& v = part.mVertices[i];
                return Vec3(v.x, v.y, v.z);
            };
            for (unsigned f = 0; f < part.mNumFaces; ++f) {
                REQUIRE(part.mFaces[f].mNumIndices == 3);
                const unsigned* i = part.mFaces[f].mIndices;
                const Vec3 a = point(i[0]), b = point(i[1]), c = point(i[2]);
                for (const Vec3 p : {a, b, c}) read = hull(read, {p, p});
                six_volumes += glm::dot(a, glm::cross(b, c));
                if (part.HasNormals()) {
                    const aiVector3D& n = part.mNormals[i[0]];
                    turned += glm::dot(glm::cross(b - a, c - a), Vec3(n.x, n.y, n.z)) < 0;
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
