#include "eval/study/study_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

#include "eval/experiment/changed_settings.h"
#include "eval/experiment/study.h"
#include "eval/files/json_text_impl.h"
#include "eval/files/run_files.h"
#include "eval/pictures/map_picture.h"
#include "eval/report/report_json_impl.h"
#include "eval/report/web_assets.h"
#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using Json = ReportJson;

constexpr std::size_t kMostPathPoints = 450;  // two per second of a 900-frame path

struct CaseFiles {
  StudyCase head;
  RunFiles run;
  std::string scene;       // the room; cases of the same room are shown side by side
  std::string scene_name;  // its own name, or its file's
  std::string pose_source;
};

CaseFiles ReadCase(const std::string& folder, const StudyCase& head) {
  CaseFiles files{head, ReadRunFolder(folder + "/" + head.name), "", "", ""};
  const Config settings = Config::FromText(files.run.settings, head.name + "/run.yaml");
  files.scene = SettingOf(settings, "scene");
  files.scene_name = SettingOf(settings, "provenance.scene_name");
  if (files.scene_name.empty()) files.scene_name = fs::path(files.scene).stem().string();
  files.pose_source = PoseSourceOf(settings);
  return files;
}

// The file without the folders that it shares with all other scenes' files.
std::string ShortPath(const std::string& scene, const std::vector<CaseFiles>& cases) {
  std::size_t common = scene.rfind('/') + 1;  // 0 without a folder
  for (const CaseFiles& other : cases) {
    const auto end =
        std::mismatch(scene.begin(), scene.end(), other.scene.begin(), other.scene.end());
    const auto equal = static_cast<std::size_t>(end.first - scene.begin());
    if (other.scene == scene) continue;
    common = std::min(common, equal == 0 ? 0 : scene.rfind('/', equal - 1) + 1);
  }
  return scene.substr(common);
}

// A short name for a case's room, unique among all. Maps with different cell sizes cannot be
// compared side by side and so count as different rooms.
std::string RoomName(const CaseFiles& c, const std::vector<CaseFiles>& cases) {
  const double cell_m = c.run.map.geometry.resolution_m;
  bool is_name_shared = false;
  bool has_other_cells = false;
  for (const CaseFiles& other : cases) {
    is_name_shared |= other.scene != c.scene && other.scene_name == c.scene_name;
    has_other_cells |= other.scene == c.scene && other.run.map.geometry.resolution_m != cell_m;
  }
  const std::string name = is_name_shared
                               ? fmt::format("{} ({})", c.scene_name, ShortPath(c.scene, cases))
                               : c.scene_name;
  return has_other_cells ? fmt::format("{}, cells of {} m", name, cell_m) : name;
}

void NameRooms(std::vector<CaseFiles>& cases) {
  std::vector<std::string> names;
  for (const CaseFiles& c : cases) names.push_back(RoomName(c, cases));
  for (std::size_t i = 0; i < cases.size(); ++i) cases[i].scene = names[i];
}

// "Study of den and office", for a file without a title.
std::string TitleOfRooms(const std::vector<CaseFiles>& cases) {
  std::vector<std::string> names;
  for (const CaseFiles& c : cases) {
    const bool is_known = std::find(names.begin(), names.end(), c.scene_name) != names.end();
    if (!is_known) names.push_back(c.scene_name);
  }
  return fmt::format("Study of {}", fmt::join(names, " and "));
}

// Corners of the path of the camera on the floor, [x, y, x, y, ...] in metres.
Json PathJson(const Trajectory& trajectory) {
  Json json = Json::array();
  const std::size_t step = std::max<std::size_t>(1, trajectory.size() / kMostPathPoints);
  for (std::size_t i = 0; i < trajectory.size(); i += step) {
    const Pose2 base = BaseOf(trajectory[i].world_from_camera);
    json.push_back(Rounded(base.x_m, 3));
    json.push_back(Rounded(base.y_m, 3));
  }
  return json;
}

// One rectangle for all maps of a room, so that they can be compared side by side.
std::map<std::string, GridGeometry> RoomParts(const std::vector<CaseFiles>& cases) {
  std::map<std::string, GridGeometry> parts;
  const auto add = [&](const std::string& scene, const StateMap& map) {
    const GridGeometry part = KnownPart(map, kMapMarginCells);
    const auto [entry, is_new] = parts.emplace(scene, part);
    if (!is_new) entry->second = Union(entry->second, part);
  };
  for (const CaseFiles& c : cases) {
    add(c.scene, c.run.map);
    if (c.run.input_map) add(c.scene, *c.run.input_map);
    if (c.run.truth_map) add(c.scene, *c.run.truth_map);
    GridGeometry& part = parts.at(c.scene);
    part = OrAllOf(c.run.map, part);
  }
  return parts;
}

Json RoomJson(const CaseFiles& c, const GridGeometry& part) {
  Json json;
  json["scene"] = c.scene;
  json["resolution"] = part.resolution_m;
  json["origin"] = {part.OriginM().x(), part.OriginM().y()};
  json["width"] = part.width_cells;
  json["height"] = part.height_cells;
  if (c.run.truth_map) json["truth"] = PngUri(PictureOf(*c.run.truth_map, part));
  return json;
}

Json CaseJson(const CaseFiles& c, const GridGeometry& part, const Json& metrics) {
  Json json;
  json["name"] = c.head.name;
  json["scene"] = c.scene;
  json["pose_source"] = c.pose_source;
  json["metrics"] = metrics;
  json["output_map"] = PngUri(PictureOf(c.run.map, part));
  if (c.run.input_map) json["input_map"] = PngUri(PictureOf(*c.run.input_map, part));
  if (c.run.truth) json["true_path"] = PathJson(*c.run.truth);
  json["input_path"] = PathJson(c.run.slam);
  json["output_path"] = PathJson(c.run.est);
  return json;
}

// The settings in which the cases differ, without scene and SLAM, which the page shows anyway.
Json DifferencesJson(const std::vector<CaseFiles>& cases) {
  std::vector<Config> settings;
  for (const CaseFiles& c : cases) {
    settings.push_back(Config::FromText(c.run.settings, c.head.name + "/run.yaml"));
    // 0: as many as the path has, which another case may have as a number.
    if (SettingOf(settings.back(), "frames") == "0") {
      settings.back().Set("frames", std::to_string(c.run.frames.rows));
    }
  }
  Json json = Json::array();
  for (const DifferingSetting& setting : DifferingSettings(settings)) {
    json.push_back({{"key", setting.key}, {"values", setting.values}});
  }
  return json;
}

// The command line's overrides, one line each; folders of earlier versions do not have them.
std::vector<std::string> OverridesIn(const std::string& folder) {
  const std::string path = folder + "/overrides.txt";
  std::vector<std::string> overrides;
  if (!fs::exists(path)) return overrides;
  std::istringstream lines(ReadFile(path));
  for (std::string line; std::getline(lines, line);) overrides.push_back(line);
  return overrides;
}

Json StudyJson(const StudyOutline& study, const std::vector<std::string>& overrides,
               const std::vector<CaseFiles>& cases, const Json& metrics) {
  const std::map<std::string, GridGeometry> parts = RoomParts(cases);
  Json json;
  json["notes"] = Json::array();
  for (const StudyNote& note : study.notes) {
    json["notes"].push_back({{"title", note.title}, {"text", note.text}});
  }
  const StudyHeadings& headings = study.headings;
  json["headings"] = {{"table", headings.table},
                      {"maps", headings.maps},
                      {"paths", headings.paths},
                      {"notes", headings.notes},
                      {"published", headings.published}};
  json["differences"] = DifferencesJson(cases);
  json["overrides"] = overrides;
  json["rooms"] = Json::array();
  json["cases"] = Json::array();
  for (const CaseFiles& c : cases) {
    const auto known = [&](const Json& room) { return room["scene"] == c.scene; };
    if (std::none_of(json["rooms"].begin(), json["rooms"].end(), known)) {
      json["rooms"].push_back(RoomJson(c, parts.at(c.scene)));
    }
    json["cases"].push_back(CaseJson(c, parts.at(c.scene), metrics.at("cases").at(c.head.name)));
  }
  return json;
}

}  // namespace

bool IsStudyFolder(const std::string& folder) { return fs::exists(folder + "/study.yaml"); }

void WriteStudyReport(const std::string& folder, const ReportPlace& place) {
  if (!IsStudyFolder(folder)) throw InputError(folder, "is no study's folder: no study.yaml");
  const StudyOutline outline = ReadStudyOutline(Config::FromFile(folder + "/study.yaml"));
  std::vector<CaseFiles> cases;
  for (const StudyCase& head : outline.cases) cases.push_back(ReadCase(folder, head));
  NameRooms(cases);
  const std::string title = outline.title.empty() ? TitleOfRooms(cases) : outline.title;
  try {
    const Json metrics = Json::parse(ReadFile(folder + "/metrics.json"));
    Json json = StudyJson(outline, OverridesIn(folder), cases, metrics);
    json["back"] = place.back;
    WriteFile(place.into + "/report.html", FillPage("study.html", title, JsonText(json)));
  } catch (const Json::exception&) {
    throw InputError(folder + "/metrics.json", "does not hold the study's scores");
  }
}

}  // namespace depthgrid
