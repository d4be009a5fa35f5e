#include "mapper/io/pose_check.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/level.h"
#include "mapper/io/camera_formats.h"
#include "mapper/io/pose_fits.h"
#include "mapper/io/pose_readings.h"
#include "mapper/io/signed_axes.h"
#include "mapper/io/slight_doubt.h"

namespace depthgrid {
namespace {

// Share of the pairs with poses as given that must have poses in another reading.
constexpr double kLeastPairShare = 0.75;
// Another reading must have at most this share of the misfit. In three rooms with all SLAM profiles
// and three recorded SLAM runs none fitted correct poses better; the correct reading of wrong poses
// (quaternion order, inverse, 0.5 s off) had 0.06 to 0.32 of their misfit, with focal lengths 20 %
// off or 15 degrees of pitch 0.1 to 0.55.
constexpr double kClearlyBetter = 0.6;
// Among readings with similar misfit the one tried first, the more common one, is kept.
constexpr double kBetterThanAlike = 0.9;

// Correct poses have 0.2 to 1.8 % (docs/formats.md), so a reading with more is not the intended
// one, even if the others fit worse.
constexpr double kMostFitting = 0.02;
// Poses that are wrong in all readings tried (shuffled images, constant quaternions) had 4.8 to 7.5
// %; correct ones with all SLAM profiles and depth noises at most 1.3 %.
constexpr double kLeastUnfitting = 0.04;
// So must this share of the pairs. What moves by itself, as somebody ahead of the camera does,
// makes a few pairs misfit, 3 of 23 at most; of wrong poses a third and more (docs/tried.md,
// "Somebody ahead of the camera and the check of poses").
constexpr double kLeastUnfittingPairs = 0.2;

// A greater share of points that keep their depth is of something that moves along with the camera:
// in ten recordings of rooms it was 0.21 to 0.37, behind somebody .7 m ahead 0.43. Half, as it must
// be what makes the median misfit large.
constexpr double kMostKept = 0.5;

constexpr double kMostShiftS = 5.0;
constexpr double kCoarseShiftS = 0.1;
constexpr double kFineShiftS = 0.01;
// Shifts with up to this factor of the best misfit fit equally: during constant straight motion,
// poses of a moment later give the same relative poses.
constexpr double kFitsAlike = 1.005;
constexpr double kMostUnsureS = 1.0;

// Depth or poses in wrong units: up to a thousand times.
constexpr double kCoarseScale = 1.15;
constexpr double kFineScale = 1.01;
constexpr double kMostScale = 1e3;
// Cameras for images of half or twice the size.
constexpr double kCoarseFocal = 1.06;
constexpr double kMostFocal = 2.1;
// Over a few seconds SLAM's errors look like a wrong focal length: by 6 % with a correct one in two
// of four runs of three seconds.
constexpr double kLeastFocal = 1.1;
// In image widths. A principal point off by a quarter is that of an image of half the width.
constexpr double kCoarseCentre = 0.04;
constexpr double kFineCentre = 0.01;
constexpr double kMostCentre = 0.28;
constexpr double kLeastCentre = 0.03;
// How cameras are mounted on robots.
constexpr double kCoarsePitchRad = RadFromDeg(5.0);
constexpr double kFinePitchRad = RadFromDeg(0.5);
constexpr double kMostPitchRad = RadFromDeg(60.0);
// Pitch is found to two degrees; less counts as level.
constexpr double kLeastPitchRad = RadFromDeg(2.0);

Pose3 Inverted(const Pose3& pose) { return Inverse(pose); }
Pose3 AsGiven(const Pose3& pose) { return pose; }
Pose3 FlippedY(const Pose3& pose) { return FlipY(pose); }

const Eigen::Matrix3d kFlipY = Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal();

// The best reading among those tried so far, starting with the poses as given.
class BestReading {
 public:
  // `least`: pairs that must have poses. `time_offset_s`: RecordingOptions' own.
  BestReading(const PoseFits& fits, const PinholeCamera& camera, std::size_t least, double as_given,
              double time_offset_s, bool y_up)
      : fits_(fits), camera_(camera), least_(least), y_up_(y_up) {
    best_.time_offset_s = time_offset_s;
    best_.misfit = as_given;
    best_.better_misfit = as_given;
    as_given_ = best_;
    attempt_ = {AsGiven, camera};
  }
  const PoseDoubt& doubt() const { return best_; }
  const PoseAttempt& attempt() const { return attempt_; }

  // Tries other interpretations of the numbers in the file.
  void TryWritten() {
    TryWritten(PoseReading::kWFirst, WithWFirst);
    TryWritten(PoseReading::kWLast, WithWLast);
    TryWritten(PoseReading::kInverse, Inverted);
    TryAxes(CameraOf(Pose2{}, 0.0).rotation.inverse().toRotationMatrix());  // a robot's
    TryAxes(Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal());                 // OpenGL's
  }
  // With a camera that turns about one axis only, several fit about as well as the right ones.
  void TryOtherAxes() {
    const std::vector<Eigen::Matrix3d> all = AllSignedAxes();
    for (const Eigen::Matrix3d& axes : all) TryPositions(axes);
    for (const bool mirrors : {false, true}) {
      for (const Eigen::Matrix3d& axes : all) {
        if ((axes.determinant() < 0.0) == mirrors) TryAxes(axes);
      }
    }
  }
  void TryRayLengths() {
    PoseDoubt doubt = as_given_;
    doubt.reading = PoseReading::kRayLengths;
    Try(doubt, {AsGiven, camera_, 0.0, DepthMeaning::kRayLength}, kBetterThanAlike);
  }
  void TryShifts() {
    TryShifts(0.0, kCoarseShiftS, kMostShiftS);
    if (best_.reading != PoseReading::kShifted) return;
    TryShifts(best_.time_offset_s - as_given_.time_offset_s, kFineShiftS, kCoarseShiftS);
    TakeMiddleOfShifts();
  }
  void TryScales() {
    const auto scaled = [&](double scale) {
      return PoseAttempt{[scale](const Pose3& pose) {
                           return Pose3{pose.rotation, scale * pose.translation};
                         },
                         camera_};
    };
    TryFactors(PoseReading::kScaled, {kCoarseScale, kMostScale, 1.0}, scaled);
  }
  void TryCameras() {
    const Factors factors{kCoarseFocal, kMostFocal, kLeastFocal};
    TryFactors(PoseReading::kFocal, factors, [&](double scale) {
      return PoseAttempt{AsGiven, WithFocal(camera_, scale)};
    });
    TryFactors(PoseReading::kImageSize, factors, [&](double scale) {
      return PoseAttempt{AsGiven, OfImageSize(camera_, scale)};
    });
  }
  // Searches one axis after the other, then finely around the best.
  void TryCentres() {
    TryCentres(0, kCoarseCentre, kMostCentre);
    TryCentres(1, kCoarseCentre, kMostCentre);
    if (best_.reading != PoseReading::kCentre) return;
    for (const int axis : {0, 1, 0, 1}) TryCentres(axis, kFineCentre, kCoarseCentre);
  }
  void TryPitches() {
    TryPitches(PoseReading::kPitched, AsGiven);
    TryPitches(PoseReading::kPitchedBodyAxes, FromBodyAxes);
  }

 private:
  // Keeps `doubt` if the attempt's misfit is below `share` of the best so far.
  void Try(PoseDoubt doubt, const PoseAttempt& attempt, double share = 1.0) {
    const double less_than = share * best_.better_misfit;
    const auto misfit = fits_.Mean(attempt, least_, less_than);
    if (!misfit || *misfit >= less_than) return;
    doubt.better_misfit = *misfit;
    best_ = doubt;
    attempt_ = attempt;
  }
  // An attempt that changes the poses as written in the file (before FlipY).
  PoseAttempt Written(const PoseChange& change) const {
    const PoseChange as_written = y_up_ ? FlippedY : AsGiven;
    return {[=](const Pose3& pose) { return as_written(change(as_written(pose))); }, camera_};
  }
  void TryWritten(PoseReading reading, const PoseChange& change) {
    PoseDoubt doubt = as_given_;
    doubt.reading = reading;
    Try(doubt, Written(change));
  }
  void TryPositions(const Eigen::Matrix3d& axes) {
    PoseDoubt doubt = as_given_;
    doubt.reading = PoseReading::kPositions;
    doubt.axes = axes;
    Try(doubt, Written([axes](const Pose3& pose) {
          return Pose3{pose.rotation, axes * pose.translation};
        }),
        kBetterThanAlike);
  }
  void TryAxes(const Eigen::Matrix3d& camera_from_own) {
    PoseDoubt doubt = as_given_;
    doubt.reading = camera_from_own.isIdentity()          ? PoseReading::kYDown
                    : camera_from_own == kFlipY && !y_up_ ? PoseReading::kYUp
                                                          : PoseReading::kAxes;
    doubt.axes = camera_from_own;
    Try(doubt,
        {[=, y_up = y_up_](const Pose3& pose) {
           return FromAxes(y_up ? FlipY(pose) : pose, camera_from_own);
         },
         camera_},
        kBetterThanAlike);
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
        const double alike = kFitsAlike * best_.better_misfit;
        const auto misfit =
            fits_.Mean({AsGiven, camera_, best_s + (k + 1) * step_s}, least_, alike);
        if (!misfit || *misfit > alike) break;
        ++k;
      }
      return k * step_s;
    };
    const double later_s = reach_s(kFineShiftS);
    const double earlier_s = reach_s(-kFineShiftS);
    best_.time_offset_s += 0.5 * (later_s + earlier_s);
    best_.time_unsure_s = 0.5 * (later_s - earlier_s);
  }
  // Factors to try, both above and below 1: step, and the largest and smallest to accept.
  struct Factors {
    double coarse, most, least;
  };
  // Tries coarse factors, then fine ones around the best.
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
  void TryCentres(int axis, double step, double most) {
    const Eigen::Vector2d given_px(camera_.cx_px, camera_.cy_px);
    const Eigen::Vector2d around_px =
        best_.reading == PoseReading::kCentre ? best_.centre_px : given_px;
    const int steps = static_cast<int>(std::lround(most / step));
    for (int k = -steps; k <= steps; ++k) {
      PoseDoubt doubt = as_given_;
      doubt.reading = PoseReading::kCentre;
      doubt.centre_px = around_px + k * step * camera_.width_px * Eigen::Vector2d::Unit(axis);
      if ((doubt.centre_px - given_px).norm() < kLeastCentre * camera_.width_px) continue;
      Try(doubt, {AsGiven, WithCentre(camera_, doubt.centre_px)});
    }
  }
  void TryPitches(PoseReading reading, Pose3 (*axes)(const Pose3&)) {
    const auto look = [&](double around_rad, double step_rad, double most_rad) {
      const int steps = static_cast<int>(std::lround(most_rad / step_rad));
      for (int k = -steps; k <= steps; ++k) {
        PoseDoubt doubt = as_given_;
        doubt.reading = reading;
        doubt.down_rad = around_rad + k * step_rad;
        if (std::abs(doubt.down_rad) < kLeastPitchRad) continue;
        Try(doubt, {[axes, down_rad = doubt.down_rad](const Pose3& pose) {
                      return LookingDown(axes(pose), down_rad);
                    },
                    camera_});
      }
    };
    look(0.0, kCoarsePitchRad, kMostPitchRad);
    if (best_.reading == reading) look(best_.down_rad, kFinePitchRad, kCoarsePitchRad);
  }

  const PoseFits& fits_;
  const PinholeCamera& camera_;
  std::size_t least_;
  bool y_up_;
  PoseDoubt as_given_;
  PoseDoubt best_;
  PoseAttempt attempt_;  // of the best
};

bool AllAlike(const std::vector<SlamPose>& live, double (*apart)(const Pose3&, const Pose3&)) {
  constexpr double kApart = 1e-6;  // metres and radians, for rounding
  std::optional<Pose3> first;
  for (const SlamPose& pose : live) {
    if (!pose.slam_from_camera) continue;
    if (!first) first = pose.slam_from_camera;
    if (apart(*first, *pose.slam_from_camera) > kApart) return false;
  }
  return true;
}

// The offset that the coarse search found prefers stamps between two poses, whose mean is less
// noisy; this is found without that, and says how sure it is.
PoseDoubt Refined(PoseDoubt doubt, const PoseFits& fits, const PinholeCamera& camera,
                  const std::vector<SlamPose>& live, const RecordingOptions& options) {
  const double coarse_s = doubt.time_offset_s - options.time_offset_s;
  const auto fine = FineShiftAround(fits, camera, live, coarse_s);
  if (!fine) return doubt;
  doubt.time_offset_s = options.time_offset_s + fine->shift_s;
  doubt.time_unsure_s = std::max(fine->sigma_s, doubt.time_unsure_s);
  return doubt;
}

// The result for poses that fit the images in no reading.
PoseDoubt Unread(PoseDoubt doubt, const std::vector<SlamPose>& live,
                 const std::vector<ImagePair>& pairs) {
  const bool standing = AllAlike(
      live, [](const Pose3& a, const Pose3& b) { return (a.translation - b.translation).norm(); });
  const bool unturned = AllAlike(
      live, [](const Pose3& a, const Pose3& b) { return a.rotation.angularDistance(b.rotation); });
  doubt.reading = standing   ? PoseReading::kStanding
                  : unturned ? PoseReading::kUnturned
                             : PoseReading::kNone;
  if (doubt.reading != PoseReading::kNone) return doubt;
  const KeptDepth kept = KeptDepthIn(pairs);
  if (kept.share > kMostKept) doubt.kept = kept;
  return doubt;
}

}  // namespace

std::optional<PoseDoubt> DoubtOfPoses(const std::vector<ImagePair>& pairs,
                                      const PinholeCamera& camera,
                                      const std::vector<SlamPose>& live,
                                      const RecordingOptions& options, bool y_up) {
  const PoseFits fits(pairs, live, options);
  const std::size_t usable = fits.PairsWithPoses();
  if (usable < PoseFits::kLeastPairs) return {};
  const auto least = static_cast<std::size_t>(kLeastPairShare * static_cast<double>(usable));
  const auto as_given = fits.Mean({AsGiven, camera}, least);
  if (!as_given) return {};
  BestReading best(fits, camera, least, *as_given, options.time_offset_s, y_up);
  best.TryWritten();
  best.TryShifts();
  // With a wrong scale, time offsets to slower motion fit better too, but the right scale fits
  // best.
  best.TryScales();
  best.TryCameras();
  best.TryCentres();
  best.TryPitches();
  best.TryOtherAxes();
  best.TryRayLengths();
  const PoseDoubt& doubt = best.doubt();
  const auto slight = [&] { return SlightDoubtOf(fits, camera, live, options); };
  // Where most of the images is floor close below a camera, it is that which misfits where SLAM
  // errs in height, and which fits poses that hardly move. So what shows motion must agree.
  const double changed_as_given = fits.WhereShared({AsGiven, camera}, PairPoints::kChanged);
  if (doubt.better_misfit < std::min(kMostFitting, kClearlyBetter * *as_given)) {
    const double changed = fits.WhereShared(best.attempt(), PairPoints::kChanged);
    if (changed < kClearlyBetter * changed_as_given) {
      return doubt.reading == PoseReading::kShifted ? Refined(doubt, fits, camera, live, options)
                                                    : doubt;
    }
    return slight();
  }
  const double as_given_shared = fits.WhereShared({AsGiven, camera}, PairPoints::kAll);
  if (std::min(as_given_shared, changed_as_given) < kLeastUnfitting) return slight();
  const double unfitting =
      fits.ShareAbove(kLeastUnfitting, {AsGiven, camera}, PairPoints::kChanged);
  if (unfitting < kLeastUnfittingPairs) return slight();
  return Unread(doubt, live, pairs);
}

}  // namespace depthgrid
