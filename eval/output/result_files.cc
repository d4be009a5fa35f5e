#include "eval/output/result_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "eval/experiment/study.h"
#include "eval/files/one_result.h"
#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "mapper/io/tum_folder.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

using Names = std::set<std::string>;

// Images have the path depth/ or rgb/ and the stamp with six decimals.
bool IsRenderedImage(const fs::path& relative) {
  const fs::path folder = relative.parent_path();
  if ((folder != "depth" && folder != "rgb") || relative.extension() != ".png") return false;
  constexpr std::size_t kDecimals = 6;
  const std::string stamp = relative.stem().string();
  const std::size_t point = stamp.find('.');
  return point != std::string::npos && stamp.size() == point + 1 + kDecimals &&
         stamp.find_first_not_of("-.0123456789") == std::string::npos;
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
                              "matched.next.bin",
                              "pose_graph.g2o",
                              "timing.csv",
                              "timing.json",
                              "timing.js",
                              "report.html"};
  return names.contains(relative.string()) || IsSamplePicture(relative, "_depth.png");
}

// Includes files that need ground truth or SLAM's events, and a study's input map.
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

// Whether a command wrote the file: those of runs, maps and renders contain provenance.
bool HasProvenance(const fs::path& yaml) {
  try {
    return fs::is_regular_file(yaml) && Config::FromFile(yaml.string()).Has("provenance");
  } catch (const InputError&) {
    return false;
  }
}

// The files of the run or map in the folder, if there is one.
FileRule FilesOfRun(const fs::path& folder) {
  const fs::path run_yaml = folder / "run.yaml";
  if (!HasProvenance(run_yaml)) return IsNoFile;
  return Config::FromFile(run_yaml.string()).Has("scene") ? IsRunFile : IsMapFile;
}

// The cases of the study in the folder; empty if there is none.
Names CasesIn(const fs::path& folder) {
  if (!fs::exists(folder / "study.yaml") || !fs::exists(folder / "overrides.txt")) return {};
  try {
    Names cases;
    const Config config = Config::FromFile((folder / "study.yaml").string());
    for (const StudyCase& one : ReadStudyOutline(config).cases) cases.insert(one.name);
    return cases;
  } catch (const InputError&) {
    return {};
  }
}

// The files of the cases of the study in the folder; a new study may have other cases.
FileRule FilesOfCases(const fs::path& folder) {
  std::map<std::string, FileRule> cases;
  for (const std::string& name : CasesIn(folder)) cases[name] = FilesOfRun(folder / name);
  return [cases](const fs::path& relative) {
    if (relative.parent_path().empty()) return false;
    const auto found = cases.find(relative.begin()->string());
    return found != cases.end() && found->second(relative.lexically_relative(found->first));
  };
}

bool AllExist(const fs::path& folder, const Names& names) {
  return std::all_of(names.begin(), names.end(),
                     [&](const std::string& name) { return fs::exists(folder / name); });
}

// The files of all results in the folder, each recognised by files that a user would not have by
// chance.
FileRule FilesOfResultsIn(const fs::path& folder) {
  std::vector<FileRule> rules = {FilesOfRun(folder), FilesOfCases(folder)};
  if (HasProvenance(folder / "render.yaml")) rules.emplace_back(IsRenderFile);
  if (AllExist(folder, {"slam.yaml", "slam.txt"})) rules.emplace_back(IsSlamFile);
  if (AllExist(folder, {"ablation.csv", "ablation.json"})) rules.emplace_back(IsAblationFile);
  if (!CasesIn(folder).empty()) {
    rules.emplace_back([](const fs::path& relative) {
      return relative.parent_path().empty() && IsStudyFile(relative);
    });
  }
  return [rules](const fs::path& relative) {
    return std::any_of(rules.begin(), rules.end(),
                       [&](const FileRule& rule) { return rule(relative); });
  };
}

// The folders that a result of this kind makes.
Names FoldersOf(ResultKind kind, const std::vector<std::string>& cases) {
  if (IsRunOrMap(kind)) return {"frames"};
  if (kind == ResultKind::kRender) return {"depth", "rgb"};
  Names folders;
  for (const std::string& name : cases) folders.insert({name, name + "/frames"});
  return folders;
}

// A run and a rendered sequence both have a true map, of the same name; results of the other would
// be scored against the wrong room.
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

const char* MarkOf(ResultKind kind) {
  switch (kind) {
    case ResultKind::kRun:
    case ResultKind::kMap:
      return "run";
    case ResultKind::kStudy:
      return kMarkOfStudy;
    case ResultKind::kAblation:
      return "ablation";
    case ResultKind::kSweep:
      return "sweep";
    case ResultKind::kRender:
      return kMarkOfRender;
    case ResultKind::kSlam:
      return kMarkOfSlam;
    case ResultKind::kPage:
      break;
  }
  return "page";
}

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
      return [](const fs::path& relative) {
        static const Names names = {"report.html", "timing.js", "experiment.yaml",
                                    "sweep_again.yaml"};
        return names.contains(relative.string());
      };
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
  // Names that several commands use are attributed to the one that must have written them.
  const bool rendered = fs::exists(place / "render.yaml");
  const bool has_slam = fs::exists(place / "slam.yaml");
  return [of_run = FilesOfRun(place), rendered, has_slam](const fs::path& relative) {
    if (rendered && IsRenderFile(relative)) return false;
    if (has_slam && IsSlamFile(relative)) return false;
    return of_run(relative);
  };
}

void RequireOwnFiles(const std::string& folder, ResultKind kind,
                     const std::vector<std::string>& cases) {
  if (!fs::is_directory(folder)) return;
  const fs::path place = folder;
  const Names known_cases = CasesIn(place);
  for (const std::string& name : cases) {
    if (known_cases.contains(name) || !HasProvenance(place / name / "run.yaml")) continue;
    throw InputError((place / name).string(),
                     "holds a run that is no case of a study there; choose another folder");
  }
  const FileRule written = FilesOf(kind);
  const FileRule own = FilesOfResultsIn(place);
  Names parts = FoldersOf(kind, cases);
  parts.insert("");
  std::set<fs::path> others;  // so that messages do not depend on the file system's order
  for (const std::string& part : parts) {
    std::error_code error;  // most folders have no frames
    for (const auto& entry : fs::directory_iterator(place / part, error)) {
      const fs::path relative = entry.path().lexically_relative(place);
      if (written(relative) && !own(relative)) others.insert(entry.path());
    }
  }
  if (others.empty()) return;
  throw InputError(others.begin()->string(),
                   "belongs to no depthgrid result there, and --force would overwrite it; choose "
                   "another folder");
}

void RequireNamesFree(const std::string& folder, ResultKind kind,
                      const std::vector<std::string>& cases) {
  if (!fs::is_directory(folder)) return;
  constexpr int kDeepestFile = 2;  // a study's CASE/frames/NAME
  const FileRule is_file = FilesOf(kind);
  const Names folders = FoldersOf(kind, cases);
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
