#include "eval/output/run_folder.h"

#include <fmt/format.h>

#include <new>
#include <stdexcept>

#include "eval/output/build_id.h"
#include "eval/output/run_graph.h"
#include "eval/output/run_tables.h"
#include "eval/pictures/map_picture.h"
#include "eval/pictures/placed_path.h"
#include "eval/pictures/sample_pictures.h"
#include "eval/report/run_report.h"
#include "eval/run/metrics_json.h"
#include "mapper/io/config.h"
#include "mapper/io/file.h"
#include "mapper/io/map_file.h"
#include "mapper/io/mapped_files.h"
#include "mapper/io/matrix_poses.h"
#include "mapper/io/png.h"
#include "mapper/io/slam_files.h"
#include "mapper/io/trajectory_file.h"

namespace depthgrid {
namespace {

void WriteTrajectories(const OutputFolder& folder, const RunRecord& record) {
  const MappingRun& run = *record.mapping;
  WriteTrajectory(folder.File("trajectory_slam.txt"), SlamTrajectory(run));
  WriteTrajectory(folder.File("trajectory_online.txt"), OnlineTrajectory(run));
  const Trajectory final = FinalTrajectory(run);
  WriteTrajectory(folder.File("trajectory_est.txt"), final);
  WriteFile(folder.File("trajectory_est_kitti.txt"), MatrixPosesText(final));
  if (record.truth != nullptr) {
    WriteTrajectory(folder.File("trajectory_truth.txt"), record.truth->trajectory);
  }
}

// SLAM's trajectory for display: in a run with a prior map, moved into the map's frame.
Trajectory ShownSlam(const MappingRun& run) {
  const auto& mapped = run.result.mapped;
  const bool in_prior_map = !mapped.empty() && mapped.front().frame < 0;
  const Trajectory slam = SlamTrajectory(run);
  return in_prior_map ? PlacedWhereItBegins(slam, FinalTrajectory(run)) : slam;
}

void WriteMapPicture(const OutputFolder& folder, const RunRecord& record) {
  const OccupancyMap map = MapToWrite(record.mapping->result.map);
  std::vector<Path> paths;
  if (record.truth != nullptr) {
    paths.push_back({"truth", palette::kTruth, record.truth->trajectory, PathStyle::kBeneath});
  }
  const char* input = record.mapping->camera ? "slam" : "odometry";
  paths.push_back({input, palette::kSlam, ShownSlam(*record.mapping)});
  paths.push_back({"estimate", palette::kEstimate, FinalTrajectory(*record.mapping)});
  const GridGeometry part = ShownPart(StatesOf(map), paths);
  WriteRgbPng(folder.File("map.png"), AnnotatedMap(PictureOf(map, part), part, paths));
}

std::string Lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

// For the heading of the page, as the scene may be gone when that is written again.
struct SceneRecord {
  std::string name;
  void Visit(OptionsVisitor& v) { v.Text("scene_name", name, "the scene's name"); }
};

}  // namespace

std::string MetricsOf(const RunScores& scores) {
  return MetricsJson({{"slam", scores.slam}, {"online", scores.online}, {"est", scores.est}},
                     &scores.map, &scores.consistency);
}

RunRecord RecordOf(const ExperimentOptions& options, const World& world, const SlamOutput& slam,
                   const MappingRun& mapping, const TruthRecord& truth, const RunScores& scores) {
  RunRecord record;
  record.settings = ToYaml(options);
  record.warnings = mapping.warnings;
  record.warnings.insert(record.warnings.end(), world.path_doubts.begin(), world.path_doubts.end());
  record.mapping = &mapping;
  record.slam = &slam;
  record.truth = &truth;
  record.scores = &scores;
  record.world = &world;
  record.scan = options.mapper.scan;
  return record;
}

std::string Provenance(const World* world) {
  std::string yaml = "provenance:\n";
  yaml += fmt::format("  version: {}\n  build: {}\n", DEPTHGRID_VERSION, BuildId());
  if (world != nullptr) {
    yaml += "  " + ToYaml(SceneRecord{world->scene.name});
    yaml += fmt::format("  scene_hash: {}\n  trajectory_hash: {}\n", world->hashes.scene,
                        world->hashes.trajectory);
  }
  yaml += fmt::format("  instruction_set: {}\n", DEPTHGRID_ARCH);
  if (world != nullptr) {
    yaml += fmt::format("  ray_instruction_set: {}\n",
                        world->rays.isa() == RayIsa::kAvx512 ? "avx512" : "avx2");
  }
  return yaml;
}

void WriteRunFolder(const OutputFolder& folder, const RunRecord& record) {
  const Trajectory* truth = record.truth != nullptr ? &record.truth->trajectory : nullptr;
  std::string provenance = Provenance(record.world);
  if (!record.map_hash.empty()) provenance += fmt::format("  map_hash: {}\n", record.map_hash);
  WriteFile(folder.File("run.yaml"), record.settings + provenance);
  WriteFile(folder.File("warnings.txt"), Lines(record.warnings));
  WriteMap(folder.File("map.yaml"), record.mapping->result.map, record.map_mode);
  WriteMapPicture(folder, record);
  WriteTrajectories(folder, record);
  if (record.truth != nullptr) WriteTruthMaps(folder.work().string(), *record.truth);
  if (record.scores != nullptr) {
    WriteFile(folder.File("metrics.json"), MetricsOf(*record.scores));
  }
  if (record.slam != nullptr) WriteFile(folder.File("loops.csv"), LoopsText(*record.slam));
  WriteFile(folder.File("frames.csv"), FramesCsv(*record.mapping, truth));
  WriteMapped(folder.work().string(), record.mapping->result.mapped);
  WriteFile(folder.File("pose_graph.g2o"), G2oText(GraphOf(*record.mapping)));
  WriteDepthPictures(folder.work().string(), *record.mapping, record.scan);
  WriteFile(folder.File("timing.csv"), TimingCsv(*record.mapping));
  WriteRunReport(folder.work().string(),
                 {folder.work().string()});  // from the files written so far
  // Last, because it includes the peak memory.
  WriteFile(folder.File("timing.json"),
            TimingJson(*record.mapping, record.wall_s_total, record.cpu_s_total));
}

std::optional<std::string> AddColour(const std::string& folder, const RunRecord& record) {
  try {
    WriteColourPictures(folder, *record.mapping, *record.world);
  } catch (const std::bad_alloc&) {
    return "pictures in colour are left out: out of memory";
  } catch (const std::runtime_error& error) {
    return fmt::format("pictures in colour are left out: {}", error.what());
  }
  try {
    WriteRunReport(folder, {folder});
  } catch (const std::bad_alloc&) {
    return "the page is without the pictures in colour: out of memory";
  } catch (const std::runtime_error& error) {
    return fmt::format("the page is without the pictures in colour: {}", error.what());
  }
  return std::nullopt;
}

}  // namespace depthgrid
