#include "sim/scene/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "mapper/core/error.h"
#include "sim/mesh/mesh_file.h"
#include "sim/mesh/scene_limits.h"
#include "sim/shapes/material_options.h"
#include "sim/shapes/shapes.h"

namespace depthgrid {
namespace {

constexpr int kMaxGroupDepth = 16;
// Marks triangles that take the material of the enclosing `use`.
constexpr std::uint16_t kInherited = 0xFFFF;
constexpr std::size_t kMaxMaterials = 0xFFFF;

struct LightOptions {
  std::array<double, 3> at = {0, 0, 0};
  std::array<double, 3> colour = {255, 255, 255};
  double strength = 1.0;
  void Visit(OptionsVisitor& v) {
    v.Tuple("at", at, {-kMaxSceneExtentM, kMaxSceneExtentM}, "where the lamp is");
    v.Tuple("colour", colour, {0, 255}, "sRGB, 0 to 255");
    v.Number("strength", strength, {0.0, 1e6}, "brightness of a white surface 1 m away");
  }
};

struct LightingOptions {
  std::array<double, 3> ambient = {175, 175, 178};
  std::array<double, 3> sky = {205, 225, 250};
  void Visit(OptionsVisitor& v) {
    v.Tuple("ambient", ambient, {0, 255}, "light from all sides, sRGB of a white ceiling");
    v.Tuple("sky", sky, {0, 255}, "sRGB where there is no surface");
  }
};

struct FileOptions {
  std::string name;
  double floor_z_m = 0.0;
  void Visit(OptionsVisitor& v) {
    v.Text("name", name, "shown in lists; default: the file's name");
    v.Number("floor_z_m", floor_z_m, {-kMaxSceneExtentM, kMaxSceneExtentM},
             "height of the floor; default: found");
  }
};

struct UseOptions {
  ItemOptions item;
  std::string group;
  void Visit(OptionsVisitor& v) {
    item.Visit(v);
    v.Text("group", group, "which group to place");
  }
};

struct MeshOptions {
  ItemOptions item;
  std::string file;
  UpAxis up = UpAxis::kAuto;
  void Visit(OptionsVisitor& v) {
    item.Visit(v);
    v.Text("file", file, "mesh file, relative to this file");
    v.Choice("up", up,
             {{UpAxis::kAuto, "auto"}, {UpAxis::kX, "x"}, {UpAxis::kY, "y"}, {UpAxis::kZ, "z"}},
             "the file's axis that points up");
  }
};

struct Group {
  std::string name;
  std::vector<Config> items;
  std::optional<TriangleMesh> mesh;  // cached once built
  bool being_built = false;
};

class SceneReader {
 public:
  SceneFile Read(const std::string& path, const std::string& parts_folder) {
    path_ = path;
    parts_folder_ = parts_folder;
    Config config = Config::FromFile(path);
    RequireKnownKeys(config);
    scene_.materials.push_back(MaterialOptions().Make("default"));
    ReadIncludes(config);
    ReadMaterials(config.Take("materials"));
    ReadGroups(config.Take("groups"));
    ReadLighting(config.Take("lighting"));
    ReadTrajectories(config.Take("trajectories"));
    scene_.mesh = BuildWhole(config.TakeMaps("shapes"));
    ReadMovers(config.Take("movers"));
    const bool has_floor = config.Has("floor_z_m");
    FileOptions options;
    options.name = std::filesystem::path(path).stem().string();
    config.Only({"name", "floor_z_m"}).Read(options);  // the other keys have been consumed
    scene_.name = options.name;
    SceneFile file{std::move(scene_), {}};
    if (has_floor) file.floor_z_m = options.floor_z_m;
    return file;
  }

 private:
  // Checked here because the reader sees only the remaining keys and could not suggest the nearest
  // name.
  static void RequireKnownKeys(const Config& config) {
    const std::vector<std::string> known = {"name",      "include",      "floor_z_m",
                                            "materials", "groups",       "shapes",
                                            "lighting",  "trajectories", "movers"};
    for (const ConfigEntry& entry : config.Entries()) {
      if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
      throw InputError(entry.place,
                       fmt::format("unknown key '{}'{}", entry.key, DidYouMean(entry.key, known)));
    }
  }

  // `include` is one file or a list of files.
  void ReadIncludes(const Config& scene) {
    if (!scene.Has("include")) return;
    const std::string place = scene.PlaceOfKey("include");
    const std::vector<std::string> names = scene.Texts("include");
    if (names.empty()) throw InputError(place, "include is '[]', must be a file or a list of them");
    for (const std::string& name : names) ReadInclude(IncludedFile(name, place));
  }

  // An included file may contain only materials and groups.
  void ReadInclude(const std::string& path) {
    Config config = Config::FromFile(path);
    for (const ConfigEntry& entry : config.Entries()) {
      if (entry.key == "materials" || entry.key == "groups") continue;
      throw InputError(entry.place, fmt::format("unknown key '{}': an included file holds only "
                                                "materials and groups",
                                                entry.key));
    }
    ReadMaterials(config.Take("materials"));
    ReadGroups(config.Take("groups"));
  }

  // Resolves a file name relative to the scene file.
  std::string ExistingFile(const std::string& key, const std::string& name,
                           const std::string& place) const {
    const auto path = std::filesystem::path(path_).parent_path() / name;
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) return path.string();
    throw InputError(place, fmt::format("{} is '{}': no such file", key, name));
  }

  std::string IncludedFile(const std::string& name, const std::string& place) const {
    std::error_code ignored;
    const auto beside = std::filesystem::path(path_).parent_path() / name;
    const auto part = std::filesystem::path(parts_folder_) / name;
    const bool is_part = !parts_folder_.empty() && !std::filesystem::exists(beside, ignored) &&
                         std::filesystem::exists(part, ignored);
    return is_part ? part.string() : ExistingFile("include", name, place);
  }

  void ReadMaterials(Config materials) {
    for (const ConfigEntry& entry : materials.Entries()) {
      const std::string& name = entry.key;
      for (const auto& known : scene_.materials) {
        if (known.name != name) continue;
        if (name == scene_.materials.front().name) {
          throw InputError(entry.place,
                           fmt::format("material name '{}' is reserved for shapes without a "
                                       "material; choose another name",
                                       name));
        }
        throw InputError(entry.place, fmt::format("material '{}' is given twice", name));
      }
      MaterialOptions options;
      materials.Take(name).Read(options);
      AddMaterial(options.Make(name));
    }
  }

  void AddMaterial(Material material) {
    if (scene_.materials.size() >= kMaxMaterials) {
      throw InputError(path_, fmt::format("more than {} materials", kMaxMaterials));
    }
    scene_.materials.push_back(std::move(material));
  }

  void ReadGroups(Config groups) {
    for (const ConfigEntry& entry : groups.Entries()) {
      const std::string& name = entry.key;
      for (const auto& known : groups_) {
        if (known.name != name) continue;
        throw InputError(entry.place, fmt::format("group '{}' is given twice", name));
      }
      groups_.push_back({name, groups.TakeMaps(name), {}, false});
    }
  }

  void ReadLighting(Config lighting) {
    for (const auto& config : lighting.TakeMaps("lights")) {
      LightOptions light;
      config.Read(light);
      if (scene_.lighting.lights.size() >= kMaxLights) {
        throw InputError(config.Place(), fmt::format("more than {} lights", kMaxLights));
      }
      PointLight point;
      point.at = Eigen::Vector3d(light.at[0], light.at[1], light.at[2]).cast<float>();
      point.intensity = static_cast<float>(light.strength) * LinearFrom255(light.colour);
      scene_.lighting.lights.push_back(point);
    }
    LightingOptions options;
    lighting.Read(options);
    scene_.lighting.ambient = LinearFrom255(options.ambient);
    scene_.lighting.sky = LinearFrom255(options.sky);
  }

  void ReadTrajectories(Config trajectories) {
    for (const auto& name : trajectories.Keys()) {
      Config spec = trajectories.Take(name);
      spec.NameSubject(fmt::format("trajectory '{}'", name));
      scene_.trajectories.emplace(name, ReadTrajectoryOptions(std::move(spec)));
    }
  }

  void ReadMovers(Config movers) {
    for (const auto& name : movers.Keys()) {
      Config spec = movers.Take(name);
      spec.NameSubject(fmt::format("mover '{}'", name));
      RequireMoverName(name, spec.Place());
      TriangleMesh mesh = BuildWhole(spec.TakeMaps("shapes"));
      if (mesh.triangles.empty()) throw InputError(spec.Place(), "has no shapes");
      scene_.movers.push_back({name, std::move(mesh), ReadMoverOptions(std::move(spec))});
    }
  }

  // Names must not collide with the experiment key `movers`: "all", "none" and "+" have a meaning
  // there.
  static void RequireMoverName(const std::string& name, const std::string& place) {
    if (name != kAllMovers && name != kNoMovers && name.find('+') == std::string::npos) return;
    throw InputError(place, fmt::format("must be called otherwise: '{}' and '{}' are all movers "
                                        "and none, + joins names",
                                        kAllMovers, kNoMovers));
  }

  // Builds the items; triangles without a material get the default one.
  TriangleMesh BuildWhole(std::vector<Config> items) {
    TriangleMesh mesh = BuildItems(std::move(items), 0);
    std::replace(mesh.material_of_triangle.begin(), mesh.material_of_triangle.end(), kInherited,
                 std::uint16_t{0});
    return mesh;
  }

  TriangleMesh BuildItems(std::vector<Config> items, int depth) {
    TriangleMesh whole;
    for (Config& config : items) {
      const BuiltItem built = BuildItem(config, depth);
      RequireStepsCounted(config);
      const std::size_t total =
          whole.triangles.size() +
          built.mesh.triangles.size() * static_cast<std::size_t>(built.item.count);
      if (total > kMaxSceneTriangles) {
        throw InputError(config.Place(), fmt::format("more than {} triangles", kMaxSceneTriangles));
      }
      for (const auto& placement : PlacementsOf(built.item)) {
        Append(whole, Transformed(built.mesh, placement));
      }
    }
    return whole;
  }

  // Steps need a `count`.
  static void RequireStepsCounted(const Config& item) {
    for (const char* key : {"step", "step_yaw_deg"}) {
      if (!item.Has(key) || item.Has("count")) continue;
      throw InputError(item.PlaceOfKey(key), fmt::format("{} needs count", key));
    }
  }

  // Builds the item in its own axes with its materials set.
  BuiltItem BuildItem(Config& config, int depth) {
    std::vector<std::string> kinds = ShapeNames();
    kinds.insert(kinds.end(), {"mesh", "use"});
    if (!config.Has("shape")) {
      throw InputError(config.Place(), fmt::format("'shape' is missing, must be one of {}",
                                                   fmt::join(kinds, ", ")));
    }
    const std::string kind = config.Text("shape");
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) {
      throw InputError(config.Place(),
                       fmt::format("shape is '{}', must be one of {}{}", kind,
                                   fmt::join(kinds, ", "), DidYouMean(kind, kinds)));
    }
    if (kind == "use") return BuildUse(config, depth);
    if (kind == "mesh") return BuildMesh(config);
    BuiltItem built = BuildShape(kind, config);
    const std::uint16_t material = MaterialIndex(built.item.material, config.Place());
    std::fill(built.mesh.material_of_triangle.begin(), built.mesh.material_of_triangle.end(),
              material);
    return built;
  }

  BuiltItem BuildUse(const Config& config, int depth) {
    UseOptions use;
    config.Read(use);
    if (depth >= kMaxGroupDepth) {
      throw InputError(config.Place(),
                       fmt::format("groups are nested deeper than {}", kMaxGroupDepth));
    }
    BuiltItem built{use.item, GroupMesh(use.group, config.Place(), depth)};
    if (!use.item.material.empty()) {
      const std::uint16_t material = MaterialIndex(use.item.material, config.Place());
      std::replace(built.mesh.material_of_triangle.begin(), built.mesh.material_of_triangle.end(),
                   kInherited, material);
    }
    return built;
  }

  const TriangleMesh& GroupMesh(const std::string& name, const std::string& place, int depth) {
    std::vector<std::string> names;
    for (Group& group : groups_) {
      names.push_back(group.name);
      if (group.name != name) continue;
      if (group.being_built) throw InputError(place, fmt::format("group '{}' uses itself", name));
      if (!group.mesh) {
        group.being_built = true;
        group.mesh = BuildItems(std::move(group.items), depth + 1);
        group.being_built = false;
      }
      return *group.mesh;
    }
    throw InputError(place,
                     fmt::format("group '{}' is not in 'groups'{}", name, DidYouMean(name, names)));
  }

  BuiltItem BuildMesh(const Config& config) {
    MeshOptions options;
    config.Read(options);
    if (options.file.empty()) throw InputError(config.Place(), "'file' is missing");
    MeshFile read = ReadMeshFile(ExistingFile("file", options.file, config.PlaceOfKey("file")), 1.0,
                                 options.up);
    if (!options.item.material.empty()) {
      const std::uint16_t material = MaterialIndex(options.item.material, config.Place());
      std::fill(read.mesh.material_of_triangle.begin(), read.mesh.material_of_triangle.end(),
                material);
    } else {
      const auto first = static_cast<std::uint16_t>(scene_.materials.size());
      for (auto& material : read.materials) AddMaterial(std::move(material));
      for (auto& material : read.mesh.material_of_triangle) {
        material = static_cast<std::uint16_t>(material + first);
      }
    }
    return {options.item, std::move(read.mesh)};
  }

  std::uint16_t MaterialIndex(const std::string& name, const std::string& place) const {
    if (name.empty()) return kInherited;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
      if (scene_.materials[i].name == name) return static_cast<std::uint16_t>(i);
      names.push_back(scene_.materials[i].name);
    }
    throw InputError(
        place, fmt::format("material '{}' is not in 'materials'{}", name, DidYouMean(name, names)));
  }

  std::string path_;
  std::string parts_folder_;  // may be ""
  Scene scene_;
  std::vector<Group> groups_;
};

}  // namespace

SceneFile ReadSceneFile(const std::string& path, const std::string& parts_folder) {
  return SceneReader().Read(path, parts_folder);
}

}  // namespace depthgrid
