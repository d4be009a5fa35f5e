// Arguments and functions of the subcommands of `depthgrid`. main.cc parses. The functions throw
// InputError for what the user can fix (exit code 2), and other exceptions when a run fails (exit
// code 1).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mapper/io/map_file.h"

namespace depthgrid::cli {

// Arguments of several commands; only `set` affects results.
struct CommonArguments {
  std::string output;
  std::vector<std::string> set;  // key.path=value
  int threads = 0;               // 0: as many as there are cores
  std::string cache;             // empty: none
  bool no_cache = false;
  bool force = false;
};

struct ScenesArguments {
  std::string scene;  // empty: list all shipped scenes
  std::string plan;   // a picture of the scene from above; empty: none
  bool force = false;
};
void ListScenes(const ScenesArguments& arguments);

struct RenderArguments {
  std::string scene;
  bool no_colour = false;
  CommonArguments common;
};
void Render(const RenderArguments& arguments);

// How a result is written; does not affect the result.
struct OutputArguments {
  MapMode map_mode = MapMode::kTrinary;
  std::string video;  // empty: none
};

struct RunArguments {
  std::string experiment;
  OutputArguments output;
  CommonArguments common;
};
void Run(const RunArguments& arguments);
// Every key of an experiment: default, allowed values, meaning.
std::string ExperimentKeys();

struct MapArguments {
  std::string input;
  std::string poses;
  std::string final_poses;
  std::string loops;
  std::string format;  // the three replace keys of `sequence` when not empty
  std::string camera;
  std::string world_up;
  std::string map;           // a run's folder to continue from; empty: none
  std::string start;         // the base's initial pose in that map, "X,Y,YAW_DEG"; empty: searched
  std::string start_within;  // possible error of `start`, metres; empty: the default
  bool localise = false;     // only localise in that map, without changing it
  OutputArguments output;
  CommonArguments common;
};
void Map(const MapArguments& arguments);
std::string MapKeys();

struct SlamArguments {
  std::string sequence;
  std::string profile = "orb_slam2";
  std::uint64_t seed = 1;
  CommonArguments common;
};
void Slam(const SlamArguments& arguments);

struct SlamCalibrateArguments {
  std::string experiment;
  double target_m = 0.0;
  int seeds = 400;
  std::uint64_t first_seed = 1;
  CommonArguments common;
};
void SlamCalibrate(const SlamCalibrateArguments& arguments);

struct SlamFitArguments {
  std::vector<std::string> files;  // truth, estimate, truth, estimate ...
};
void FitSlam(const SlamFitArguments& arguments);

struct EvalTrajectoryArguments {
  std::string reference;
  std::string estimate;
  std::string convention = "evo";
  double max_difference_s = -1.0;  // negative: the convention's
  double time_offset_s = 0.0;      // to be added to the estimate's stamps
  std::string errors;              // CSV to write; empty: none
  bool force = false;              // overwrite an existing file
  bool json = false;
};
void EvalTrajectory(const EvalTrajectoryArguments& arguments);

struct EvalMapArguments {
  std::string reference;
  std::string estimate;
  std::string observable;
  bool json = false;
};
void EvalMap(const EvalMapArguments& arguments);

struct SweepArguments {
  std::string sweep;               // empty with `merge`
  int jobs = 0;                    // 0: as many as there are cores
  std::string shard;               // I/N; empty: all of it
  std::vector<std::string> merge;  // folders of parts
  std::vector<std::string> reuse;  // folders of earlier sweeps
  std::string executor = "local";
  std::string slurm_options;  // for sbatch
  int slurm_tasks = 0;        // 0: as many as have enough work each
  bool dry_run = false;
  CommonArguments common;
};
void Sweep(const SweepArguments& arguments);

struct CompareArguments {
  std::string a;
  std::string b;
  std::vector<std::string> metrics;
  std::vector<std::string> where;  // of both
  std::vector<std::string> where_a;
  std::vector<std::string> where_b;
  bool json = false;
};
void CompareRuns(const CompareArguments& arguments);

struct AblateArguments {
  std::string experiment;
  int seeds = 5;
  std::uint64_t first_seed = 1;
  bool json = false;
  CommonArguments common;
};
void Ablate(const AblateArguments& arguments);

struct ReportArguments {
  std::string folder;
  std::string output;  // another folder for the page; empty: `folder`
  bool force = false;  // even if that one is not empty
};
void Report(const ReportArguments& arguments);

struct RegridArguments {
  std::string folder;
  std::string resolution;  // as given, for the message; metres
  MapMode map_mode = MapMode::kTrinary;
  bool force = false;
};
void Regrid(const RegridArguments& arguments);

}  // namespace depthgrid::cli
