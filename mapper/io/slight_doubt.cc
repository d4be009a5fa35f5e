#include "mapper/io/slight_doubt.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "mapper/core/usual_step.h"
#include "mapper/io/pose_readings.h"

namespace depthgrid {
namespace {

// What makes an error sure (docs/tried.md, "Slight errors"): standard deviations by which it
// differs from zero, the share of the misfit that is left with it, and for factors how much may be
// left. SLAM's errors of a minute look like a wrong factor, too, but leave more.
constexpr double kSureSigmas = 5.0;
constexpr double kMostLeftShare = 0.9;
constexpr double kMostLeft = 0.006;
// Groups of successive pairs, as SLAM's errors are alike from one pair to the next.
constexpr std::size_t kGroups = 12;
// Factors are sought to 20 % either way; beyond 10 to 20 % a clearly better reading is found before
// (pose_check.cc). These and the steps below are chosen, not measured.
constexpr double kLeastLogFactor = 0.01;
constexpr double kLogFactorStep = 0.01;
constexpr int kFactorSteps = 18;
// Steps to either side of the least misfit that a parabola is laid through: a median moves in
// jumps.
constexpr int kFactorReach = 3;
// In frames. Half a frame off, poses are the mean of two, whose noise is smaller: whole frames
// only, and what would be left at the least is read off the parabola.
constexpr double kLeastFrames = 1.0 / 3.0;
constexpr int kFrameSteps = 8;
constexpr int kFrameReach = 1;  // farther ones would make the least jump between two frames
// With poses farther apart than this (slower than 10 Hz, a little jitter allowed) a time offset is
// not sought: between them poses are only interpolated.
constexpr double kMostFrameS = 0.11;

// An error that is sought: by `step` from -steps to steps.
struct Sought {
  double step = 0.0;
  int steps = 0;
  int reach = 0;  // of the parabola, in steps
  std::function<PoseAttempt(double)> attempt_of;
  bool from_parabola = false;  // whether its least tells the misfit, if that is less
};

// The least error that is told, and the most misfit that it leaves.
struct Limits {
  double least = 0.0;
  double most_left = 0.0;
};

struct Found {
  double error = 0.0;
  double sigma = 0.0;
  double misfit = 0.0;  // mean, with it
};

using Misfits = std::vector<double>;  // of one attempt, by pair

// The misfits of all attempts; pairs without poses in one of them are left out.
std::vector<Misfits> MisfitsOf(const PoseFits& fits, const Sought& sought) {
  std::vector<std::vector<std::optional<double>>> all;
  for (int k = -sought.steps; k <= sought.steps; ++k) {
    all.push_back(fits.OfEach(sought.attempt_of(k * sought.step)));
  }
  std::vector<Misfits> kept(all.size());
  for (std::size_t pair = 0; pair < all[0].size(); ++pair) {
    bool has_poses = true;
    for (const auto& misfits : all) has_poses = has_poses && misfits[pair];
    if (!has_poses) continue;
    for (std::size_t k = 0; k < all.size(); ++k) kept[k].push_back(*all[k][pair]);
  }
  return kept;
}

struct Least {
  double at = 0.0;  // in steps from the first attempt
  double sum = 0.0;
};

// Where the sum of misfits is least; nothing where it has no minimum.
std::optional<Least> LeastOf(const std::vector<double>& sums, int reach) {
  const auto least = std::min_element(sums.begin(), sums.end()) - sums.begin();
  if (least < reach || least + reach >= static_cast<std::ptrdiff_t>(sums.size())) return {};
  const auto at = static_cast<std::size_t>(least);
  const auto apart = static_cast<std::size_t>(reach);
  const double before = sums[at - apart], after = sums[at + apart];
  const double bend = before - 2.0 * sums[at] + after;
  if (!(bend > 0.0)) return {};
  return Least{static_cast<double>(least) + 0.5 * reach * (before - after) / bend,
               sums[at] - (after - before) * (after - before) / (8.0 * bend)};
}

// With the jackknife's standard deviation: each group of pairs left out in turn.
std::optional<Found> Find(const PoseFits& fits, const Sought& sought) {
  const std::vector<Misfits> misfits = MisfitsOf(fits, sought);
  const std::size_t pairs = misfits[0].size();
  if (pairs < kGroups) return {};
  std::vector<double> sums;
  for (const Misfits& of_attempt : misfits) {
    sums.push_back(std::accumulate(of_attempt.begin(), of_attempt.end(), 0.0));
  }
  const auto least = LeastOf(sums, sought.reach);
  if (!least) return {};
  double squares = 0.0;
  for (std::size_t group = 0; group < kGroups; ++group) {
    std::vector<double> without = sums;
    for (std::size_t k = 0; k < sums.size(); ++k) {
      for (std::size_t pair = group * pairs / kGroups; pair < (group + 1) * pairs / kGroups;
           ++pair) {
        without[k] -= misfits[k][pair];
      }
    }
    const auto least_without = LeastOf(without, sought.reach);
    if (!least_without) return {};
    const double off = least_without->at - least->at;
    squares += off * off;
  }
  constexpr double kShare = 1.0 - 1.0 / static_cast<double>(kGroups);
  Found found;
  found.error = (least->at - sought.steps) * sought.step;
  found.sigma = sought.step * std::sqrt(kShare * squares);
  found.misfit =
      fits.Mean(sought.attempt_of(found.error), PoseFits::kLeastPairs).value_or(kNothingShared);
  if (sought.from_parabola) {
    found.misfit = std::min(found.misfit, least->sum / static_cast<double>(pairs));
  }
  return found;
}

Pose3 Unchanged(const Pose3& pose) { return pose; }

Sought FocalOf(const PinholeCamera& camera) {
  return {kLogFactorStep, kFactorSteps, kFactorReach, [&camera](double log_factor) {
            return PoseAttempt{Unchanged, WithFocal(camera, std::exp(log_factor))};
          }};
}

Sought ScaleOf(const PinholeCamera& camera) {
  return {kLogFactorStep, kFactorSteps, kFactorReach, [&camera](double log_factor) {
            return PoseAttempt{[scale = std::exp(log_factor)](const Pose3& pose) {
                                 return Pose3{pose.rotation, scale * pose.translation};
                               },
                               camera};
          }};
}

Sought ShiftOf(const PinholeCamera& camera, double frame_s, double around_s = 0.0) {
  return {frame_s, kFrameSteps, kFrameReach,
          [&camera, around_s](double shift_s) {
            return PoseAttempt{Unchanged, camera, around_s + shift_s};
          },
          true};
}

bool SeeksShift(double frame_s) { return frame_s > 0.0 && frame_s <= kMostFrameS; }

}  // namespace

std::optional<FineShift> FineShiftAround(const PoseFits& fits, const PinholeCamera& camera,
                                         const std::vector<SlamPose>& live, double around_s) {
  const double frame_s = UsualStepBetween(live, &SlamPose::stamp_s);
  if (!SeeksShift(frame_s)) return {};
  const auto found = Find(fits, ShiftOf(camera, frame_s, around_s));
  if (!found) return {};
  return FineShift{around_s + found->error, found->sigma};
}

std::optional<PoseDoubt> SlightDoubtOf(const PoseFits& fits, const PinholeCamera& camera,
                                       const std::vector<SlamPose>& live,
                                       const RecordingOptions& options) {
  const auto as_given = fits.Mean({Unchanged, camera}, PoseFits::kLeastPairs);
  if (!as_given) return {};
  std::optional<PoseDoubt> best;
  const auto seek = [&](const Sought& sought, const Limits& limits, const auto& doubt_of) {
    const auto found = Find(fits, sought);
    if (!found || std::abs(found->error) < std::max(limits.least, kSureSigmas * found->sigma)) {
      return;
    }
    if (found->misfit > std::min(limits.most_left, kMostLeftShare * *as_given)) return;
    if (best && best->better_misfit <= found->misfit) return;
    best = doubt_of(found->error);
    best->sigma = found->sigma;
    best->misfit = *as_given;
    best->better_misfit = found->misfit;
  };
  const auto factor = [](PoseReading reading) {
    return [reading](double log_factor) {
      PoseDoubt doubt;
      doubt.reading = reading;
      doubt.scale = std::exp(log_factor);
      return doubt;
    };
  };
  seek(FocalOf(camera), {kLeastLogFactor, kMostLeft}, factor(PoseReading::kFocal));
  seek(ScaleOf(camera), {kLeastLogFactor, kMostLeft}, factor(PoseReading::kScaled));
  const double frame_s = UsualStepBetween(live, &SlamPose::stamp_s);
  if (!SeeksShift(frame_s)) return best;
  seek(ShiftOf(camera, frame_s), {kLeastFrames * frame_s, PoseFits::kMostMisfit},
       [&](double shift_s) {
         PoseDoubt doubt;
         doubt.reading = PoseReading::kShifted;
         doubt.time_offset_s = options.time_offset_s + shift_s;
         return doubt;
       });
  return best;
}

}  // namespace depthgrid
