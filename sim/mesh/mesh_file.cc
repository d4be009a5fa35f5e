#include "sim/mesh/mesh_file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>

#include "mapper/core/error.h"
#include "sim/mesh/dae_counts.h"
#include "sim/mesh/gltf_check.h"
#include "sim/mesh/mesh_streams_impl.h"
#include "sim/mesh/ply_file.h"
#include "sim/mesh/scene_limits.h"
#include "sim/mesh/stl_check.h"

namespace depthgrid {
namespace {

constexpr std::array<const char*, 6> kExtensions = {".obj",  ".ply", ".stl",
                                                    ".gltf", ".glb", ".dae"};

bool IsGltf(const std::string& path) {
  return LowerCaseExtension(path) == ".gltf" || LowerCaseExtension(path) == ".glb";
}

void RequireReadableFile(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path, "no such file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path, "is not a file");
  const auto bytes = std::filesystem::file_size(path, error);
  if (error) throw InputError(path, "cannot be read");
  if (bytes == 0) throw InputError(path, "is empty");
  if (bytes > kMaxMeshFileBytes) {
    throw InputError(path,
                     fmt::format("is {} bytes, must be at most {}", bytes, kMaxMeshFileBytes));
  }
}

// Assimp's messages may span lines and quote the rest of the file; error messages must be one line.
std::string OneLine(std::string text) {
  constexpr std::size_t kMostLetters = 200;
  if (text.size() > kMostLetters) text.replace(kMostLetters, std::string::npos, "...");
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

// Assimp passes on the standard library's message for lack of memory.
bool IsOfMemory(std::string_view message) {
  return message.find("bad_alloc") != std::string_view::npos ||
         message.find("bad_array_new_length") != std::string_view::npos;
}

// The rotation that maps the file's up axis to z.
Eigen::Matrix3d ZUpFrom(UpAxis up) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  if (up == UpAxis::kY) m << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up == UpAxis::kX) m << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return m;
}

Eigen::Affine3d FromAssimp(const aiMatrix4x4& m) {
  Eigen::Matrix4d matrix;
  matrix << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return Eigen::Affine3d(matrix);
}

std::vector<Material> MaterialsOf(const aiScene& scene, bool colours_are_linear) {
  std::vector<Material> materials;
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    Material material;
    aiString name;
    if (scene.mMaterials[i]->Get(AI_MATKEY_NAME, name) == AI_SUCCESS) material.name = name.C_Str();
    aiColor4D colour;
    if (scene.mMaterials[i]->Get(AI_MATKEY_COLOR_DIFFUSE, colour) == AI_SUCCESS) {
      const Eigen::Vector3f rgb =
          Eigen::Vector3f(colour.r, colour.g, colour.b).cwiseMax(0.0F).cwiseMin(1.0F);
      material.colour = colours_are_linear ? rgb : LinearFromSrgb(rgb);
      material.second_colour = material.colour;
    }
    materials.push_back(material);
  }
  if (materials.empty()) materials.emplace_back();
  return materials;
}

class Assembler {
 public:
  Assembler(const aiScene& scene, const std::string& path, const Eigen::Affine3d& world_from_root)
      : scene_(scene), path_(path) {
    AddNode(*scene.mRootNode, world_from_root);
  }
  TriangleMesh Take() { return std::move(mesh_); }

 private:
  // Recursion depth is no concern: assimp built the tree recursively too.
  void AddNode(const aiNode& node, const Eigen::Affine3d& world_from_parent) {
    const Eigen::Affine3d world_from_node = world_from_parent * FromAssimp(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      AddMesh(*scene_.mMeshes[node.mMeshes[i]], world_from_node);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) AddNode(*node.mChildren[i], world_from_node);
  }

  void AddMesh(const aiMesh& part, const Eigen::Affine3d& world_from_part) {
    if (mesh_.triangles.size() + part.mNumFaces > kMaxSceneTriangles) {
      throw InputError(path_, fmt::format("has more than {} triangles", kMaxSceneTriangles));
    }
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      const Eigen::Vector3d point = world_from_part * Eigen::Vector3d(v.x, v.y, v.z);
      const auto index = mesh_.AddVertex(point);
      if (!mesh_.vertices[index].allFinite()) {
        throw InputError(path_, fmt::format("vertex {} is not finite", index));
      }
    }
    // A mirroring node transform reverses the orientation of triangles; restore it.
    const bool mirrored = world_from_part.linear().determinant() < 0.0;
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices != 3) continue;
      for (unsigned k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= part.mNumVertices) {
          throw InputError(path_, fmt::format("a triangle uses vertex {} of {}", face.mIndices[k],
                                              part.mNumVertices));
        }
      }
      const unsigned second = face.mIndices[mirrored ? 2 : 1];
      const unsigned third = face.mIndices[mirrored ? 1 : 2];
      const std::size_t before = mesh_.triangles.size();
      mesh_.AddTriangle(first + face.mIndices[0], first + second, first + third);
      if (mesh_.triangles.size() > before) {
        mesh_.material_of_triangle.back() = static_cast<std::uint16_t>(part.mMaterialIndex);
      }
    }
  }

  const aiScene& scene_;
  std::string path_;
  TriangleMesh mesh_;
};

Eigen::Affine3d WorldFromFile(double scale, UpAxis up) {
  Eigen::Affine3d world_from_file = Eigen::Affine3d::Identity();
  world_from_file.linear() = scale * ZUpFrom(up);
  return world_from_file;
}

MeshFile ReadPlyFile(const std::string& path, double scale, UpAxis up) {
  return {Transformed(ReadPly(path), WorldFromFile(scale, up)), {Material{}}};
}

// Checks for faults that assimp does not detect.
void RequireSoundFile(const std::string& path) {
  const std::string extension = LowerCaseExtension(path);
  if (extension == ".dae") RequireSoundCounts(path);
  if (extension == ".stl") RequireWholeStl(path);
  if (IsGltf(path)) RequireKnownExtensions(path);
}

// Called before vertices are joined, which drops NaN vertices.
void RequireFiniteVertices(const aiScene& scene, const std::string& path) {
  std::size_t index = 0;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& part = *scene.mMeshes[i];
    for (unsigned k = 0; k < part.mNumVertices; ++k, ++index) {
      const aiVector3D& v = part.mVertices[k];
      if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) continue;
      throw InputError(path, fmt::format("vertex {} is not finite", index));
    }
  }
}

MeshFile ReadByAssimp(const std::string& path, double scale, UpAxis up) {
  RequireSoundFile(path);
  Assimp::Importer importer;
  importer.SetIOHandler(std::make_unique<MeshStreams>().release());  // the importer owns it
  // Drops all but positions, so that vertices at the same position are joined.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                              aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                  aiComponent_COLORS | aiComponent_TEXCOORDS |
                                  aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                  aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS);
  const bool is_dae = LowerCaseExtension(path) == ".dae";
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, up != UpAxis::kAuto);
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene != nullptr) {
    RequireFiniteVertices(*scene, path);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_RemoveComponent |
                                         aiProcess_JoinIdenticalVertices);
  }
  if (scene == nullptr || scene->mRootNode == nullptr) {
    if (IsOfMemory(importer.GetErrorString())) {
      throw InputError(path, "needs more memory to be read than there is");
    }
    throw InputError(path, "is not a readable mesh: " + OneLine(importer.GetErrorString()));
  }
  // Assimp rotates a DAE to +y up according to its stated axis; glTF has +y up.
  if (up == UpAxis::kAuto) up = is_dae || IsGltf(path) ? UpAxis::kY : UpAxis::kZ;
  MeshFile file;
  file.mesh = Assembler(*scene, path, WorldFromFile(scale, up)).Take();
  file.materials = MaterialsOf(*scene, IsGltf(path));
  return file;
}

}  // namespace

std::string LowerCaseExtension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string MeshExtensions() { return fmt::format("{}", fmt::join(kExtensions, " ")); }

bool IsMeshFile(const std::string& path) {
  const std::string extension = LowerCaseExtension(path);
  return std::any_of(kExtensions.begin(), kExtensions.end(),
                     [&](const char* known) { return extension == known; });
}

MeshFile ReadMeshFile(const std::string& path, double scale, UpAxis up) {
  if (!IsMeshFile(path)) {
    throw InputError(path, fmt::format("is not a mesh file ({})", MeshExtensions()));
  }
  RequireReadableFile(path);
  MeshFile file = LowerCaseExtension(path) == ".ply" ? ReadPlyFile(path, scale, up)
                                                     : ReadByAssimp(path, scale, up);
  if (file.mesh.triangles.empty()) throw InputError(path, "has no triangles");
  return file;
}

}  // namespace depthgrid
