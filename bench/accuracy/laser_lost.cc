// SLAM is lost for seconds and comes back in a new epoch with a pose that is metres off: how well
// is the run mapped with and without the wide search? (docs/results.md, "Lost and found")
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

#include "bench/accuracy/laser_run.h"
#include "bench/guarded_main.h"
#include "mapper/core/cpu_clock.h"
#include "mapper/core/level.h"
#include "mapper/core/rng.h"
#include "mapper/incremental_mapper.h"
#include "mapper/io/config.h"
#include "sim/odometry_noise.h"

using namespace depthgrid;

namespace {

// Which frames of the truth are driven: up to `lost_at`, then from `back_at`, backwards if so.
struct Drive {
  int lost_at = 0;
  double lost_s = 10.0;
  int back_at = 0;
  bool backwards = false;
  int frames_after = 300;
  double off_m = 2.0;
  double off_deg = 60.0;
};

struct Outcome {
  double online_m = 0.0, final_m = 0.0, after_m = 0.0, worst_m = 0.0;
  int found_after = -1;  // frames
  double worst_ms = 0.0;
};

Outcome Map(const LaserWorld& world, const std::vector<Pose2>& truth, const Drive& drive,
            const MapperOptions& options, int seed) {
  std::vector<Pose2> driven;
  std::vector<double> stamps_s;
  for (int i = 0; i < drive.lost_at; ++i) {
    driven.push_back(truth[static_cast<std::size_t>(i)]);
    stamps_s.push_back(i / 30.0);
  }
  const std::size_t before = driven.size();
  const double back_s = stamps_s.back() + drive.lost_s;
  for (int k = 0; k < drive.frames_after; ++k) {
    const int i = drive.back_at + (drive.backwards ? -k : k);
    if (i < 0 || i >= static_cast<int>(truth.size())) break;
    driven.push_back(truth[static_cast<std::size_t>(i)]);
    stamps_s.push_back(back_s + k / 30.0);
  }
  const LaserOptions laser;
  const std::vector<Pose2> odometry = DisturbOdometry(driven, {}, static_cast<std::uint64_t>(seed));
  RandomStream random(static_cast<std::uint64_t>(seed), RandomStage::kTest, 77);
  const double way_rad = random.Uniform(-kPi, kPi);
  const Pose2 off{drive.off_m * std::cos(way_rad), drive.off_m * std::sin(way_rad),
                  RadFromDeg(drive.off_deg) * (random.Uniform() < 0.5 ? 1.0 : -1.0)};
  // SLAM believes to be where it was lost, but for this.
  const Pose2 new_slam = odometry[before - 1] * off * Inverse(odometry[before]);
  IncrementalMapper mapper(options, std::nullopt, {ThreadCpuUs, SteadyUs});
  Outcome outcome;
  for (std::size_t k = 0; k < driven.size(); ++k) {
    Frame frame;
    frame.index = static_cast<int>(k);
    frame.stamp_s = stamps_s[k];
    frame.scan = SimulatedScan(world, driven[k], laser, seed, static_cast<int>(k));
    frame.slam_from_camera = CameraOf(k < before ? odometry[k] : new_slam * odometry[k], 0.0);
    frame.slam_epoch = k < before ? 0 : 1;
    const FrameReport report = mapper.AddFrame(frame);
    if (report.relocated) outcome.found_after = static_cast<int>(k - before);
    outcome.online_m +=
        (BaseOf(*report.map_from_camera).translation() - driven[k].translation()).norm() /
        static_cast<double>(driven.size());
    outcome.worst_ms = std::max(outcome.worst_ms, 1e-3 * report.times.total_us);
  }
  const MapperResult result = mapper.Finish();
  for (std::size_t k = 0; k < driven.size(); ++k) {
    const double error_m =
        (BaseOf(*result.map_from_camera[k]).translation() - driven[k].translation()).norm();
    outcome.final_m += error_m / static_cast<double>(driven.size());
    outcome.worst_m = std::max(outcome.worst_m, error_m);
    if (k >= before) outcome.after_m += error_m / static_cast<double>(driven.size() - before);
  }
  return outcome;
}

}  // namespace

namespace {
int Measure(int argc, char** argv) {
  CLI::App app("A run whose SLAM is lost for a while and comes back elsewhere");
  std::string world_name;
  std::vector<std::string> sets;
  Drive drive;
  int seeds = 3;
  app.add_option("--world", world_name, "name without .world.txt and .truth.txt")->required();
  app.add_option("--lost-at", drive.lost_at, "frame of the truth")->required();
  app.add_option("--lost-s", drive.lost_s, "seconds without a pose");
  app.add_option("--back-at", drive.back_at, "frame of the truth where it comes back")->required();
  app.add_flag("--backwards", drive.backwards, "the truth is driven backwards then");
  app.add_option("--frames-after", drive.frames_after, "at most");
  app.add_option("--off-m", drive.off_m, "SLAM's new pose is so far from where it was lost");
  app.add_option("--off-deg", drive.off_deg, "and turned so far");
  app.add_option("--seeds", seeds, "of noise and offset");
  app.add_option("--set", sets, "mapper keys");
  CLI11_PARSE(app, argc, argv);
  const LaserWorld world = ReadLaserWorld(world_name + ".world.txt");
  const std::vector<Pose2> truth = ReadPlanarTruth(world_name);
  for (const bool use : {false, true}) {
    MapperOptions options;
    options.method = MapperMethod::kSurfel;
    options.fusion.mode = FusionMode::kLearned;
    options.loops.relocation.use = use;
    Config config;
    for (const std::string& set : sets) config.Set(set);
    config.Read(options);
    for (int seed = 1; seed <= seeds; ++seed) {
      const Outcome o = Map(world, truth, drive, options, seed);
      std::printf(
          "search %-3s seed %2d online %.3f final %.4f since the loss %.4f worst %.3f m, found "
          "after %3d frames, worst frame %.0f ms\n",
          use ? "on" : "off", seed, o.online_m, o.final_m, o.after_m, o.worst_m, o.found_after,
          o.worst_ms);
    }
  }
  return 0;
}
}  // namespace

int main(int argc, char** argv) { return depthgrid::GuardedMain(Measure, argc, argv); }
