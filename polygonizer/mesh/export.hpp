// Meshes as files: the bytes of them, by writers of our own. (Assimp's write six digits and do not
// share vertices.)
//
//   OBJ   text, the shortest digits that read back as the same double; positions shared, normals
//         apart, one object per solid; its materials are a file of their own (export_obj.hpp)
//   PLY   binary, doubles, shared vertices. It has one normal per vertex: on a sharp seam the mean. Faces have the
//         colours of their materials, and vertices that of the largest triangle around them
//   STL   binary: single precision and no sharing is all that it can hold; normals are those of its own corners
//   GLB   glTF 2.0: single precision; a vertex on a sharp seam is there once for each normal; one
//         primitive per solid and material
//   ASE   text of 3ds Max [Vyatkin §4]: positions shared, a normal for every corner, one object per
//         solid, and the scene's materials as parts of one. Digits as in OBJ. Printed differently:
//         its faces need not be seen from both sides, for all of them face outward
//   3MF   a ZIP archive of XML: digits as in OBJ, one object per solid, a unit of length, and the materials' colours
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

enum class MeshFormat { obj, ply, stl, glb, ase, three_mf };

/// Format that the extension of the file's name stands for, in small or capital letters; none if it is unknown.
std::optional<MeshFormat> mesh_format(const std::string& path);
std::string known_mesh_extensions();

/// Unit of the mesh's coordinates.
enum class LengthUnit { micron, millimeter, centimeter, inch, foot, meter };

/// Name of the unit as 3MF spells it.
const char* unit_name(LengthUnit unit);
/// The unit that a name of 3MF's stands for; none if there is no such unit.
std::optional<LengthUnit> find_unit(const std::string& name);
/// "micron, millimeter, …"
std::string known_units();

/// How a surface looks beside its colour, by glTF's names and with its defaults.
struct SurfaceNotes {
    double metallic = 0.0, roughness = 1.0, ior = 1.5, transmission = 0.0, clearcoat = 0.0, clearcoat_roughness = 0.0;
    Vec3 emission{0.0};  // linear radiance
};

struct MeshNotes {
    std::vector<std::string> names;            // of solids; "" or missing: solid N
    std::vector<Vec3> colors;                  // of materials, linear; missing: grey
    LengthUnit unit = LengthUnit::millimeter;  // of 3MF
    std::string material_file = {};            // of OBJ: the MTL beside it, "": none
    std::vector<SurfaceNotes> surfaces = {};   // of materials, of GLB; missing: matte
};

/// Without blanks; never empty.
std::string solid_name(const MeshNotes& notes, int solid);

std::string encode_ase(const Mesh& mesh, const MeshNotes& notes);

/// Throws std::length_error where the format cannot hold that much.
std::string encode(const Mesh& mesh, MeshFormat format, const MeshNotes& notes = {});

}  // namespace deburr
