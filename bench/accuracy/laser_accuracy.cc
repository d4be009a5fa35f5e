// Accuracy of `depthgrid map` on laser worlds over many seeds: the tables of docs/results.md,
// "Laser logs". Results, not times.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <future>
#include <map>
#include <string>
#include <utility>

#include "bench/accuracy/laser_run.h"
#include "bench/accuracy/people.h"
#include "bench/command_line.h"
#include "bench/guarded_main.h"
#include "bench/mapper_settings.h"
#include "eval/doubts/crossing_check.h"
#include "eval/metrics/alignment.h"
#include "eval/metrics/trajectory_metrics.h"
#include "eval/run/consistency.h"
#include "mapper/core/cpu_clock.h"
#include "mapper/core/level.h"
#include "mapper/core/rng.h"
#include "mapper/incremental_mapper.h"
#include "sim/laser/odometry_noise.h"

using namespace depthgrid;

namespace {

// Position errors of an estimate in the plane, metres.
struct Errors {
  double mean = 0.0;
  double max = 0.0;
  double ate = 0.0;  // root mean square after alignment with the truth
};

Errors ErrorsOf(const std::vector<Pose2>& truth, const std::vector<Pose2>& estimate) {
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    pairs.push_back({{0.0, Lift(truth[i])}, {0.0, Lift(estimate[i])}});
  }
  const Statistics as_it_is = Summarise(TranslationErrorsXy(pairs));
  const auto over_truth = Align(pairs, Alignment::kSe2);
  if (over_truth) pairs = Aligned(std::move(pairs), *over_truth);
  return {as_it_is.mean, as_it_is.max, Summarise(TranslationErrorsXy(pairs)).rmse};
}

// Odometry that is exact up to frame perfect_frames.
std::vector<Pose2> PerfectAtFirst(const std::vector<Pose2>& truth,
                                  const std::vector<Pose2>& odometry, int perfect_frames) {
  std::vector<Pose2> later = {truth.front()};
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const std::vector<Pose2>& moved = static_cast<int>(k) < perfect_frames ? truth : odometry;
    later.push_back(later.back() * Between(moved[k - 1], moved[k]));
  }
  return later;
}

// Errors of the prior.
struct PriorOptions {
  OdometryOptions odometry;
  int perfect_frames = 0;  // the first
  int slips = 0;           // evenly spread, to either side in turn
  double slip_deg = 5.0;   // within a frame
  double slip_m = 0.0;     // and forward
  double late_s = 0.0;     // standard deviation of how late or early each pose is read
};

// Frames a second of the true poses.
constexpr double kRateHz = 30.0;

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

// Odometry that is not read when the scan is taken, as without a common clock.
std::vector<Pose2> ReadLate(const std::vector<Pose2>& odometry, double late_s, int seed) {
  RandomStream random(static_cast<std::uint64_t>(seed), RandomStage::kTest);
  std::vector<Pose2> read;
  const auto last = static_cast<double>(odometry.size() - 1);
  for (std::size_t k = 0; k < odometry.size(); ++k) {
    const double at =
        std::clamp(static_cast<double>(k) - kRateHz * late_s * random.Normal(), 0.0, last);
    const auto before = static_cast<std::size_t>(at);
    const Pose2& from = odometry[before];
    const Pose2& to = odometry[std::min(before + 1, odometry.size() - 1)];
    read.push_back(
        from * Pose2::FromVector((at - static_cast<double>(before)) * Between(from, to).vector()));
  }
  read.front() = odometry.front();
  return read;
}

std::vector<Pose2> PriorOf(const std::vector<Pose2>& truth, const PriorOptions& prior, int seed) {
  const auto drifting = DisturbOdometry(truth, prior.odometry, static_cast<std::uint64_t>(seed));
  const auto slipped = WithSlips(PerfectAtFirst(truth, drifting, prior.perfect_frames), prior);
  return prior.late_s > 0.0 ? ReadLate(slipped, prior.late_s, seed) : slipped;
}

// Every so many poses.
std::vector<Pose2> Thinned(const std::vector<Pose2>& poses, int every) {
  std::vector<Pose2> thinned;
  for (std::size_t k = 0; k < poses.size(); k += static_cast<std::size_t>(every)) {
    thinned.push_back(poses[k]);
  }
  return thinned;
}

struct Experiment {
  LaserOptions laser;
  PriorOptions prior;
  MapperOptions mapper;
  People people = People::kNone;
  int first_seed = 1;
  int seeds = 3;
  int threads = 2;
  int every = 1;  // so many true poses a frame
  bool verbose = false;
};

struct Run {
  Errors prior, online, final;
  std::vector<ChiSquareSample> nis, nees;
  Crossing crossing;
  double frame_us = 0.0, finish_us = 0.0, match_us = 0.0, insert_us = 0.0;  // means over the frames
};

void PrintFrame(std::size_t k, const Pose2& error, const FrameReport& report) {
  std::printf(
      "%4zu err %.4f %.4f %.2fdeg sig %.4f %.4f %.3f score %.2f it %d innov %.4f %.4f %.3f\n", k,
      error.x_m, error.y_m, DegFromRad(error.yaw_rad), std::sqrt(report.covariance(0, 0)),
      std::sqrt(report.covariance(1, 1)), DegFromRad(std::sqrt(report.covariance(2, 2))),
      report.match.score, report.match.iterations, report.innovation[0], report.innovation[1],
      DegFromRad(report.innovation[2]));
}

Run Map(const LaserWorld& world, const std::vector<Pose2>& all_true, const Experiment& experiment,
        int seed) {
  const std::vector<Pose2> truth = Thinned(all_true, experiment.every);
  const std::vector<Pose2> odometry =
      Thinned(PriorOf(all_true, experiment.prior, seed), experiment.every);
  const auto frames = static_cast<double>(truth.size());
  IncrementalMapper mapper(experiment.mapper, std::nullopt, {ThreadCpuUs, SteadyUs});
  Run run;
  std::vector<Pose2> online, final;
  std::vector<FrameReport> reports;
  Trajectory stamped_truth;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    Frame frame;
    frame.index = static_cast<int>(k);
    frame.stamp_s = static_cast<double>(k) * experiment.every / kRateHz;
    frame.scan = SimulatedScan(WithPeople(world, experiment.people, truth, k), truth[k],
                               experiment.laser, seed, static_cast<int>(k));
    frame.slam_from_camera = CameraOf(odometry[k], 0.0);
    stamped_truth.push_back({frame.stamp_s, CameraOf(truth[k], 0.0)});
    reports.push_back(mapper.AddFrame(frame));
    const FrameReport& report = reports.back();
    online.push_back(BaseOf(*report.map_from_camera));
    run.frame_us += report.times.total_us / frames;
    run.match_us += report.times.match_us / frames;
    run.insert_us += report.times.insert_us / frames;
    if (experiment.verbose && k % 30 == 0) PrintFrame(k, Between(truth[k], online[k]), report);
  }
  const double start_us = ThreadCpuUs();
  const MapperResult result = mapper.Finish();
  run.finish_us = (ThreadCpuUs() - start_us) / frames;
  run.crossing = CrossingOf(result).value_or(Crossing{});
  for (const auto& pose : result.map_from_camera) final.push_back(BaseOf(*pose));
  run.nis = InnovationSamples(reports);
  run.nees = MotionSamples(reports, stamped_truth);
  run.prior = ErrorsOf(truth, odometry);
  run.online = ErrorsOf(truth, online);
  run.final = ErrorsOf(truth, final);
  return run;
}

// One run per seed, distributed over the threads.
std::vector<Run> MapAll(const LaserWorld& world, const std::vector<Pose2>& truth,
                        const Experiment& experiment) {
  std::vector<Run> runs(static_cast<std::size_t>(experiment.seeds));
  std::vector<std::future<void>> jobs;
  for (int thread = 0; thread < experiment.threads; ++thread) {
    jobs.push_back(std::async(std::launch::async, [&, thread] {
      for (int i = thread; i < experiment.seeds; i += experiment.threads) {
        runs[static_cast<std::size_t>(i)] =
            Map(world, truth, experiment, experiment.first_seed + i);
      }
    }));
  }
  for (std::future<void>& job : jobs) job.get();
  return runs;
}

void PrintRun(const std::string& world, int seed, const Run& run) {
  std::printf(
      "%-10s seed %2d prior %.3f/%.3f online %.4f/%.4f max %.3f final %.4f/%.4f max %.3f | us "
      "frame %.0f match %.0f insert %.0f finish %.0f | beams through walls %.4f\n",
      world.c_str(), seed, run.prior.mean, run.prior.ate, run.online.mean, run.online.ate,
      run.online.max, run.final.mean, run.final.ate, run.final.max, run.frame_us, run.match_us,
      run.insert_us, run.finish_us, run.crossing.share);
}

void PrintMeans(const std::string& world, const std::vector<Run>& runs) {
  Errors online, final, worst_online, worst_final;
  double online_less_prior = -1e9, final_less_prior = -1e9;  // the worst
  const auto count = static_cast<double>(runs.size());
  for (const Run& run : runs) {
    online.mean += run.online.mean / count;
    online.ate += run.online.ate / count;
    final.mean += run.final.mean / count;
    final.ate += run.final.ate / count;
    worst_online.mean = std::max(worst_online.mean, run.online.mean);
    worst_final.mean = std::max(worst_final.mean, run.final.mean);
    worst_final.ate = std::max(worst_final.ate, run.final.ate);
    online_less_prior = std::max(online_less_prior, run.online.mean - run.prior.mean);
    final_less_prior = std::max(final_less_prior, run.final.mean - run.prior.mean);
  }
  std::printf(
      "%-10s MEAN online %.4f/%.4f worst %.4f final %.4f/%.4f worst %.4f/%.4f  minus prior %.4f "
      "%.4f\n",
      world.c_str(), online.mean, online.ate, worst_online.mean, final.mean, final.ate,
      worst_final.mean, worst_final.ate, online_less_prior, final_less_prior);
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

void AddOptions(CLI::App& app, Experiment& experiment) {
  LaserOptions& laser = experiment.laser;
  PriorOptions& prior = experiment.prior;
  app.add_option("--seeds", experiment.seeds)->check(FromTo(1, 1e6));
  app.add_option("--first-seed", experiment.first_seed)->check(FromTo(0, 1e9));
  app.add_option("--threads", experiment.threads)->check(FromTo(1, 1024));
  app.add_option("--beams", laser.beams)->check(FromTo(2, 20000));
  app.add_option("--fov", laser.field_of_view_deg)->check(FromTo(1, 360));
  app.add_option("--noise", laser.noise_relative)->check(FromTo(0, 0.5));
  app.add_option("--noise2", laser.noise_quadratic_per_m)->check(FromTo(0, 0.5));
  app.add_option("--noise-corr", laser.noise_correlation)->check(FromTo(0, 0.999));
  app.add_option("--outliers", laser.outlier_share)->check(FromTo(0, 1));
  app.add_option("--max-range", laser.max_range_m)->check(FromTo(0.5, 1000));
  app.add_option("--drift", prior.odometry.mean_error_m)->check(FromTo(0, 100));
  app.add_option("--bias-time", prior.odometry.bias_time_frames)->check(FromTo(1, 1e6));
  app.add_option("--jitter", prior.odometry.jitter_m)->check(FromTo(0, 1));
  app.add_option("--jitter-deg", prior.odometry.jitter_deg)->check(FromTo(0, 45));
  app.add_option("--late-s", prior.late_s,
                 "standard deviation of how late or early odometry is read")
      ->check(FromTo(0, 10));
  app.add_option("--every", experiment.every, "frames of 30 a second that are used")
      ->check(FromTo(1, 300));
  app.add_option("--perfect-frames", prior.perfect_frames, "the prior errs from this frame on only")
      ->check(FromTo(0, 1e9));
  app.add_option("--slips", prior.slips, "so often the prior turns within a frame, evenly spread")
      ->check(FromTo(0, 1e6));
  app.add_option("--slip-deg", prior.slip_deg, "by so much")->check(FromTo(-180, 180));
  app.add_option("--slip-m", prior.slip_m, "and forward or back by so much")
      ->check(FromTo(-100, 100));
  const std::map<std::string, People> people = {
      {"none", People::kNone},       {"crossing", People::kCrossing}, {"ahead", People::kAhead},
      {"swaying", People::kSwaying}, {"aside", People::kAside},       {"weaving", People::kWeaving},
      {"close", People::kClose}};
  app.add_option("--people", experiment.people,
                 "none, crossing, ahead, swaying, aside, weaving or close")
      ->transform(CLI::CheckedTransformer(people));
  app.add_flag("-v", experiment.verbose);
}

int Measure(int argc, char** argv) {
  CLI::App app;
  std::vector<std::string> worlds, sets;
  Experiment experiment;
  app.add_option("--worlds", worlds, "names without .world.txt and .truth.txt")->required();
  AddOptions(app, experiment);
  app.add_option("--set", sets);
  if (!ReadCommandLine(app, argc, argv)) return 0;
  experiment.mapper = MapperWith(sets);
  for (const std::string& name : worlds) {
    const std::vector<Run> runs =
        MapAll(ReadLaserWorld(name + ".world.txt"), ReadPlanarTruth(name), experiment);
    const std::string shown = name.substr(name.rfind('/') + 1);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      PrintRun(shown, experiment.first_seed + static_cast<int>(i), runs[i]);
    }
    PrintMeans(shown, runs);
    PrintConsistency("NIS", runs, &Run::nis);
    PrintConsistency("NEES", runs, &Run::nees);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return depthgrid::GuardedMain(Measure, argc, argv); }
