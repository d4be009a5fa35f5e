// Accuracy with and without the wide search when SLAM is lost for seconds and returns in a new
// epoch with a pose that is metres off, or when the camera is carried elsewhere between two frames
// (docs/results.md, "Lost and found").
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

#include "bench/accuracy/laser_run.h"
#include "bench/command_line.h"
#include "bench/guarded_main.h"
#include "bench/mapper_settings.h"
#include "mapper/core/cpu_clock.h"
#include "mapper/core/level.h"
#include "mapper/core/rng.h"
#include "mapper/incremental_mapper.h"
#include "sim/laser/odometry_noise.h"

using namespace depthgrid;

namespace {

// The frames of the truth that are driven: up to `lost_at`, then from `back_at` on, optionally
// backwards.
struct Drive {
  int lost_at = 0;
  double lost_s = 10.0;
  int back_at = 0;
  bool backwards = false;
  bool carried = false;   // between two frames, and the poses go on as if it had not been
  bool localise = false;  // in a map of the whole truth
  int frames_after = 300;
  double off_m = 2.0;
  double off_deg = 60.0;
};

struct Outcome {
  double online_m = 0.0, final_m = 0.0, after_m = 0.0, worst_m = 0.0;
  double last_m = 0.0;   // online, of the last frame
  int found_after = -1;  // frames
  double worst_ms = 0.0;
};

// The driven path: `before` frames before the loss, the rest after it.
struct Driven {
  std::vector<Pose2> poses;
  std::vector<double> stamps_s;
  std::size_t before = 0;
};

Driven DrivenOf(const std::vector<Pose2>& truth, const Drive& drive) {
  Driven driven;
  for (int i = 0; i < drive.lost_at; ++i) {
    driven.poses.push_back(truth[static_cast<std::size_t>(i)]);
    driven.stamps_s.push_back(i / 30.0);
  }
  driven.before = driven.poses.size();
  const double back_s = driven.stamps_s.back() + (drive.carried ? 1.0 / 30.0 : drive.lost_s);
  for (int k = 0; k < drive.frames_after; ++k) {
    const int i = drive.back_at + (drive.backwards ? -k : k);
    if (i < 0 || i >= static_cast<int>(truth.size())) break;
    driven.poses.push_back(truth[static_cast<std::size_t>(i)]);
    driven.stamps_s.push_back(back_s + k / 30.0);
  }
  return driven;
}

// Odometry that restarts after the loss: SLAM assumes the pose where it was lost plus an offset. Of
// a carried camera it goes on with the last motion.
std::vector<Pose2> SlamOf(const Driven& driven, const Drive& drive, int seed) {
  std::vector<Pose2> slam = DisturbOdometry(driven.poses, {}, static_cast<std::uint64_t>(seed));
  RandomStream random(static_cast<std::uint64_t>(seed), RandomStage::kTest, 77);
  const double way_rad = random.Uniform(-kPi, kPi);
  Pose2 off{drive.off_m * std::cos(way_rad), drive.off_m * std::sin(way_rad),
            RadFromDeg(drive.off_deg) * (random.Uniform() < 0.5 ? 1.0 : -1.0)};
  if (drive.carried) off = Between(slam[driven.before - 2], slam[driven.before - 1]);
  const Pose2 new_from_old = slam[driven.before - 1] * off * Inverse(slam[driven.before]);
  for (std::size_t k = driven.before; k < slam.size(); ++k) slam[k] = new_from_old * slam[k];
  return slam;
}

std::vector<MappedFrame> MapOf(const LaserWorld& world, const std::vector<Pose2>& truth,
                               const MapperOptions& options, int seed) {
  IncrementalMapper mapper(options, std::nullopt);
  for (std::size_t k = 0; k < truth.size(); ++k) {
    Frame frame;
    frame.index = static_cast<int>(k);
    frame.stamp_s = static_cast<double>(k) / 30.0;
    frame.scan = SimulatedScan(world, truth[k], {}, seed, frame.index);
    frame.slam_from_camera = CameraOf(truth[k], 0.0);
    mapper.AddFrame(frame);
  }
  return mapper.Finish().mapped;
}

// The map of another day, in whose frame the truth is.
PriorMap PriorOf(const LaserWorld& world, const std::vector<Pose2>& truth,
                 const MapperOptions& options, int seed) {
  constexpr int kOtherDay = 1000;
  PriorMap prior;
  prior.frames = MapOf(world, truth, options, kOtherDay + seed);
  for (MappedFrame& frame : prior.frames) frame.frame -= static_cast<int>(truth.size());
  prior.map_from_slam = Pose2{};
  prior.fixed = true;
  return prior;
}

double ErrorM(const Pose3& map_from_camera, const Pose2& truth) {
  return (BaseOf(map_from_camera).translation() - truth.translation()).norm();
}

Outcome Map(const LaserWorld& world, const std::vector<Pose2>& truth, const Drive& drive,
            const MapperOptions& options, int seed) {
  const Driven driven = DrivenOf(truth, drive);
  const std::vector<Pose2> slam = SlamOf(driven, drive, seed);
  const auto frames = static_cast<double>(driven.poses.size());
  IncrementalMapper mapper(options, std::nullopt, {ThreadCpuUs, SteadyUs});
  if (drive.localise) mapper.StartFrom(PriorOf(world, truth, options, seed));
  Outcome outcome;
  for (std::size_t k = 0; k < driven.poses.size(); ++k) {
    Frame frame;
    frame.index = static_cast<int>(k);
    frame.stamp_s = driven.stamps_s[k];
    frame.scan = SimulatedScan(world, driven.poses[k], {}, seed, static_cast<int>(k));
    frame.slam_from_camera = CameraOf(slam[k], 0.0);
    frame.slam_epoch = drive.carried || k < driven.before ? 0 : 1;
    const FrameReport report = mapper.AddFrame(frame);
    if (report.relocated) outcome.found_after = static_cast<int>(k - driven.before);
    outcome.last_m = ErrorM(*report.map_from_camera, driven.poses[k]);
    outcome.online_m += outcome.last_m / frames;
    outcome.worst_ms = std::max(outcome.worst_ms, 1e-3 * report.times.total_us);
  }
  const MapperResult result = mapper.Finish();
  for (std::size_t k = 0; k < driven.poses.size(); ++k) {
    const double error_m = ErrorM(*result.map_from_camera[k], driven.poses[k]);
    outcome.final_m += error_m / frames;
    outcome.worst_m = std::max(outcome.worst_m, error_m);
    if (k >= driven.before) {
      outcome.after_m += error_m / static_cast<double>(driven.poses.size() - driven.before);
    }
  }
  return outcome;
}

void RequireWithin(const char* option, int frame, const std::vector<Pose2>& truth) {
  if (frame < static_cast<int>(truth.size())) return;
  throw InputError(option, "is " + std::to_string(frame) + ", of a truth of " +
                               std::to_string(truth.size()) + " poses, from 0");
}

int Measure(int argc, char** argv) {
  CLI::App app("A run whose SLAM is lost for a while and comes back elsewhere");
  std::string world_name;
  std::vector<std::string> sets;
  Drive drive;
  int seeds = 3;
  app.add_option("--world", world_name, "name without .world.txt and .truth.txt")->required();
  app.add_option("--lost-at", drive.lost_at, "frame of the truth")
      ->required()
      ->check(FromTo(2, 1e9));
  app.add_option("--lost-s", drive.lost_s, "seconds without a pose")->check(FromTo(0, 1e6));
  app.add_option("--back-at", drive.back_at, "frame of the truth where it comes back")
      ->required()
      ->check(FromTo(0, 1e9));
  app.add_flag("--backwards", drive.backwards, "the truth is driven backwards then");
  app.add_flag("--carried", drive.carried,
               "the camera is put there between two frames, and nobody tells");
  app.add_flag("--localise", drive.localise, "only localised in a map of the whole truth");
  app.add_option("--frames-after", drive.frames_after, "at most")->check(FromTo(1, 1e9));
  app.add_option("--off-m", drive.off_m, "SLAM's new pose is so far from where it was lost")
      ->check(FromTo(0, 1000));
  app.add_option("--off-deg", drive.off_deg, "and turned so far")->check(FromTo(0, 180));
  app.add_option("--seeds", seeds, "of noise and offset")->check(FromTo(1, 1e6));
  app.add_option("--set", sets, "mapper keys");
  if (!ReadCommandLine(app, argc, argv)) return 0;
  const LaserWorld world = ReadLaserWorld(world_name + ".world.txt");
  const std::vector<Pose2> truth = ReadPlanarTruth(world_name);
  RequireWithin("--lost-at", drive.lost_at, truth);
  RequireWithin("--back-at", drive.back_at, truth);
  for (const bool use : {false, true}) {
    MapperOptions options = MapperWith(sets);
    options.loops.relocation.use = use;
    for (int seed = 1; seed <= seeds; ++seed) {
      const Outcome o = Map(world, truth, drive, options, seed);
      std::printf(
          "search %-3s seed %2d online %.3f, at last %.3f, final %.4f since the loss %.4f worst "
          "%.3f m, found after %3d frames, worst frame %.0f ms\n",
          use ? "on" : "off", seed, o.online_m, o.last_m, o.final_m, o.after_m, o.worst_m,
          o.found_after, o.worst_ms);
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return depthgrid::GuardedMain(Measure, argc, argv); }
