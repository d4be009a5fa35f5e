#include "sim/slam/slam_fit.h"

#include <fmt/format.h>

#include <algorithm>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/cli/slam_settings.h"
#include "eval/doubts/trajectory_doubts.h"
#include "eval/files/one_result.h"
#include "eval/metrics/association.h"
#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "mapper/io/trajectory_file.h"
#include "sim/slam/slam_events.h"
#include "sim/slam/slam_surrogate.h"

namespace depthgrid::cli {
namespace {

constexpr int kCheckSeeds = 20;
const std::vector<double>& Lags() {
  static const std::vector<double> lags_s = {1.0 / 30.0, 0.1,  1.0 / 3.0, 1.0,
                                             3.0,        10.0, 30.0,      60.0};
  return lags_s;
}

// As `eval trajectory` does.
void WarnOfPairs(const Trajectory& truth, const Trajectory& estimate,
                 const std::vector<PosePair>& pairs, const TrajectoryNames& names) {
  if (const auto score = ScoreTrajectory(truth, estimate, kMaxStampDifferenceS)) {
    Warn(DoubtsOfTime(*score, names));
    if (const auto doubt = DoubtOfPlane(*score, pairs, names)) Warn({*doubt});
  }
  Warn(DoubtsOfPairs(pairs, names));
  Warn(DoubtsOfClock(truth, estimate, names));
}

SlamRun ReadRun(const std::string& truth_path, const std::string& estimate_path) {
  SlamRun run;
  std::vector<std::string> warnings;
  const Trajectory truth = ReadTrajectory(truth_path, warnings);
  const Trajectory estimate = ReadTrajectory(estimate_path, warnings);
  Warn(warnings);
  const std::vector<PosePair> pairs = Associate(truth, estimate);
  for (const PosePair& pair : pairs) {
    run.truth.push_back(pair.reference);
    run.estimate.push_back(pair.estimate);
  }
  if (run.truth.empty()) {
    throw InputError(estimate_path, SpansApart(truth, estimate, truth_path, kMaxStampDifferenceS));
  }
  const TrajectoryNames names = {truth_path, estimate_path};
  if (const auto units = OtherUnits(pairs, names)) {
    throw InputError(estimate_path,
                     fmt::format("seems to be in {}, both must be in metres", *units));
  }
  WarnOfPairs(truth, estimate, pairs, names);
  return run;
}

// What `run` would refuse of a fit.
void RequireHoldable(const SlamOptions& options, const std::string& place) {
  SlamSettings read;
  try {
    Config::FromText(ToYaml(SlamSettings{options}), place).Read(read);
  } catch (const InputError& error) {
    throw InputError(place, fmt::format("its errors are larger than any setting can be: are truth "
                                        "and estimate of the same run, both in metres? ({})",
                                        error.what()));
  }
}

// Warns of equal poses, as when a file is given twice.
void WarnOfSamePoses(const SlamRun& run, const std::string& truth_path,
                     const std::string& estimate_path) {
  const auto same = [](const StampedPose& a, const StampedPose& b) {
    return a.world_from_camera == b.world_from_camera;
  };
  if (!std::equal(run.truth.begin(), run.truth.end(), run.estimate.begin(), same)) return;
  Warn({fmt::format("{} has the poses of {}: there are no errors to fit", estimate_path,
                    truth_path)});
}

// The fitted surrogate, without loops, run on the same true paths with several seeds.
std::vector<SlamRun> Imitated(const std::vector<SlamRun>& runs, SlamOptions options) {
  options.loops = WithScenario(options.loops, LoopScenario::kNone);
  std::vector<SlamRun> imitated;
  for (const SlamRun& run : runs) {
    for (std::uint64_t seed = 1; seed <= kCheckSeeds; ++seed) {
      SlamRun copy;
      const SlamOutput output = DisturbTrajectory(run.truth, options, seed);
      for (std::size_t i = 0; i < run.truth.size(); ++i) {
        if (!output.live[i].slam_from_camera) continue;
        copy.truth.push_back(run.truth[i]);
        copy.estimate.push_back({run.truth[i].stamp_s, *output.live[i].slam_from_camera});
      }
      imitated.push_back(std::move(copy));
    }
  }
  return imitated;
}

void PrintComments(const std::string& text) {
  std::size_t start = 0;
  while (start < text.size()) {
    const std::size_t end = text.find('\n', start);
    fmt::print("# {}\n", text.substr(start, end - start));
    if (end == std::string::npos) return;
    start = end + 1;
  }
}

// The stretches used for fitting: a correction removes accumulated errors at once, and so hides how
// they grow.
std::vector<SlamRun> AllBetweenCorrections(const std::vector<SlamRun>& runs) {
  std::vector<SlamRun> all;
  for (const SlamRun& run : runs) {
    for (SlamRun& stretch : BetweenCorrections(run)) all.push_back(std::move(stretch));
  }
  return all;
}

std::string LagTable(const std::vector<LagError>& measured, const std::vector<LagError>& imitated) {
  std::vector<std::vector<std::string>> rows = {
      {"error over", "run (mm)", "surrogate (mm)", "run (deg)", "surrogate (deg)"}};
  for (std::size_t i = 0; i < std::min(measured.size(), imitated.size()); ++i) {
    rows.push_back({fmt::format("{:.3f} s", measured[i].lag_s),
                    fmt::format("{:.1f}", 1e3 * measured[i].translation_m),
                    fmt::format("{:.1f}", 1e3 * imitated[i].translation_m),
                    fmt::format("{:.2f}", measured[i].rotation_deg),
                    fmt::format("{:.2f}", imitated[i].rotation_deg)});
  }
  return Table(rows);
}

// A warning where the surrogate's errors differ by more than kPoorFactor from the run's, over the
// lag where most. Longer lags, of which the run has few, differ by chance.
std::vector<std::string> DoubtOfFit(const std::vector<LagError>& measured,
                                    const std::vector<LagError>& imitated, double tracked_s,
                                    const std::string& place) {
  // Over such lags the fits of docs/slam_surrogate.md reach 1.3.
  constexpr double kPoorFactor = 1.5;
  constexpr double kFewestMotions = 20.0;  // of which a root mean square is known to 16 %
  constexpr double kLeastM = 1e-3, kLeastDeg = 0.05;  // smaller errors are of no account
  double worst = kPoorFactor;
  std::string doubt;
  const auto judge = [&](double run, double surrogate, double least, const LagError& lag,
                         const std::string& what) {
    const double ratio = std::max(run, least) / std::max(surrogate, least);
    const double factor = std::max(ratio, 1.0 / ratio);
    if (factor <= worst) return;
    worst = factor;
    doubt = fmt::format("{}: the settings below imitate this run badly: over {:.3g} s {}", place,
                        lag.lag_s, what);
  };
  for (std::size_t i = 0; i < std::min(measured.size(), imitated.size()); ++i) {
    const LagError &run = measured[i], &surrogate = imitated[i];
    if (run.lag_s * kFewestMotions > tracked_s) break;
    judge(run.translation_m, surrogate.translation_m, kLeastM, run,
          fmt::format("they err by {:.1f} mm, the run by {:.1f} mm", 1e3 * surrogate.translation_m,
                      1e3 * run.translation_m));
    judge(run.rotation_deg, surrogate.rotation_deg, kLeastDeg, run,
          fmt::format("they err by {:.2f} degrees, the run by {:.2f} degrees",
                      surrogate.rotation_deg, run.rotation_deg));
  }
  return doubt.empty() ? std::vector<std::string>{} : std::vector<std::string>{doubt};
}

}  // namespace

void FitSlam(const SlamFitArguments& arguments) {
  const std::vector<std::string>& files = arguments.files;
  if (files.size() % 2 != 0) {
    throw InputError(files.back(), "has no partner: files come in pairs, truth and estimate");
  }
  for (const std::string& file : files) RequireOneResultAround(file);
  std::vector<SlamRun> runs;
  for (std::size_t i = 0; i < files.size(); i += 2) runs.push_back(ReadRun(files[i], files[i + 1]));
  const std::string place = files.size() == 2 ? files[1]
                                              : fmt::format("{}, the last of {}", files.back(),
                                                            Counted(runs.size(), "run"));
  SlamFit fit = FitSlamErrors(runs, place);
  RequireHoldable(fit.options, place);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    WarnOfSamePoses(runs[i], files[2 * i], files[2 * i + 1]);
  }
  SlamLoopOptions& loops = fit.options.loops;
  if (fit.corrections > 0) loops = WithScenario(loops, LoopScenario::kTrue);
  PrintComments(fmt::format(
      "{:.1f} s of tracking: {}, lost {}, {} (left out of the fit and of the table)\n"
      "turning about the pivot explains {:.0f} % of the sideways error from frame to frame\n"
      "surrogate: the settings below without loops, {} seeds; loops are not fitted: {}\n",
      fit.tracked_s, Counted(fit.jumps, "jump"), Counted(fit.lost_bursts, "time"),
      Counted(fit.corrections, "correction"), 100.0 * fit.pivot_explains, kCheckSeeds,
      fit.corrections > 0 ? "every revisit is closed, as there are corrections"
                          : "none is closed, as there is no correction"));
  const auto measured = ErrorOverLag(AllBetweenCorrections(runs), Lags());
  const auto imitated = ErrorOverLag(Imitated(runs, fit.options), Lags());
  PrintComments(LagTable(measured, imitated));
  Warn(DoubtOfFit(measured, imitated, fit.tracked_s, place));
  fmt::print("{}", ToYaml(SlamSettings{fit.options}));
}

}  // namespace depthgrid::cli
