// Mesh files, encoded in memory by writers of our own. (Assimp's write six digits and do not share vertices.)
//
//   OBJ   text, with the fewest digits that read back as the same double; positions shared, normals
//         indexed separately, one object per solid; materials are in a separate file (export_obj.hpp)
//   PLY   binary, doubles, shared vertices. It has one normal per vertex, on a sharp seam the mean. Faces have the
//         colours of their materials, and vertices that of the largest triangle around them
//   STL   binary, single precision, no shared vertices; normals are those of the rounded corners
//   GLB   glTF 2.0, single precision; a vertex on a sharp seam occurs once for each normal; one
//         primitive per solid and material
//   ASE   text of 3ds Max [Vyatkin §4]: positions shared, a normal for every corner, one object per
//         solid, and the scene's materials as sub-materials of one. Digits as in OBJ. Printed differently:
//         its faces need not be seen from both sides, because all of them face outward
//   3MF   a ZIP archive of XML: digits as in OBJ, one object per solid, a unit of length, and the materials' colours
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

enum class MeshFormat { obj, ply, stl, glb, ase, three_mf };

/// The format that the extension of the file name stands for, in small or capital letters; none if it is unknown.
std::optional<MeshFormat> mesh_format(const std::string& path);
/// ".obj, .ply, …", for messages.
std::string known_mesh_extensions();

/// The unit of the mesh's coordinates.
enum class LengthUnit { micron, millimeter, centimeter, inch, foot, meter };

/// The unit's name as 3MF spells it.
const char* unit_name(LengthUnit unit);
/// The unit that 3MF gives this name; none if there is none.
std::optional<LengthUnit> find_unit(const std::string& name);
/// "micron, millimeter, …", for messages.
std::string known_units();

/// A material's appearance besides its colour, by glTF's names and with glTF's defaults.
struct SurfaceNotes {
    double metallic = 0.0, roughness = 1.0, ior = 1.5, transmission = 0.0, clearcoat = 0.0, clearcoat_roughness = 0.0;
    Vec3 emission{0.0};  // linear radiance
};

/// What formats can store besides the mesh itself.
struct MeshNotes {
    std::vector<std::string> names;            // of solids, by Triangle::solid; "" or missing: solid_N
    std::vector<Vec3> colors;                  // of materials, by Triangle::material, linear RGB; missing: grey
    LengthUnit unit = LengthUnit::millimeter;  // 3MF only
    std::string material_file = {};            // OBJ only: name of the MTL file beside it; "": none
    std::vector<SurfaceNotes> surfaces = {};   // GLB only: of materials; missing: matte
};

/// The solid's name with blanks and control characters replaced by underscores; never empty.
std::string solid_name(const MeshNotes& notes, int solid);

/// The bytes of an ASE file.
std::string encode_ase(const Mesh& mesh, const MeshNotes& notes);

/// The bytes of a file of this format. Throws std::length_error where the mesh does not fit the format.
std::string encode(const Mesh& mesh, MeshFormat format, const MeshNotes& notes = {});

}  // namespace deburr
