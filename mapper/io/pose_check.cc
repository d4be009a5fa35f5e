#include "mapper/io/pose_check.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/level.h"
#include "mapper/core/median.h"
#include "mapper/core/usual_step.h"
#include "mapper/io/pose_track.h"

namespace depthgrid {
namespace {

// How far the images of a pair are apart: much of what they show is the same, and the camera has
// turned by more than SLAM errs.
constexpr std::size_t kCheckedPairs = 24;
constexpr double kPairApartS = 0.5;
// Images that are farther apart than so many times that have a pause of the recording between them,
// and may show different things.
constexpr double kMostApart = 2.0;

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
// Cameras with focal lengths 20 % off or more and mounting angles of 15 degrees had 0.1 to 0.55.
constexpr double kClearlyBetter = 0.6;

constexpr double kMostShiftS = 5.0;
constexpr double kCoarseShiftS = 0.1;
constexpr double kFineShiftS = 0.01;
// Shifts that fit so much worse than the best fit alike: while nothing turns and no speed changes,
// poses of a moment later say the same.
constexpr double kFitsAlike = 1.005;
constexpr double kMostUnsureS = 1.0;

// Depth or poses in wrong units: up to a thousand times.
constexpr double kCoarseScale = 1.15;
constexpr double kFineScale = 1.01;
constexpr double kMostScale = 1e3;
// Cameras for images of half or twice the size.
constexpr double kCoarseFocal = 1.06;
constexpr double kMostFocal = 2.1;
// Over a few seconds SLAM's own errors look like a camera that is some percent off: 6 % of a right
// one in two of four runs of three seconds.
constexpr double kLeastFocal = 1.1;
// How cameras are mounted on robots.
constexpr double kCoarsePitchRad = RadFromDeg(5.0);
constexpr double kFinePitchRad = RadFromDeg(0.5);
constexpr double kMostPitchRad = RadFromDeg(60.0);
// Found to two degrees; less is a level camera.
constexpr double kLeastPitchRad = RadFromDeg(2.0);

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

Pose3 AsGiven(const Pose3& pose) { return pose; }

// The camera looks so far below the axes' forward direction.
Pose3 LookingDown(const Pose3& pose, double down_rad) {
  const Eigen::AngleAxisd down(-down_rad, Eigen::Vector3d::UnitX());
  return {pose.rotation * Eigen::Quaterniond(down), pose.translation};
}

PinholeCamera WithFocal(PinholeCamera camera, double scale) {
  camera.fx_px *= scale;
  camera.fy_px *= scale;
  return camera;
}

// The image's corner, half a pixel before the middle of the first, stays where it is.
PinholeCamera OfImageSize(PinholeCamera camera, double scale) {
  camera = WithFocal(camera, scale);
  camera.cx_px = scale * (camera.cx_px + 0.5) - 0.5;
  camera.cy_px = scale * (camera.cy_px + 0.5) - 0.5;
  return camera;
}

// How poses and camera may have been meant.
struct Attempt {
  PoseChange change;
  PinholeCamera camera;
  double shift_s = 0.0;
};

// The images' relative poses in one reading and how well they fit.
class Fits {
 public:
  Fits(const std::vector<ImagePair>& pairs, const std::vector<SlamPose>& live,
       const RecordingOptions& options)
      : pairs_(pairs), track_(live, Interpolating(options)) {}

  // Nothing when too few pairs have poses.
  std::optional<double> Misfit(const Attempt& attempt, std::size_t least) const {
    double sum = 0.0;
    std::size_t count = 0;
    for (const ImagePair& pair : pairs_) {
      const auto first = track_.At(pair.first_s + attempt.shift_s);
      const auto second = track_.At(pair.second_s + attempt.shift_s);
      const bool known = first.slam_from_camera && second.slam_from_camera;
      if (!known || first.epoch != second.epoch) continue;
      const Pose3 second_from_first = Between(attempt.change(*second.slam_from_camera),
                                              attempt.change(*first.slam_from_camera));
      sum += std::min(kMostMisfit, MisfitOf(pair, attempt.camera, second_from_first));
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
  PoseTrack track_;
};

// Of the readings tried so far the one with which the images fit best; first that as given.
class BestReading {
 public:
  // `least`: pairs that must have poses. `time_offset_s`: RecordingOptions' own.
  BestReading(const Fits& fits, const PinholeCamera& camera, std::size_t least, double as_given,
              double time_offset_s)
      : fits_(fits), camera_(camera), least_(least) {
    best_.time_offset_s = time_offset_s;
    best_.misfit = as_given;
    best_.better_misfit = as_given;
    as_given_ = best_;
  }
  const PoseDoubt& doubt() const { return best_; }

  // Other meanings of what stands in the file.
  void TryWritten(const PoseChange& as_written) {
    const auto attempt = [&](PoseReading reading, Pose3 (*change)(const Pose3&)) {
      PoseDoubt doubt = as_given_;
      doubt.reading = reading;
      Try(doubt,
          {[&](const Pose3& pose) { return as_written(change(as_written(pose))); }, camera_});
    };
    attempt(PoseReading::kWFirst, WithWFirst);
    attempt(PoseReading::kInverse, Inverse);
    attempt(PoseReading::kBodyAxes, FromBodyAxes);
    attempt(PoseReading::kGlAxes, FromGlAxes);
  }
  void TryShifts() {
    TryShifts(0.0, kCoarseShiftS, kMostShiftS);
    if (best_.reading != PoseReading::kShifted) return;
    TryShifts(best_.time_offset_s - as_given_.time_offset_s, kFineShiftS, kCoarseShiftS);
    TakeMiddleOfShifts();
  }
  void TryScales() {
    const auto scaled = [&](double scale) {
      return Attempt{[scale](const Pose3& pose) {
                       return Pose3{pose.rotation, scale * pose.translation};
                     },
                     camera_};
    };
    TryFactors(PoseReading::kScaled, {kCoarseScale, kMostScale, 1.0}, scaled);
  }
  void TryCameras() {
    const Factors factors{kCoarseFocal, kMostFocal, kLeastFocal};
    TryFactors(PoseReading::kFocal, factors, [&](double scale) {
      return Attempt{AsGiven, WithFocal(camera_, scale)};
    });
    TryFactors(PoseReading::kImageSize, factors, [&](double scale) {
      return Attempt{AsGiven, OfImageSize(camera_, scale)};
    });
  }
  void TryPitches() {
    TryPitches(PoseReading::kPitched, AsGiven);
    TryPitches(PoseReading::kPitchedBodyAxes, FromBodyAxes);
  }

 private:
  // `doubt` is what the attempt means if it is the best.
  void Try(PoseDoubt doubt, const Attempt& attempt) {
    const auto misfit = fits_.Misfit(attempt, least_);
    if (!misfit || *misfit >= best_.better_misfit) return;
    doubt.better_misfit = *misfit;
    best_ = doubt;
  }
  void TryShifts(double around_s, double step_s, double most_s) {
    const int steps = static_cast<int>(std::lround(most_s / step_s));
    for (int k = -steps; k <= steps; ++k) {
      const double shift_s = around_s + k * step_s;
      PoseDoubt doubt = as_given_;
      doubt.reading = PoseReading::kShifted;
      doubt.time_offset_s += shift_s;
      Try(doubt, {AsGiven, camera_, shift_s});
    }
  }
  void TakeMiddleOfShifts() {
    const double best_s = best_.time_offset_s - as_given_.time_offset_s;
    const auto reach_s = [&](double step_s) {
      const int most = static_cast<int>(std::lround(kMostUnsureS / kFineShiftS));
      int k = 0;
      while (k < most) {
        const auto misfit = fits_.Misfit({AsGiven, camera_, best_s + (k + 1) * step_s}, least_);
        if (!misfit || *misfit > kFitsAlike * best_.better_misfit) break;
        ++k;
      }
      return k * step_s;
    };
    const double later_s = reach_s(kFineShiftS);
    const double earlier_s = reach_s(-kFineShiftS);
    best_.time_offset_s += 0.5 * (later_s + earlier_s);
    best_.time_unsure_s = 0.5 * (later_s - earlier_s);
  }
  // Either way: steps, and how far from 1 at most and at least.
  struct Factors {
    double coarse, most, least;
  };
  // And by fine ones about the best of them.
  template <typename AttemptOf>
  void TryFactors(PoseReading reading, const Factors& factors, const AttemptOf& attempt_of) {
    const auto look = [&](double around, double step, double to) {
      const int steps = static_cast<int>(std::lround(std::log(to) / std::log(step)));
      for (int k = -steps; k <= steps; ++k) {
        PoseDoubt doubt = as_given_;
        doubt.reading = reading;
        doubt.scale = around * std::pow(step, k);
        if (std::abs(std::log(doubt.scale)) < std::log(factors.least)) continue;
        Try(doubt, attempt_of(doubt.scale));
      }
    };
    look(1.0, factors.coarse, factors.most);
    if (best_.reading == reading) look(best_.scale, kFineScale, factors.coarse);
  }
  void TryPitches(PoseReading reading, Pose3 (*axes)(const Pose3&)) {
    const auto look = [&](double around_rad, double step_rad, double most_rad) {
      const int steps = static_cast<int>(std::lround(most_rad / step_rad));
      for (int k = -steps; k <= steps; ++k) {
        PoseDoubt doubt = as_given_;
        doubt.reading = reading;
        doubt.down_rad = around_rad + k * step_rad;
        if (std::abs(doubt.down_rad) < kLeastPitchRad) continue;
        Try(doubt,
            {[&](const Pose3& pose) { return LookingDown(axes(pose), doubt.down_rad); }, camera_});
      }
    };
    look(0.0, kCoarsePitchRad, kMostPitchRad);
    if (best_.reading == reading) look(best_.down_rad, kFinePitchRad, kCoarsePitchRad);
  }

  const Fits& fits_;
  const PinholeCamera& camera_;
  std::size_t least_;
  PoseDoubt as_given_;
  PoseDoubt best_;
};

// From one image to the next; pauses are few.
double UsualImageStepS(std::span<const RecordedImage> images) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < images.size(); ++i) {
    steps_s.push_back(images[i].stamp_s - images[i - 1].stamp_s);
  }
  return UsualStepS(steps_s);
}

}  // namespace

std::vector<RecordedImage> PairsAmong(std::span<const RecordedImage> images) {
  std::vector<RecordedImage> pairs;
  const double most_apart_s = kMostApart * std::max(kPairApartS, UsualImageStepS(images));
  const std::size_t every = std::max<std::size_t>(1, images.size() / kCheckedPairs);
  std::size_t second = 0;
  for (std::size_t first = 0; first < images.size(); first += every) {
    const double first_s = images[first].stamp_s;
    while (second < images.size() && images[second].stamp_s < first_s + kPairApartS) ++second;
    if (second == images.size()) break;
    if (images[second].stamp_s - first_s > most_apart_s) continue;
    pairs.push_back(images[first]);
    pairs.push_back(images[second]);
  }
  return pairs;
}

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
  const Fits fits(pairs, live, options);
  const std::size_t usable = fits.PairsWithPoses();
  if (usable < kLeastPairs) return {};
  const auto least = static_cast<std::size_t>(kLeastPairShare * static_cast<double>(usable));
  const auto as_given = fits.Misfit({AsGiven, camera}, least);
  if (!as_given) return {};
  BestReading best(fits, camera, least, *as_given, options.time_offset_s);
  best.TryWritten(as_written);
  best.TryShifts();
  // With a wrong scale stamps at which the camera moved less fit better too; the scale itself fits
  // best.
  best.TryScales();
  best.TryCameras();
  best.TryPitches();
  if (best.doubt().better_misfit > kClearlyBetter * *as_given) return {};
  return best.doubt();
}

}  // namespace depthgrid
