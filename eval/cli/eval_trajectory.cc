#include <fmt/format.h>

#include <algorithm>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/doubts/clock_check.h"
#include "eval/doubts/rotation_check.h"
#include "eval/doubts/trajectory_doubts.h"
#include "eval/files/one_result.h"
#include "eval/files/trajectory_files.h"
#include "eval/metrics/alignment.h"
#include "eval/metrics/trajectory_metrics.h"
#include "eval/metrics/tum_association.h"
#include "eval/output/kept_inputs.h"
#include "eval/output/output_file.h"
#include "eval/run/metrics_json.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/frame_names.h"

namespace depthgrid::cli {
namespace {

using Row = std::vector<std::string>;

Row StatisticsRow(const std::string& name, const std::optional<Statistics>& s) {
  if (!s) return {name, "-", "-", "-", "-", "-", "-"};
  const auto text = [](double value) { return fmt::format("{:.6f}", value); };
  return {name,         text(s->rmse), text(s->mean), text(s->median),
          text(s->std), text(s->min),  text(s->max)};
}

void PrintTable(const TrajectoryScore& score) {
  fmt::print("{} of {} reference and {} estimated poses matched{}, {:.3f} m of path\n\n",
             score.matched_poses, score.reference_poses, score.estimate_poses,
             score.by_row ? ", row by row (matrices have no stamps)" : "", score.reference_path_m);
  fmt::print("{}",
             Table({{"error", "rmse", "mean", "median", "std", "min", "max"},
                    StatisticsRow("xy, not aligned (m)", score.xy_unaligned),
                    StatisticsRow("xy, first pose aligned (m)", score.xy_origin),
                    StatisticsRow("xy, SE(2) aligned (m)", score.xy_se2),
                    StatisticsRow("xyz, not aligned (m)", score.xyz_unaligned),
                    StatisticsRow("xyz, first pose aligned (m)", score.xyz_origin),
                    StatisticsRow("xyz, SE(3) aligned (m)", score.xyz_se3),
                    StatisticsRow("xyz, Sim(3) aligned (m)", score.xyz_sim3),
                    StatisticsRow("heading, not aligned (rad)", score.heading_unaligned),
                    StatisticsRow("heading, SE(2) aligned (rad)", score.heading_se2),
                    StatisticsRow("rotation, not aligned (rad)", score.rotation_unaligned),
                    StatisticsRow("rotation, SE(3) aligned (rad)", score.rotation_se3),
                    StatisticsRow("relative, 1 pose apart (m)", score.rpe_frame_translation),
                    StatisticsRow("relative, 1 pose apart (rad)", score.rpe_frame_rotation),
                    StatisticsRow("relative, steps of 1 m (m)", score.rpe_metre_translation),
                    StatisticsRow("relative, steps of 1 m (rad)", score.rpe_metre_rotation)}));
}

void PrintDrift(const TrajectoryScore& score) {
  std::vector<Row> rows = {
      {"relative, from every pose, over", "motions", "rms m", "rms rad", "mean m / unit"}};
  const auto add = [&rows](const char* unit, const Drift& drift) {
    rows.push_back({fmt::format("{:g} {}", drift.over, unit), std::to_string(drift.motions),
                    fmt::format("{:.6f}", drift.translation_rms_m),
                    fmt::format("{:.6f}", drift.rotation_rms_rad),
                    fmt::format("{:.6f}", drift.PerUnit())});
  };
  for (const Drift& drift : score.drift_over_time) add("s", drift);
  for (const Drift& drift : score.drift_over_path) add("m", drift);
  if (rows.size() > 1) fmt::print("\n{}", Table(rows));
}

double SpanS(const Trajectory& trajectory) {
  return trajectory.empty() ? 0.0 : trajectory.back().stamp_s - trajectory.front().stamp_s;
}

// What few common stamps may come from, when one of the files spans far more time.
std::string UnitsText(const TrajectoryFiles& files) {
  const double reference_s = SpanS(files.reference), estimate_s = SpanS(files.estimate);
  if (!AreOfOtherUnits(reference_s, estimate_s)) return "";
  return fmt::format("; it spans {:.3g} s and the other {:.3g} s: are both in seconds?", estimate_s,
                     reference_s);
}

// Warnings about errors that may be misleading.
std::vector<std::string> DoubtsOf(const TrajectoryScore& score, const std::vector<PosePair>& pairs,
                                  const TrajectoryFiles& files, const EvalTrajectoryArguments& of) {
  constexpr double kFewShare = 0.5;  // more missing than present
  std::vector<std::string> doubts;
  const int fewer = std::min(score.reference_poses, score.estimate_poses);
  if (!score.by_row && score.matched_poses == 1 && fewer == 1) {
    doubts.push_back(
        fmt::format("{}: one pose is matched, aligned and relative errors need more", of.estimate));
  } else if (!score.by_row &&
             (score.matched_poses < kFewShare * fewer || score.matched_poses < 2)) {
    doubts.push_back(
        fmt::format("{}: only {} of its {} poses {} a stamp in common with {}'s {}; the errors "
                    "are of those alone{}",
                    of.estimate, score.matched_poses, score.estimate_poses,
                    score.matched_poses == 1 ? "has" : "have", of.reference, score.reference_poses,
                    UnitsText(files)));
  } else {
    doubts = DoubtsOfTime(score, {of.reference, of.estimate});
  }
  if (const auto doubt = DoubtOfPlane(score, pairs, {of.reference, of.estimate})) {
    doubts.push_back(*doubt);
  }
  for (std::string& doubt : DoubtsOfPairs(pairs, {of.reference, of.estimate})) {
    doubts.push_back(std::move(doubt));
  }
  return doubts;
}

// The matched poses as two trajectories with equal stamps.
struct Matched {
  Trajectory reference;
  Trajectory estimate;
};
Matched Match(const std::vector<PosePair>& pairs) {
  Matched matched;
  for (const PosePair& pair : pairs) {
    matched.reference.push_back(pair.reference);
    matched.estimate.push_back({pair.reference.stamp_s, pair.estimate.world_from_camera});
  }
  return matched;
}

std::string ErrorsCsv(const std::vector<PosePair>& pairs, bool has_seconds) {
  const std::vector<double> xy_m = TranslationErrorsXy(pairs);
  const std::vector<double> xyz_m = TranslationErrorsXyz(pairs);
  const std::vector<double> rotation_rad = RotationErrors(pairs);
  const std::vector<double> heading_rad = HeadingErrors(pairs);
  std::string csv = fmt::format("{},error_xy_m,error_xyz_m,error_rotation_rad,error_heading_rad\n",
                                has_seconds ? "stamp_s" : "row");
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    csv += fmt::format("{:.{}f},{},{},{},{}\n", pairs[i].reference.stamp_s, has_seconds ? 6 : 0,
                       xy_m[i], xyz_m[i], rotation_rad[i], heading_rad[i]);
  }
  return csv;
}

// The pairs by the convention's rule, and the scores.
struct Paired {
  std::vector<PosePair> pairs;
  std::optional<TrajectoryScore> score;
};

Paired PairByStamps(const Trajectory& reference, const Trajectory& estimate, double limit_s,
                    const std::string& convention) {
  if (convention != "tum") {
    return {Associate(reference, estimate, limit_s), ScoreTrajectory(reference, estimate, limit_s)};
  }
  Paired paired;
  paired.pairs = AssociateAsTum(reference, estimate, limit_s);
  const Matched matched = Match(paired.pairs);
  paired.score = ScoreTrajectory(matched.reference, matched.estimate, limit_s);
  if (paired.score) {
    paired.score->reference_poses = static_cast<int>(reference.size());
    paired.score->estimate_poses = static_cast<int>(estimate.size());
    paired.score->time_coverage = TimeCoverage(reference, paired.pairs);
  }
  return paired;
}

// For rows paired in order, which have been given equal stamps.
Paired PairByRows(const TrajectoryFiles& files) {
  Paired paired = PairByStamps(files.reference, files.estimate, 0.0, "evo");
  if (!paired.score) return paired;
  paired.score->by_row = true;
  if (!files.has_seconds) paired.score->drift_over_time.clear();
  return paired;
}

// The error message for no shared stamps: the time spans, and which time offset would help.
std::string NoSharedStampText(const TrajectoryFiles& files, double limit_s,
                              const EvalTrajectoryArguments& of) {
  const std::string apart = SpansApart(files.reference, files.estimate, of.reference, limit_s);
  if (AreOfOtherUnits(SpanS(files.reference), SpanS(files.estimate))) {
    return apart + "; are both in seconds?";
  }
  const auto clock = FindClockOffset(files.reference, files.estimate);
  const double offset_s =
      of.time_offset_s +
      (clock ? clock->offset_s : files.reference.front().stamp_s - files.estimate.front().stamp_s);
  return fmt::format("{}; --max-difference S takes stamps further apart, --time-offset {:.3f} {}",
                     apart, offset_s,
                     clock ? "is where they fit best" : "makes the first of both coincide");
}

double LimitOf(const EvalTrajectoryArguments& arguments) {
  if (arguments.max_difference_s >= 0.0) return arguments.max_difference_s;
  return arguments.convention == "tum" ? kTumMaxStampDifferenceS : kMaxStampDifferenceS;
}

void RequireSoundArguments(const EvalTrajectoryArguments& arguments) {
  RequireInputsKept(arguments.errors, "--errors", {arguments.reference, arguments.estimate});
  if (!arguments.errors.empty()) RequireNewFile(arguments.errors, arguments.force);
  if (arguments.force && arguments.errors.empty()) {
    Warn({"--force: has no effect without --errors"});
  }
  for (const std::string& file : {arguments.reference, arguments.estimate}) {
    RequireOneResultAround(file);
  }
}

// Reads both files and moves the estimate's stamps by the offset given.
TrajectoryFiles ReadShifted(const EvalTrajectoryArguments& arguments) {
  TrajectoryFiles files = ReadTrajectoryFiles(arguments.reference, arguments.estimate);
  Warn(files.warnings);
  if (files.by_row && arguments.time_offset_s != 0.0) {
    Warn({"--time-offset: has no effect because rows pair in order"});
  } else {
    for (StampedPose& pose : files.estimate) pose.stamp_s += arguments.time_offset_s;
  }
  return files;
}

// Pairs with a score; throws InputError if there are none.
Paired PairsWithScore(const TrajectoryFiles& files, const EvalTrajectoryArguments& arguments) {
  const double limit_s = LimitOf(arguments);
  Paired paired =
      files.by_row ? PairByRows(files)
                   : PairByStamps(files.reference, files.estimate, limit_s, arguments.convention);
  if (paired.score) return paired;
  throw InputError(
      arguments.estimate,
      files.by_row ? fmt::format("has no pose in a row in which {} has one", arguments.reference)
                   : NoSharedStampText(files, limit_s, arguments));
}

void WarnOfPaired(const Paired& paired, const TrajectoryFiles& files,
                  const EvalTrajectoryArguments& arguments) {
  if (files.by_row && arguments.max_difference_s >= 0.0) {
    Warn({"--max-difference: has no effect because rows pair in order"});
  }
  Warn(DoubtsOf(*paired.score, paired.pairs, files, arguments));
  if (!files.by_row) {
    Warn(DoubtsOfClock(files.reference, files.estimate, {arguments.reference, arguments.estimate},
                       arguments.time_offset_s));
  }
}

}  // namespace

void EvalTrajectory(const EvalTrajectoryArguments& arguments) {
  RequireSoundArguments(arguments);
  const TrajectoryFiles files = ReadShifted(arguments);
  const Paired paired = PairsWithScore(files, arguments);
  WarnOfPaired(paired, files, arguments);
  if (!arguments.errors.empty()) {
    WriteFile(arguments.errors, ErrorsCsv(paired.pairs, files.has_seconds));
  }
  if (arguments.json) {
    fmt::print("{}", MetricsJson({{"est", paired.score}}, nullptr));
  } else {
    PrintTable(*paired.score);
    PrintDrift(*paired.score);
  }
}

}  // namespace depthgrid::cli
