#include "mapper/io/pose_fits.h"

#include <algorithm>
#include <numeric>

namespace depthgrid {
namespace {

RecordingOptions Interpolating(RecordingOptions options) {
  options.interpolate_poses = true;
  return options;
}

}  // namespace

PoseFits::PoseFits(const std::vector<ImagePair>& pairs, const std::vector<SlamPose>& live,
                   const RecordingOptions& options)
    : pairs_(pairs), track_(live, Interpolating(options)) {}

std::optional<double> PoseFits::Mean(const PoseAttempt& attempt, std::size_t least,
                                     double most) const {
  constexpr double kRounding = 1.0 + 1e-9;  // when a sum is compared with its limit
  const double most_sum = kRounding * most * static_cast<double>(pairs_.size());
  double sum = 0.0;
  std::size_t count = 0;
  for (const ImagePair& pair : pairs_) {
    if (sum > most_sum) return {};
    const auto second_from_first = RelativeIn(pair, attempt);
    if (!second_from_first) continue;
    sum +=
        std::min(kMostMisfit, MisfitOf(pair, attempt.camera, *second_from_first, attempt.meaning));
    ++count;
  }
  if (count < least) return {};
  return sum / static_cast<double>(count);
}

std::vector<double> PoseFits::SharedMisfits(const PoseAttempt& attempt, PairPoints which) const {
  std::vector<double> misfits;
  for (const ImagePair& pair : pairs_) {
    const auto second_from_first = RelativeIn(pair, attempt);
    if (!second_from_first) continue;
    const double misfit =
        MisfitOf(pair, attempt.camera, *second_from_first, attempt.meaning, which);
    if (misfit != kNothingShared) misfits.push_back(std::min(kMostMisfit, misfit));
  }
  return misfits;
}

double PoseFits::WhereShared(const PoseAttempt& attempt, PairPoints which) const {
  const std::vector<double> misfits = SharedMisfits(attempt, which);
  if (misfits.size() < kLeastPairs) return 0.0;
  return std::accumulate(misfits.begin(), misfits.end(), 0.0) / static_cast<double>(misfits.size());
}

double PoseFits::ShareAbove(double misfit, const PoseAttempt& attempt, PairPoints which) const {
  const std::vector<double> misfits = SharedMisfits(attempt, which);
  if (misfits.size() < kLeastPairs) return 0.0;
  const auto above = std::count_if(misfits.begin(), misfits.end(),
                                   [misfit](double of_pair) { return of_pair > misfit; });
  return static_cast<double>(above) / static_cast<double>(misfits.size());
}

std::vector<std::optional<double>> PoseFits::OfEach(const PoseAttempt& attempt) const {
  std::vector<std::optional<double>> misfits;
  misfits.reserve(pairs_.size());
  for (const ImagePair& pair : pairs_) {
    const auto second_from_first = RelativeIn(pair, attempt);
    misfits.emplace_back();
    if (!second_from_first) continue;
    misfits.back() =
        std::min(kMostMisfit, MisfitOf(pair, attempt.camera, *second_from_first, attempt.meaning));
  }
  return misfits;
}

std::size_t PoseFits::PairsWithPoses() const {
  return static_cast<std::size_t>(
      std::count_if(pairs_.begin(), pairs_.end(), [&](const ImagePair& pair) {
        return track_.At(pair.first_s).slam_from_camera &&
               track_.At(pair.second_s).slam_from_camera;
      }));
}

std::optional<Pose3> PoseFits::RelativeIn(const ImagePair& pair, const PoseAttempt& attempt) const {
  const auto first = track_.At(pair.first_s + attempt.shift_s);
  const auto second = track_.At(pair.second_s + attempt.shift_s);
  const bool known = first.slam_from_camera && second.slam_from_camera;
  if (!known || first.epoch != second.epoch) return {};
  return Between(attempt.change(*second.slam_from_camera), attempt.change(*first.slam_from_camera));
}

}  // namespace depthgrid
