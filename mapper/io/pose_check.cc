#include "mapper/io/pose_check.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/level.h"
#include "mapper/core/median.h"
#include "mapper/io/pose_track.h"

namespace depthgrid {
namespace {

constexpr int kPointsAcross = 40;  // of an image, looked at
// Fewer points of one image that the other shows say nothing.
constexpr double kLeastShared = 0.2;
constexpr double kNothingShared = 1.0;

constexpr std::size_t kLeastPairs = 6;
// Of the pairs that have poses as given, those that must have them in another reading.
constexpr double kLeastPairShare = 0.75;
// One pair across a correction of SLAM must not outweigh all others.
constexpr double kMostMisfit = 0.3;
// Another reading must fit this much better. Three shipped rooms with all profiles of SLAM and
// three recorded SLAM runs: no other reading fitted right poses any better, and the right reading
// of wrong ones (of quaternions, inverse, half a second off) had 0.06 to 0.32 of their misfit.
constexpr double kClearlyBetter = 0.6;

constexpr double kMostShiftS = 5.0;
constexpr double kCoarseShiftS = 0.1;
constexpr double kFineShiftS = 0.01;

// Depth or poses in wrong units: up to a thousand times.
constexpr double kCoarseScale = 1.15;
constexpr double kFineScale = 1.01;
constexpr double kMostScale = 1e3;

Pose3 WithWFirst(const Pose3& pose) {
  const Eigen::Quaterniond& q = pose.rotation;  // x y z w as read hold w x y z
  return {Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()), pose.translation};
}

Pose3 FromBodyAxes(const Pose3& pose) {
  const Eigen::Quaterniond body_from_camera = CameraOf(Pose2{}, 0.0).rotation;
  return {pose.rotation * body_from_camera, pose.translation};
}

Pose3 FromGlAxes(const Pose3& pose) {
  return {pose.rotation * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0), pose.translation};
}

// The images' relative poses in one reading and how well they fit.
class Fits {
 public:
  Fits(const std::vector<ImagePair>& pairs, const PinholeCamera& camera,
       const std::vector<SlamPose>& live, const RecordingOptions& options)
      : pairs_(pairs), camera_(camera), track_(live, Interpolating(options)) {}

  // Nothing when too few pairs have poses.
  std::optional<double> Misfit(const PoseChange& change, double shift_s, std::size_t least) const {
    double sum = 0.0;
    std::size_t count = 0;
    for (const ImagePair& pair : pairs_) {
      const auto first = track_.At(pair.first_s + shift_s);
      const auto second = track_.At(pair.second_s + shift_s);
      const bool known = first.slam_from_camera && second.slam_from_camera;
      if (!known || first.epoch != second.epoch) continue;
      const Pose3 second_from_first =
          Between(change(*second.slam_from_camera), change(*first.slam_from_camera));
      sum += std::min(kMostMisfit, MisfitOf(pair, camera_, second_from_first));
      ++count;
    }
    if (count < least) return {};
    return sum / static_cast<double>(count);
  }
  std::size_t PairsWithPoses() const {
    return static_cast<std::size_t>(
        std::count_if(pairs_.begin(), pairs_.end(), [&](const ImagePair& pair) {
          return track_.At(pair.first_s).slam_from_camera &&
                 track_.At(pair.second_s).slam_from_camera;
        }));
  }

 private:
  static RecordingOptions Interpolating(RecordingOptions options) {
    options.interpolate_poses = true;
    return options;
  }

  const std::vector<ImagePair>& pairs_;
  const PinholeCamera& camera_;
  PoseTrack track_;
};

Pose3 AsGiven(const Pose3& pose) { return pose; }

// Of the readings tried so far the one with which the images fit best; first that as given.
class BestReading {
 public:
  // `least`: pairs that must have poses. `time_offset_s`: RecordingOptions' own.
  BestReading(const Fits& fits, std::size_t least, double as_given, double time_offset_s)
      : fits_(fits), least_(least), time_offset_s_(time_offset_s) {
    best_.misfit = as_given;
    best_.better_misfit = as_given;
  }
  const PoseDoubt& doubt() const { return best_; }

  // Other meanings of what stands in the file.
  void TryWritten(const PoseChange& as_written) {
    const auto attempt = [&](PoseReading reading, Pose3 (*change)(const Pose3&)) {
      const auto in_world = [&](const Pose3& pose) { return as_written(change(as_written(pose))); };
      Try(reading, in_world, 0.0);
    };
    attempt(PoseReading::kWFirst, WithWFirst);
    attempt(PoseReading::kInverse, Inverse);
    attempt(PoseReading::kBodyAxes, FromBodyAxes);
    attempt(PoseReading::kGlAxes, FromGlAxes);
  }
  void TryShifts() {
    TryShifts(0.0, kCoarseShiftS, kMostShiftS);
    if (best_.reading != PoseReading::kShifted) return;
    TryShifts(best_.time_offset_s - time_offset_s_, kFineShiftS, kCoarseShiftS);
  }
  void TryScales() {
    TryScales(1.0, kCoarseScale, kMostScale);
    if (best_.reading == PoseReading::kScaled) TryScales(best_.scale, kFineScale, kCoarseScale);
  }

 private:
  // Whether it is the best.
  bool Try(PoseReading reading, const PoseChange& change, double shift_s) {
    const auto misfit = fits_.Misfit(change, shift_s, least_);
    if (!misfit || *misfit >= best_.better_misfit) return false;
    best_ = {reading, time_offset_s_ + shift_s, 1.0, best_.misfit, *misfit};
    return true;
  }
  void TryShifts(double around_s, double step_s, double most_s) {
    const int steps = static_cast<int>(std::lround(most_s / step_s));
    for (int k = -steps; k <= steps; ++k) {
      Try(PoseReading::kShifted, AsGiven, around_s + k * step_s);
    }
  }
  // By factors of `step` up to `most` either way.
  void TryScales(double around, double step, double most) {
    const int steps = static_cast<int>(std::lround(std::log(most) / std::log(step)));
    for (int k = -steps; k <= steps; ++k) {
      const double scale = around * std::pow(step, k);
      const auto scaled = [scale](const Pose3& pose) {
        return Pose3{pose.rotation, scale * pose.translation};
      };
      if (Try(PoseReading::kScaled, scaled, 0.0)) best_.scale = scale;
    }
  }

  const Fits& fits_;
  std::size_t least_;
  double time_offset_s_;
  PoseDoubt best_;
};

}  // namespace

double MisfitOf(const ImagePair& pair, const PinholeCamera& camera,
                const Pose3& second_from_first) {
  const DepthImage& first = *pair.first;
  const DepthImage& second = *pair.second;
  const int step_px = std::max(1, first.width_px / kPointsAcross);
  std::vector<double> misfits;
  int points = 0;
  for (int v = step_px / 2; v < first.height_px; v += step_px) {
    for (int u = step_px / 2; u < first.width_px; u += step_px) {
      const float z = first.At(u, v);
      if (!(z > 0.0F)) continue;
      ++points;
      const Eigen::Vector3d there = second_from_first * Unproject(camera, u, v, z);
      if (!(there.z() > 0.0)) continue;
      const Eigen::Vector2d pixel = Project(camera, there).array().round();
      const bool inside = pixel.x() >= 0.0 && pixel.x() < second.width_px && pixel.y() >= 0.0 &&
                          pixel.y() < second.height_px;
      if (!inside) continue;
      const float seen = second.At(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
      if (seen > 0.0F) misfits.push_back(std::abs(there.z() - seen) / seen);
    }
  }
  if (points == 0 || static_cast<double>(misfits.size()) < kLeastShared * points) {
    return kNothingShared;
  }
  return UpperMedian(misfits);
}

std::optional<PoseDoubt> DoubtOfPoses(const std::vector<ImagePair>& pairs,
                                      const PinholeCamera& camera,
                                      const std::vector<SlamPose>& live,
                                      const RecordingOptions& options,
                                      const PoseChange& as_written) {
  const Fits fits(pairs, camera, live, options);
  const std::size_t usable = fits.PairsWithPoses();
  if (usable < kLeastPairs) return {};
  const auto least = static_cast<std::size_t>(kLeastPairShare * static_cast<double>(usable));
  const auto as_given = fits.Misfit(AsGiven, 0.0, least);
  if (!as_given) return {};
  BestReading best(fits, least, *as_given, options.time_offset_s);
  best.TryWritten(as_written);
  best.TryShifts();
  // With a wrong scale stamps at which the camera moved less fit better too; the scale itself fits
  // best.
  best.TryScales();
  if (best.doubt().better_misfit > kClearlyBetter * *as_given) return {};
  return best.doubt();
}

}  // namespace depthgrid
