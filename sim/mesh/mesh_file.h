// Mesh files of other programs: OBJ, PLY, STL, glTF and DAE.
#pragma once

#include <string>
#include <vector>

#include "sim/mesh/material.h"
#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// The axis that points up in the file. kAuto: as the format defines; DAE states it, glTF has +y,
// OBJ, PLY and STL are taken to have +z.
enum class UpAxis { kAuto, kX, kY, kZ };

struct MeshFile {
  TriangleMesh mesh;  // z up, scaled; triangles' materials are indices into `materials`
  std::vector<Material> materials;
};

// The extensions of mesh files: ".obj .ply ...".
std::string MeshExtensions();

// Whether the path has the extension of a mesh file.
bool IsMeshFile(const std::string& path);

// ".ply" of "Room.PLY".
std::string LowerCaseExtension(const std::string& path);

// Reads all triangles with node transforms applied; ignores lines and points. Throws InputError for
// a file that is missing, broken, too large, without triangles or with a vertex that is not finite.
MeshFile ReadMeshFile(const std::string& path, double scale = 1.0, UpAxis up = UpAxis::kAuto);

}  // namespace depthgrid
