// The module behind raytracer/model/model_module.hpp: all code that calls Assimp.
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <stdexcept>

#include "raytracer/model/model_module.hpp"

namespace deburr {
namespace {

using Matrix = std::array<double, 16>;  // row by row

Matrix product(const Matrix& a, const aiMatrix4x4& b) {
    Matrix c{};
    for (unsigned i = 0; i < 4; ++i)
        for (unsigned k = 0; k < 4; ++k)
            for (unsigned j = 0; j < 4; ++j) c[4 * i + k] += a[4 * i + j] * double(b[j][k]);
    return c;
}

Vec3 moved(const Matrix& m, const aiVector3D& v) {
    Vec3 x;
    for (int i = 0; i < 3; ++i)
        x[i] = m[4 * unsigned(i)] * double(v.x) + m[4 * unsigned(i) + 1] * double(v.y) +
               m[4 * unsigned(i) + 2] * double(v.z) + m[4 * unsigned(i) + 3];
    return x;
}

bool mirrors(const Matrix& m) {
    const Vec3 x(m[0], m[4], m[8]), y(m[1], m[5], m[9]), z(m[2], m[6], m[10]);
    return glm::dot(glm::cross(x, y), z) < 0;
}

void add(const aiScene& scene, const aiNode& node, const Matrix& above, TriangleSoup& soup) {
    const Matrix here = product(above, node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
        const int first = int(soup.vertices.size());
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) soup.vertices.push_back(moved(here, mesh.mVertices[v]));
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices != 3) continue;  // skips points and lines
            std::array<int, 3> t{};
            for (unsigned k = 0; k < 3; ++k) t[k] = first + int(face.mIndices[k]);
            if (mirrors(here)) std::swap(t[1], t[2]);
            soup.triangles.push_back(t);
        }
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(scene, *node.mChildren[i], here, soup);
}

void check_faces(const aiMesh& mesh) {
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
        for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k)
            if (mesh.mFaces[f].mIndices[k] >= mesh.mNumVertices)
                throw std::runtime_error("a face of a vertex that is not there");
}

TriangleSoup read(const std::string& bytes, const std::string& format) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, format.c_str());
    if (!scene || !scene->mRootNode) throw std::runtime_error(importer.GetErrorString());
    // Assimp's post-processing assumes valid indices, which its readers do not ensure.
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) check_faces(*scene->mMeshes[m]);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    if (!scene) throw std::runtime_error(importer.GetErrorString());
    TriangleSoup soup;
    add(*scene, *scene->mRootNode, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, soup);
    return soup;
}

}  // namespace
}  // namespace deburr

extern "C" __attribute__((visibility("default"))) deburr::ModelReader* deburr_model_module() { return deburr::read; }
