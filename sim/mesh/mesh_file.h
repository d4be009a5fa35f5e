// Mesh files of other programs: OBJ, PLY, STL, glTF and DAE.
#pragma once

#include <string>
#include <vector>

#include "sim/mesh/material.h"
#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// The axis that points up in the file. kAuto is what the format says: DAE states it, glTF has +y,
// for OBJ, PLY and STL it is taken to be z.
enum class UpAxis { kAuto, kX, kY, kZ };

struct MeshFile {
  TriangleMesh mesh;  // z up, scaled; triangles' materials are indices into `materials`
  std::vector<Material> materials;
};

// The endings of mesh files: ".obj .ply ...".
std::string MeshExtensions();

// Whether the path ends like a mesh file.
bool IsMeshFile(const std::string& path);

// ".ply" of "Room.PLY".
std::string LowerCaseExtension(const std::string& path);

// Reads all triangles, node transforms applied, lines and points left out. Throws InputError for a
// file that is missing, broken, too large or holds no triangle or a vertex that is not finite.
MeshFile ReadMeshFile(const std::string& path, double scale = 1.0, UpAxis up = UpAxis::kAuto);

}  // namespace depthgrid
