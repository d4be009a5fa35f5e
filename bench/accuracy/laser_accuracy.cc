// Accuracy of `depthgrid map` on laser worlds over many seeds: the tables of docs/results.md,
// "Laser logs". Results, not times.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <future>
#include <map>
#include <string>

#include "bench/accuracy/laser_run.h"
#include "bench/accuracy/people.h"
#include "bench/guarded_main.h"
#include "eval/consistency.h"
#include "mapper/core/cpu_clock.h"
#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"
#include "mapper/io/config.h"
#include "sim/odometry_noise.h"

using namespace depthgrid;

namespace {
struct Scores {
  double mean = 0, ate = 0, max = 0;
};
Scores Score(const std::vector<Pose2>& truth, const std::vector<Pose2>& est) {
  Scores s;
  const double n = static_cast<double>(truth.size());
  Eigen::Vector2d mt(0, 0), me(0, 0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double e = (truth[i].translation() - est[i].translation()).norm();
    s.mean += e / n;
    s.max = std::max(s.max, e);
    mt += truth[i].translation() / n;
    me += est[i].translation() / n;
  }
  double a = 0, b = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Vector2d p = est[i].translation() - me, q = truth[i].translation() - mt;
    a += p.dot(q);
    b += p.x() * q.y() - p.y() * q.x();
  }
  const Pose2 r{0, 0, std::atan2(b, a)};
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Vector2d p = est[i].translation() - me, q = truth[i].translation() - mt;
    s.ate += (r * p - q).squaredNorm() / n;
  }
  s.ate = std::sqrt(s.ate);
  return s;
}

// The prior errs from a later frame on only.
std::vector<Pose2> PerfectAtFirst(const std::vector<Pose2>& truth,
                                  const std::vector<Pose2>& odometry, int perfect_frames) {
  std::vector<Pose2> later = {truth.front()};
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const std::vector<Pose2>& moved = static_cast<int>(k) < perfect_frames ? truth : odometry;
    later.push_back(later.back() * Between(moved[k - 1], moved[k]));
  }
  return later;
}

// How the prior errs.
struct PriorOptions {
  OdometryOptions odometry;
  int perfect_frames = 0;  // the first
  int slips = 0;           // evenly spread, to either side in turn
  double slip_deg = 5.0;   // within a frame
  double slip_m = 0.0;     // and forward
};

std::vector<Pose2> WithSlips(const std::vector<Pose2>& odometry, const PriorOptions& prior) {
  std::vector<Pose2> slipped = {odometry.front()};
  const auto slips_before = [&](std::size_t k) {
    return k * static_cast<std::size_t>(prior.slips + 1) / odometry.size();
  };
  for (std::size_t k = 1; k < odometry.size(); ++k) {
    Pose2 motion = Between(odometry[k - 1], odometry[k]);
    if (slips_before(k) > slips_before(k - 1)) {
      const double side = slips_before(k) % 2 == 1 ? 1.0 : -1.0;
      motion = motion * Pose2{side * prior.slip_m, 0.0, side * RadFromDeg(prior.slip_deg)};
    }
    slipped.push_back(slipped.back() * motion);
  }
  return slipped;
}

std::vector<Pose2> PriorOf(const std::vector<Pose2>& truth, const PriorOptions& prior, int seed) {
  const auto drifting = DisturbOdometry(truth, prior.odometry, static_cast<std::uint64_t>(seed));
  return WithSlips(PerfectAtFirst(truth, drifting, prior.perfect_frames), prior);
}

struct Run {
  Scores prior, online, final;
  std::vector<ChiSquareSample> nis, nees;
  double frame_us = 0, finish_us = 0, match_us = 0, insert_us = 0;
};

Run Map(const LaserWorld& world, const std::vector<Pose2>& truth, const LaserOptions& laser,
        const PriorOptions& prior, const MapperOptions& options, People people, int seed,
        bool verbose) {
  const std::vector<Pose2> odometry = PriorOf(truth, prior, seed);
  IncrementalMapper mapper(options, std::nullopt, {ThreadCpuUs, SteadyUs});
  Run run;
  std::vector<Pose2> online, final;
  std::vector<FrameReport> reports;
  Trajectory stamped_truth;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    Frame frame;
    frame.index = static_cast<int>(k);
    frame.stamp_s = static_cast<double>(k) / 30.0;
    frame.scan = SimulatedScan(WithPeople(world, people, truth, k), truth[k], laser, seed,
                               static_cast<int>(k));
    frame.slam_from_camera = CameraOf(odometry[k], 0.0);
    stamped_truth.push_back({frame.stamp_s, CameraOf(truth[k], 0.0)});
    const FrameReport report = mapper.AddFrame(frame);
    online.push_back(BaseOf(*report.map_from_camera));
    reports.push_back(report);
    run.frame_us += report.times.total_us;
    run.match_us += report.times.match_us;
    run.insert_us += report.times.insert_us;
    if (verbose && k % 30 == 0) {
      const Pose2 e = Between(truth[k], online[k]);
      std::printf(
          "%4zu err %.4f %.4f %.2fdeg sig %.4f %.4f %.3f score %.2f it %d innov %.4f %.4f %.3f\n",
          k, e.x_m, e.y_m, DegFromRad(e.yaw_rad), std::sqrt(report.covariance(0, 0)),
          std::sqrt(report.covariance(1, 1)), DegFromRad(std::sqrt(report.covariance(2, 2))),
          report.match.score, report.match.iterations, report.innovation[0], report.innovation[1],
          DegFromRad(report.innovation[2]));
    }
  }
  const double t = ThreadCpuUs();
  const MapperResult result = mapper.Finish();
  const double n = static_cast<double>(truth.size());
  run.finish_us = (ThreadCpuUs() - t) / n;
  run.frame_us /= n;
  run.match_us /= n;
  run.insert_us /= n;
  for (const auto& pose : result.map_from_camera) final.push_back(BaseOf(*pose));
  run.nis = InnovationSamples(reports);
  run.nees = MotionSamples(reports, stamped_truth);
  run.prior = Score(truth, odometry);
  run.online = Score(truth, online);
  run.final = Score(truth, final);
  return run;
}
void PrintConsistency(const char* name, const std::vector<Run>& runs,
                      std::vector<ChiSquareSample> Run::*samples) {
  std::vector<ChiSquareSample> all;
  for (const Run& run : runs) {
    all.insert(all.end(), (run.*samples).begin(), (run.*samples).end());
  }
  const std::optional<Consistency> c = ConsistencyOf(all);
  if (!c) return;
  std::printf("  %-5s a degree %.2f (95 %%: %.2f to %.2f) within 95 %%: %.3f of %d\n", name,
              c->mean, c->low, c->high, c->share_within_95, c->count);
}
}  // namespace

namespace {
int Measure(int argc, char** argv) {
  CLI::App app;
  std::vector<std::string> worlds, sets;
  LaserOptions laser;
  PriorOptions prior;
  int first_seed = 1, seeds = 3, threads = 2;
  bool verbose = false;
  People people = People::kNone;
  app.add_option("--worlds", worlds, "names without .world.txt and .truth.txt")->required();
  app.add_option("--seeds", seeds);
  app.add_option("--first-seed", first_seed);
  app.add_option("--threads", threads);
  app.add_option("--beams", laser.beams);
  app.add_option("--fov", laser.field_of_view_deg);
  app.add_option("--noise", laser.noise_relative);
  app.add_option("--noise2", laser.noise_quadratic_per_m);
  app.add_option("--noise-corr", laser.noise_correlation);
  app.add_option("--outliers", laser.outlier_share);
  app.add_option("--max-range", laser.max_range_m);
  app.add_option("--drift", prior.odometry.mean_error_m);
  app.add_option("--bias-time", prior.odometry.bias_time_frames);
  app.add_option("--jitter", prior.odometry.jitter_m);
  app.add_option("--jitter-deg", prior.odometry.jitter_deg);
  app.add_option("--perfect-frames", prior.perfect_frames,
                 "the prior errs from this frame on only");
  app.add_option("--slips", prior.slips, "so often the prior turns within a frame, evenly spread");
  app.add_option("--slip-deg", prior.slip_deg, "by so much");
  app.add_option("--slip-m", prior.slip_m, "and forward or back by so much");
  app.add_option("--people", people, "none, crossing, ahead or swaying")
      ->transform(
          CLI::CheckedTransformer(std::map<std::string, People>{{"none", People::kNone},
                                                                {"crossing", People::kCrossing},
                                                                {"ahead", People::kAhead},
                                                                {"swaying", People::kSwaying}}));
  app.add_option("--set", sets);
  app.add_flag("-v", verbose);
  CLI11_PARSE(app, argc, argv);
  MapperOptions options;
  options.method = MapperMethod::kSurfel;
  options.fusion.mode = FusionMode::kLearned;
  Config config;
  for (const auto& s : sets) config.Set(s);
  config.Read(options);
  for (const std::string& name : worlds) {
    const LaserWorld world = ReadLaserWorld(name + ".world.txt");
    const std::vector<Pose2> truth = ReadPlanarTruth(name);
    std::vector<Run> runs(static_cast<std::size_t>(seeds));
    std::vector<std::future<void>> jobs;
    for (int t = 0; t < threads; ++t) {
      jobs.push_back(std::async(std::launch::async, [&, t] {
        for (int i = t; i < seeds; i += threads)
          runs[static_cast<std::size_t>(i)] =
              Map(world, truth, laser, prior, options, people, first_seed + i, verbose);
      }));
    }
    for (auto& j : jobs) j.get();
    const std::string shown = name.substr(name.rfind('/') + 1);
    Run mean;
    double won = 0, wfn = 0, wat = 0, worse_on = -1e9, worse_fn = -1e9;
    for (int i = 0; i < seeds; ++i) {
      const Run& r = runs[static_cast<std::size_t>(i)];
      std::printf(
          "%-10s seed %2d prior %.3f/%.3f online %.4f/%.4f max %.3f final %.4f/%.4f max %.3f | us "
          "frame %.0f match %.0f insert %.0f finish %.0f\n",
          shown.c_str(), first_seed + i, r.prior.mean, r.prior.ate, r.online.mean, r.online.ate,
          r.online.max, r.final.mean, r.final.ate, r.final.max, r.frame_us, r.match_us, r.insert_us,
          r.finish_us);
      mean.online.mean += r.online.mean / seeds;
      mean.online.ate += r.online.ate / seeds;
      mean.final.mean += r.final.mean / seeds;
      mean.final.ate += r.final.ate / seeds;
      won = std::max(won, r.online.mean);
      wfn = std::max(wfn, r.final.mean);
      wat = std::max(wat, r.final.ate);
      worse_on = std::max(worse_on, r.online.mean - r.prior.mean);
      worse_fn = std::max(worse_fn, r.final.mean - r.prior.mean);
    }
    std::printf(
        "%-10s MEAN online %.4f/%.4f worst %.4f final %.4f/%.4f worst %.4f/%.4f  minus prior %.4f "
        "%.4f\n",
        shown.c_str(), mean.online.mean, mean.online.ate, won, mean.final.mean, mean.final.ate, wfn,
        wat, worse_on, worse_fn);
    PrintConsistency("NIS", runs, &Run::nis);
    PrintConsistency("NEES", runs, &Run::nees);
  }
  return 0;
}
}  // namespace

int main(int argc, char** argv) { return depthgrid::GuardedMain(Measure, argc, argv); }
