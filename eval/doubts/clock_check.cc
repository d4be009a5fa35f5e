#include "eval/doubts/clock_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "eval/doubts/aligned_misfit.h"
#include "eval/metrics/association.h"

namespace depthgrid {
namespace {

constexpr double kNoFit = std::numeric_limits<double>::infinity();
constexpr std::size_t kLeastPoses = 10;

// The reference's pose at a time, with interpolated position; empty outside its stamps and in gaps.
std::optional<StampedPose> At(const Trajectory& reference, double stamp_s) {
  constexpr double kLongestGapS = 1.0;
  const auto after =
      std::lower_bound(reference.begin(), reference.end(), stamp_s,
                       [](const StampedPose& pose, double stamp) { return pose.stamp_s < stamp; });
  if (after == reference.end()) return std::nullopt;
  if (after->stamp_s == stamp_s) return *after;
  if (after == reference.begin()) return std::nullopt;
  const StampedPose& before = *std::prev(after);
  const double gap_s = after->stamp_s - before.stamp_s;
  if (gap_s > kLongestGapS) return std::nullopt;
  const double share = (stamp_s - before.stamp_s) / gap_s;
  StampedPose pose{stamp_s, before.world_from_camera};
  pose.world_from_camera.translation +=
      share * (after->world_from_camera.translation - before.world_from_camera.translation);
  return pose;
}

// Evenly spaced poses, enough to determine an offset.
Trajectory SomeOf(const Trajectory& trajectory) {
  constexpr std::size_t kMost = 500;
  const std::size_t step = (trajectory.size() + kMost - 1) / kMost;
  Trajectory some;
  for (std::size_t i = 0; i < trajectory.size(); i += step) some.push_back(trajectory[i]);
  return some;
}

class Clocks {
 public:
  Clocks(const Trajectory& reference, const Trajectory& estimate)
      : reference_(reference), estimate_(SomeOf(estimate)) {
    std::size_t most = 0;
    for (double offset_s = -kMostClockOffsetS; offset_s <= kMostClockOffsetS;
         offset_s += kCoarseStepS) {
      most = std::max(most, PairsAt(offset_s, offset_s).size());
    }
    least_ =
        std::max(kLeastPoses, static_cast<std::size_t>(kLeastShare * static_cast<double>(most)));
  }

  // Misfit over the poses at which the reference is known with both offsets.
  double Misfit(double offset_s, double other_offset_s) const {
    const std::vector<PosePair> pairs = PairsAt(offset_s, other_offset_s);
    if (pairs.size() < least_) return kNoFit;
    return AlignedMisfit(pairs).value_or(kNoFit);
  }

  // The same over twelve stretches, each aligned by itself; empty where none can be.
  std::optional<double> MisfitOfStretches(double offset_s, double other_offset_s) const {
    constexpr std::size_t kStretches = 12;
    const std::vector<PosePair> pairs = PairsAt(offset_s, other_offset_s);
    double squares = 0.0;
    std::size_t poses = 0;
    for (std::size_t k = 0; k < kStretches; ++k) {
      const auto at = [&](std::size_t i) {
        return pairs.begin() + static_cast<std::ptrdiff_t>(i * pairs.size() / kStretches);
      };
      const std::vector<PosePair> stretch(at(k), at(k + 1));
      const auto misfit_m = AlignedMisfit(stretch);
      if (!misfit_m) continue;
      squares += static_cast<double>(stretch.size()) * *misfit_m * *misfit_m;
      poses += stretch.size();
    }
    if (poses == 0) return {};
    return std::sqrt(squares / static_cast<double>(poses));
  }

  struct Best {
    double offset_s = 0.0;
    double unsure_s = 0.0;
  };
  // The offset with the fewest digits that fits as well as the best one, and how far from it
  // offsets fit equally well.
  Best BestOffset() const {
    // The same as in `map` (mapper/io/pose_check.cc).
    constexpr double kAlike = 1.005;
    const double best_s = FinestOffset();
    const double most_m = kAlike * Misfit(best_s, best_s);
    const auto fits = [&](double offset_s) { return Misfit(offset_s, offset_s) <= most_m; };
    double offset_s = best_s;
    for (const double unit_s : {0.01, 0.1, 1.0}) {
      const double round_s = unit_s * std::round(best_s / unit_s);
      if (round_s != 0.0 && fits(round_s)) offset_s = round_s;
    }
    double unsure_s = 0.0;
    for (const double step_s : {-kMediumStepS, kMediumStepS}) {
      for (int k = 1; k * kMediumStepS <= kCoarseStepS && fits(offset_s + k * step_s); ++k) {
        unsure_s = std::max(unsure_s, k * kMediumStepS);
      }
    }
    return {offset_s, unsure_s};
  }

 private:
  // Of the search, each around the best of the one before.
  static constexpr double kCoarseStepS = 0.1;
  static constexpr double kMediumStepS = 0.01;
  static constexpr double kFineStepS = 0.001;
  // Share of the usual number of poses that an offset must leave: the fewer poses, the better any
  // offset fits.
  static constexpr double kLeastShare = 0.8;

  std::vector<PosePair> PairsAt(double offset_s, double other_offset_s) const {
    std::vector<PosePair> pairs;
    for (const StampedPose& pose : estimate_) {
      if (!At(reference_, pose.stamp_s + other_offset_s)) continue;
      if (const auto truth = At(reference_, pose.stamp_s + offset_s)) {
        pairs.push_back({*truth, pose});
      }
    }
    return pairs;
  }
  double FinestOffset() const {
    double best_s = 0.0;
    double reach_s = kMostClockOffsetS;
    for (const double step_s : {kCoarseStepS, kMediumStepS, kFineStepS}) {
      best_s = BestAround(best_s, step_s, reach_s);
      reach_s = step_s;
    }
    return best_s;
  }
  // The best offset on a grid around `around_s`; the nearest to it on ties.
  double BestAround(double around_s, double step_s, double reach_s) const {
    double best_s = around_s;
    double least_m = Misfit(around_s, around_s);
    const int steps = static_cast<int>(std::lround(reach_s / step_s));
    for (int k = 1; k <= steps; ++k) {
      for (const double offset_s : {around_s - k * step_s, around_s + k * step_s}) {
        const double misfit_m = Misfit(offset_s, offset_s);
        if (!(misfit_m < least_m)) continue;
        least_m = misfit_m;
        best_s = offset_s;
      }
    }
    return best_s;
  }

  const Trajectory& reference_;
  Trajectory estimate_;
  std::size_t least_ = kLeastPoses;
};

}  // namespace

std::optional<ClockOffset> FindClockOffset(const Trajectory& reference,
                                           const Trajectory& estimate) {
  constexpr double kBetter = 0.7;  // of the misfit
  if (reference.size() < kLeastPoses || estimate.size() < kLeastPoses) return std::nullopt;
  const Clocks clocks(reference, estimate);
  ClockOffset found;
  const auto [offset_s, unsure_s] = clocks.BestOffset();
  found.offset_s = offset_s;
  found.unsure_s = unsure_s;
  found.better_misfit_m = clocks.Misfit(found.offset_s, 0.0);
  found.misfit_m = clocks.Misfit(0.0, found.offset_s);
  if (!std::isfinite(found.better_misfit_m) || !std::isfinite(found.misfit_m)) return std::nullopt;
  if (found.misfit_m - found.better_misfit_m <= kLeastGainM) return std::nullopt;
  if (found.better_misfit_m >= kBetter * found.misfit_m) return std::nullopt;
  const auto better = clocks.MisfitOfStretches(found.offset_s, 0.0);
  const auto as_given = clocks.MisfitOfStretches(0.0, found.offset_s);
  return better && as_given && *better < *as_given ? std::optional(found) : std::nullopt;
}

}  // namespace depthgrid
