// Finds settings of the mapper without effect because of its others.
#include <fmt/format.h>

#include "eval/experiment/idle_settings.h"
#include "mapper/slip_search.h"

namespace depthgrid {
namespace {

// Settings that only the other method reads. (The report's pictures are of submaps with either.)
void AddOtherMethod(const MapperOptions& mapper, IdleSettingList& idle) {
  const std::string chosen = Stands(mapper, "mapper", "method");
  const bool is_surfel = mapper.method == MapperMethod::kSurfel;
  idle.push_back({is_surfel ? "mapper.match" : "mapper.surfel", chosen});
  idle.push_back({is_surfel ? "mapper.graph" : "mapper.rounds", chosen});
}

void AddScan(const ScanOptions& scan, IdleSettingList& idle) {
  const std::string mode = Stands(scan, "mapper.scan", "mode");
  if (scan.mode != ScanMode::kRowBand) idle.push_back({"mapper.scan.band_rows", mode});
  const bool is_full = scan.mode == ScanMode::kFull;
  if (!is_full) idle.push_back({"mapper.scan.slice_half_height_m", mode});
  if (is_full && scan.slice_half_height_m > 0.0) return;
  for (const char* key : {"mapper.scan.slice_agree_sigmas", "mapper.scan.slice_lean_sigmas",
                          "mapper.scan.drop_cut_ends"}) {
    idle.push_back({key, is_full ? Stands(scan, "mapper.scan", "slice_half_height_m") : mode});
  }
}

void AddGrid(const GridOptions& grid, IdleSettingList& idle) {
  const bool keeps_walls = grid.min_surface_share == 0.0;
  const bool counts = grid.raster == RasterRule::kCounts;
  if (keeps_walls) {
    idle.push_back(
        {"mapper.grid.surface_radius_m", Stands(grid, "mapper.grid", "min_surface_share")});
  }
  if (counts) return;
  for (const char* key : {"mapper.grid.min_observations", "mapper.grid.earlier_scans"}) {
    idle.push_back({key, Stands(grid, "mapper.grid", "raster")});
  }
  // Also used for thinning walls.
  if (keeps_walls) {
    idle.push_back({"mapper.grid.hit_weight", Stands(grid, "mapper.grid", "raster")});
  }
}

void AddMatch(const ScanMatcherOptions& match, IdleSettingList& idle) {
  const std::string stages = Stands(match, "mapper.match", "stages");
  if (match.stages == MatchStages::kSearch) idle.push_back({"mapper.match.least_squares", stages});
  if (match.stages == MatchStages::kLeastSquares) idle.push_back({"mapper.match.search", stages});
  const std::string group = "mapper.match.information.";
  const std::string source = Stands(match, "mapper.match", "information.source");
  const auto add = [&](std::initializer_list<const char*> keys) {
    for (const char* key : keys) idle.push_back({group + key, source});
  };
  if (match.information.source == InformationSource::kCurvature) {
    add({"surface_window_m", "surface_window_deg", "surface_sharpness"});
  } else {
    add({"patch_m", "map_sigma_m", "wall_direction_sigma_rad"});
  }
}

void AddFusion(const FusionOptions& fusion, IdleSettingList& idle) {
  const auto add = [&](const char* key) {
    idle.push_back({key, Stands(fusion, "mapper.fusion", "mode")});
  };
  if (fusion.mode != FusionMode::kFixed && fusion.mode != FusionMode::kAdaptive) {
    add("mapper.fusion.gain");
  }
  if (fusion.mode != FusionMode::kAdaptive) add("mapper.fusion.adaptive_rate");
  if (fusion.mode != FusionMode::kLearned) {
    for (const char* key : {"mapper.fusion.judge_innovations", "mapper.rounds.again"}) add(key);
  }
  // Settings replaced by the profile's noise.
  if (fusion.slam_noise.source != SlamNoiseSource::kProfile) return;
  const std::string group = "mapper.fusion.slam_noise";
  for (const std::string& key : KeyPathsOf(fusion.slam_noise)) {
    if (key == "source") continue;
    idle.push_back({group + "." + key, Stands(fusion.slam_noise, group, "source")});
  }
}

// Settings that only the search for loops reads; relocation also uses the gates of its matches.
constexpr const char* kOfLoopSearch[] = {"every_m",          "min_way_m",          "drift_share",
                                         "turn_deg_per_m",   "min_window_m",       "max_window_m",
                                         "min_window_deg",   "max_window_deg",     "candidates",
                                         "min_correction_m", "min_correction_deg", "consenting",
                                         "consent_ways",     "likely_drift_share", "idle_searches",
                                         "most_unanswered",  "consent_m",          "consent_deg"};
// Settings that only relocation after a loss of SLAM reads.
constexpr const char* kOfRelocation[] = {
    "min_lost_s",       "min_lost_epoch_s", "window_m",      "speed_mps", "max_window_m",
    "every_m",          "every_deg",        "most_searches", "place",     "min_score",
    "max_second_score", "min_agreement",    "consenting",    "consent_m", "consent_deg"};

void AddLoops(const MapperOptions& mapper, IdleSettingList& idle) {
  const LoopOptions& loops = mapper.loops;
  const std::string use = Stands(loops, "mapper.loops", "use");
  if (!loops.use) idle.push_back({"mapper.loops.verify", use});
  if (!mapper.SearchesLoops()) {
    const std::string why = loops.search.use == LoopSearchUse::kAuto
                                ? Stands(mapper, "mapper", "method")
                                : Stands(loops, "mapper.loops", "search.use");
    for (const char* key : kOfLoopSearch) {
      idle.push_back({std::string("mapper.loops.search.") + key, why});
    }
    if (!loops.use) idle.push_back({"mapper.loops.bend_frames", use + " and " + why});
  }
  const char* slip_deg = "mapper.loops.relocation.slip_deg";
  if (!CanTellSlips(mapper.fusion)) {
    idle.push_back({slip_deg, Stands(mapper.fusion, "mapper.fusion", "gain")});
  }
  if (loops.relocation.use) return;
  for (const char* key : kOfRelocation) {
    idle.push_back({std::string("mapper.loops.relocation.") + key,
                    Stands(loops, "mapper.loops", "relocation.use")});
  }
}

void AddRounds(const RoundOptions& rounds, IdleSettingList& idle) {
  if (rounds.first_frames > 0) return;
  for (const char* key : {"growth", "last_frames", "again"}) {
    idle.push_back(
        {std::string("mapper.rounds.") + key, Stands(rounds, "mapper.rounds", "first_frames")});
  }
}

void AddKeep(const KeepOptions& keep, IdleSettingList& idle) {
  if (keep.first_frames > 0) return;
  for (const std::string& key : KeyPathsOf(keep)) {
    if (key == "first_frames") continue;
    idle.push_back({"mapper.keep." + key, Stands(keep, "mapper.keep", "first_frames")});
  }
}

}  // namespace

IdleSettingList IdleSettings(const MapperOptions& mapper) {
  IdleSettingList idle;
  AddOtherMethod(mapper, idle);
  AddFusion(mapper.fusion, idle);
  AddScan(mapper.scan, idle);
  AddGrid(mapper.grid, idle);
  AddMatch(mapper.match, idle);
  AddLoops(mapper, idle);
  AddRounds(mapper.rounds, idle);
  AddKeep(mapper.keep, idle);
  return idle;
}

}  // namespace depthgrid
