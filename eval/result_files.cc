#include "eval/result_files.h"

#include <fmt/format.h>

#include <set>

#include "eval/study.h"
#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "mapper/io/tum_folder.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

using Names = std::set<std::string>;

// depth/ or rgb/ and the stamp.
bool IsRenderedImage(const fs::path& relative) {
  const fs::path folder = relative.parent_path();
  return (folder == "depth" || folder == "rgb") && relative.extension() == ".png";
}

bool IsSamplePicture(const fs::path& relative, const char* ending) {
  const std::string name = relative.filename().string();
  const std::size_t digits = name.find_first_not_of("0123456789");
  return relative.parent_path() == "frames" && digits != 0 && digits != std::string::npos &&
         name.substr(digits) == ending;
}

bool IsMapFile(const fs::path& relative) {
  static const Names names = {"run.yaml",
                              "warnings.txt",
                              "map.yaml",
                              "map.pgm",
                              "map.scale.png",
                              "map.png",
                              "trajectory_slam.txt",
                              "trajectory_online.txt",
                              "trajectory_est.txt",
                              "trajectory_est_kitti.txt",
                              "frames.csv",
                              "scans.bin",
                              "matched.bin",
                              "pose_graph.g2o",
                              "timing.csv",
                              "timing.json",
                              "timing.js",
                              "report.html"};
  return names.contains(relative.string()) || IsSamplePicture(relative, "_depth.png");
}

// With what needs the truth or SLAM's own account, and a study's input map.
bool IsRunFile(const fs::path& relative) {
  static const Names names = {"truth_map.yaml",     "truth_map.pgm",        "observable.yaml",
                              "observable.pgm",     "trajectory_truth.txt", "loops.csv",
                              "metrics.json",       "input_map.yaml",       "input_map.pgm",
                              "input_map.scale.png"};
  return IsMapFile(relative) || names.contains(relative.string()) ||
         IsSamplePicture(relative, "_colour.png");
}

bool IsStudyFile(const fs::path& relative) {
  static const Names names = {"study.yaml", "overrides.txt", "metrics.json", "report.html"};
  if (relative.parent_path().empty()) return names.contains(relative.string());
  return IsRunFile(relative.lexically_relative(*relative.begin()));
}

bool IsAblationFile(const fs::path& relative) {
  static const Names names = {"experiment.yaml", "ablation.csv", "ablation.json", "report.html"};
  return names.contains(relative.string());
}

bool IsRenderFile(const fs::path& relative) {
  static const Names names = {"render.yaml",   "camera.yaml",     "depth.txt",
                              "rgb.txt",       "groundtruth.txt", "truth_map.yaml",
                              "truth_map.pgm", "observable.yaml", "observable.pgm"};
  return names.contains(relative.string()) || IsRenderedImage(relative);
}

bool IsSlamFile(const fs::path& relative) {
  static const Names names = {"slam.yaml", "slam.txt", "slam_final.txt", "loops.csv"};
  return names.contains(relative.string());
}

bool IsNoFile(const fs::path&) { return false; }

bool IsRunOrMap(ResultKind kind) { return kind == ResultKind::kRun || kind == ResultKind::kMap; }

// Nothing when it is no file that a command wrote: those say so.
FileRule FilesOfRun(const std::string& run_yaml) {
  try {
    const Config config = Config::FromFile(run_yaml);
    if (!config.Has("provenance")) return IsNoFile;
    return config.Has("scene") ? IsRunFile : IsMapFile;
  } catch (const InputError&) {
    return IsNoFile;
  }
}

// The runs of its cases, of which a new study may have others.
FileRule FilesOfCases(const fs::path& folder) {
  if (!fs::exists(folder / "study.yaml") || !fs::exists(folder / "overrides.txt")) return IsNoFile;
  Names cases;
  try {
    const Config config = Config::FromFile((folder / "study.yaml").string());
    for (const StudyCase& one : ReadStudyOutline(config).cases) cases.insert(one.name);
  } catch (const InputError&) {
    return IsNoFile;
  }
  return [cases](const fs::path& relative) {
    return !relative.parent_path().empty() && cases.contains(relative.begin()->string()) &&
           IsStudyFile(relative);
  };
}

// Those that a result of this kind makes at its top, apart from a study's, which are its cases'.
Names FoldersOf(ResultKind kind) {
  if (IsRunOrMap(kind)) return {"frames"};
  if (kind == ResultKind::kRender) return {"depth", "rgb"};
  return {};
}

// A run and a rendered sequence have a true map each, of one name: what is scored against the one
// that is left would be scored in the wrong room.
void RequireNoOtherTruth(const fs::path& folder, ResultKind kind) {
  const bool rendered = fs::exists(folder / "render.yaml");
  const bool has_run = !rendered && fs::exists(folder / "trajectory_truth.txt");
  const char* there = kind == ResultKind::kRun && rendered     ? "a rendered sequence"
                      : kind == ResultKind::kRender && has_run ? "a run"
                                                               : nullptr;
  if (there == nullptr) return;
  throw InputError(
      folder.string(),
      fmt::format("holds {}, whose true map would be replaced; choose another folder", there));
}

}  // namespace

FileRule FilesOf(ResultKind kind) {
  switch (kind) {
    case ResultKind::kRun:
      return IsRunFile;
    case ResultKind::kMap:
      return IsMapFile;
    case ResultKind::kStudy:
      return IsStudyFile;
    case ResultKind::kAblation:
      return IsAblationFile;
    case ResultKind::kRender:
      return IsRenderFile;
    case ResultKind::kSlam:
      return IsSlamFile;
    case ResultKind::kPage:
      return [](const fs::path& relative) { return relative == "report.html"; };
    case ResultKind::kSweep:
      break;
  }
  return IsNoFile;
}

FileRule FilesLeftBy(ResultKind kind, const std::string& folder) {
  const fs::path place = folder;
  if (kind == ResultKind::kRender && fs::exists(place / "render.yaml")) {
    const std::set<std::string> written = TumFolderWriter::FilesIn(folder);
    return [written](const fs::path& relative) { return written.contains(relative.string()); };
  }
  if (kind == ResultKind::kStudy) return FilesOfCases(place);
  if (!IsRunOrMap(kind)) return IsNoFile;
  if (!fs::exists(place / "run.yaml")) return IsNoFile;
  // Names that several commands give belong to the one that must have written them.
  const bool rendered = fs::exists(place / "render.yaml");
  const bool has_slam = fs::exists(place / "slam.yaml");
  return [of_run = FilesOfRun((place / "run.yaml").string()), rendered,
          has_slam](const fs::path& relative) {
    if (rendered && IsRenderFile(relative)) return false;
    if (has_slam && IsSlamFile(relative)) return false;
    return of_run(relative);
  };
}

void RequireOwnFiles(const std::string& folder, ResultKind kind) {
  if (!IsRunOrMap(kind) || !fs::is_directory(folder)) return;
  const fs::path place = folder;
  const FileRule written = FilesOf(kind);
  const FileRule of_run = FilesOfRun((place / "run.yaml").string());
  const bool rendered = fs::exists(place / "render.yaml");
  const bool has_slam = fs::exists(place / "slam.yaml");
  std::set<fs::path> others;  // the same one is named everywhere
  for (const fs::path& part : {place, place / "frames"}) {
    std::error_code error;  // most folders have no frames
    for (const auto& entry : fs::directory_iterator(part, error)) {
      const fs::path relative = entry.path().lexically_relative(place);
      const bool own = of_run(relative) || (rendered && IsRenderFile(relative)) ||
                       (has_slam && IsSlamFile(relative));
      if (written(relative) && !own) others.insert(entry.path());
    }
  }
  if (others.empty()) return;
  throw InputError(others.begin()->string(),
                   "is of no result of depthgrid there, and --force would overwrite it; choose "
                   "another folder");
}

void RequireNamesFree(const std::string& folder, ResultKind kind,
                      const std::vector<std::string>& cases) {
  if (!fs::is_directory(folder)) return;
  constexpr int kDeepestFile = 2;  // a study's CASE/frames/NAME
  const FileRule is_file = FilesOf(kind);
  Names folders = FoldersOf(kind);
  for (const std::string& name : cases) folders.insert({name, name + "/frames"});
  const auto options = fs::directory_options::skip_permission_denied;
  for (auto entry = fs::recursive_directory_iterator(folder, options);
       entry != fs::recursive_directory_iterator(); ++entry) {
    if (entry.depth() == kDeepestFile) entry.disable_recursion_pending();
    const fs::path relative = entry->path().lexically_relative(folder);
    const bool is_link = entry->is_symlink();
    const bool is_folder = entry->is_directory() && !is_link;
    if (is_folder && is_file(relative)) {
      throw InputError(entry->path().string(),
                       "is a folder, and a file of that name is to be written; choose another "
                       "output folder");
    }
    if (!is_folder && folders.contains(relative.string())) {
      throw InputError(entry->path().string(),
                       fmt::format("is a {}, and a folder of that name is to be written; choose "
                                   "another output folder",
                                   is_link ? "link" : "file"));
    }
  }
}

void RequireNoOtherResult(const std::string& folder, ResultKind kind) {
  struct Mark {
    const char* file;
    ResultKind kind;
    const char* what;
  };
  if (folder.empty()) return;
  const bool beside_run = kind == ResultKind::kRun || kind == ResultKind::kMap ||
                          kind == ResultKind::kRender || kind == ResultKind::kSlam;
  for (const Mark& mark : {Mark{"results.sqlite", ResultKind::kSweep, "a sweep"},
                           Mark{"study.yaml", ResultKind::kStudy, "a study"},
                           Mark{"ablation.json", ResultKind::kAblation, "an ablation"},
                           Mark{"run.yaml", ResultKind::kRun, "a run"}}) {
    if (mark.kind == kind || (mark.kind == ResultKind::kRun && beside_run)) continue;
    if (!fs::exists(fs::path(folder) / mark.file)) continue;
    throw InputError(folder, fmt::format("holds {}; choose another folder", mark.what));
  }
  RequireNoOtherTruth(folder, kind);
}

}  // namespace depthgrid
