#include "eval/experiment/shipped.h"

#include <algorithm>
#include <filesystem>

#include "mapper/core/error.h"
#include "mapper/io/config.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

const char* WordFor(ShippedKind kind) {
  switch (kind) {
    case ShippedKind::kScene:
      return "scene";
    case ShippedKind::kExperiment:
      return "experiment";
    case ShippedKind::kSweep:
      return "sweep";
  }
  Broken("a shipped file is of one of the kinds");
}

// Scenes, experiments and sweeps are never folders.
[[noreturn]] void RefuseFolder(const std::string& folder, ShippedKind kind) {
  switch (kind) {
    case ShippedKind::kScene:
      throw InputError(folder, "is a folder, must be a scene or mesh file");
    case ShippedKind::kExperiment:
      if (fs::exists(fs::path(folder) / "run.yaml")) {
        throw InputError(folder, "is a folder; the run.yaml in it can be run again");
      }
      throw InputError(folder,
                       "is a folder, must be an experiment's YAML file; `depthgrid map` takes "
                       "folders of recordings");
    case ShippedKind::kSweep:
      throw InputError(folder, "is a folder, must be a sweep's YAML file");
  }
  Broken("a shipped file is of one of the kinds");
}

}  // namespace

bool IsFileName(const std::string& name) {
  return name.find('/') != std::string::npos || fs::path(name).has_extension();
}

std::string ShippedFolder(ShippedKind kind) {
  const fs::path executable = fs::read_symlink("/proc/self/exe");
  const fs::path scenes = executable.parent_path().parent_path() / "share/depthgrid/scenes";
  switch (kind) {
    case ShippedKind::kScene:
      return scenes.string();
    case ShippedKind::kExperiment:
      return (scenes / "experiments").string();
    case ShippedKind::kSweep:
      return (scenes / "sweeps").string();
  }
  Broken("a shipped file is of one of the kinds");
}

std::vector<std::string> ShippedNames(ShippedKind kind) {
  const std::string folder = ShippedFolder(kind);
  if (!fs::is_directory(folder)) {
    throw InputError(ShippedFolder(ShippedKind::kScene),
                     "the shipped scenes were not found here; a copied program needs its "
                     "share/depthgrid beside its folder");
  }
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string ResolveName(const std::string& name, ShippedKind kind, const std::string& base_folder) {
  const fs::path path = fs::path(base_folder) / name;  // an absolute name replaces the base
  if (IsFileName(name)) {
    if (!fs::exists(path)) throw InputError(path.string(), "no such file");
    if (fs::is_directory(path)) RefuseFolder(path.string(), kind);
    return path.string();
  }
  const std::vector<std::string> names = ShippedNames(kind);
  if (std::find(names.begin(), names.end(), name) != names.end()) {
    return (fs::path(ShippedFolder(kind)) / (name + ".yaml")).string();
  }
  for (const ShippedKind other : {ShippedKind::kExperiment, ShippedKind::kSweep}) {
    const std::vector<std::string> others = ShippedNames(other);
    if (std::find(others.begin(), others.end(), name) == others.end()) continue;
    throw InputError(name, std::string("is a shipped ") + WordFor(other) + ", no " + WordFor(kind) +
                               "; see `depthgrid scenes`");
  }
  std::error_code error;  // such as of a name that is too long
  if (fs::is_directory(path, error)) RefuseFolder(path.string(), kind);
  std::string hint = DidYouMean(name, names);
  if (hint.empty()) hint = "; see `depthgrid scenes`";
  if (fs::exists(path, error)) hint = "; the file is ./" + name;
  throw InputError(name, std::string("no shipped ") + WordFor(kind) + " has this name" + hint);
}

Scene LoadNamedScene(const std::string& name) {
  return LoadScene(ResolveName(name, ShippedKind::kScene), ShippedFolder(ShippedKind::kScene));
}

std::string ResolveNameAt(const std::string& place, const std::string& name, ShippedKind kind,
                          const std::string& base_folder) {
  try {
    return ResolveName(name, kind, base_folder);
  } catch (const InputError& error) {
    throw InputError(place, error.what());
  }
}

}  // namespace depthgrid
