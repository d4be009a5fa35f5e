#include "mapper/scan/floor_tracker.h"

#include <cmath>
#include <utility>

#include "mapper/core/level.h"

namespace depthgrid {
namespace {

// A surface this near to the expected floor is the floor: SLAM's drift between two sights of it
// plus the tilt's error times the distance.
constexpr double kNearM = 0.12;
// Plausible heights of a pose if its z is above the floor; in recordings z often begins at 0.
constexpr double kLeastPoseHeightM = 0.1;
constexpr double kMostPoseHeightM = 3.0;
// A surface below the assumed floor is the real floor (the assumed one was a table) once a few
// frames in a row show it. A surface above it is mostly a table that hides the floor; only if it
// stays, SLAM has jumped. If the camera's height above it is kTableM less than above the floor when
// last seen, it is a table, unless it stays very long.
constexpr int kFramesToBelieveLower = 5;
constexpr int kFramesToBelieveHigher = 60;
constexpr int kFramesToBelieveTable = 600;
constexpr double kTableM = 0.3;
// SLAM's error from frame to frame (docs/slam_surrogate.md: 0.1-0.2 degrees, 2-5 mm) with a margin;
// kFirst: before the floor was seen, the tilt errors found in recordings.
constexpr double kStepSigmaM = 0.03;
constexpr double kStepSigmaRad = RadFromDeg(0.3);
constexpr double kFirstSigmaM = 0.1;
constexpr double kFirstSigmaRad = RadFromDeg(2.0);
// The previous frame's plane is a narrow prior, and a plane that lags behind SLAM's tilt only gets
// the points that agree with it. So every few frames the plane is also fitted with the wide prior,
// and taken if it has kMorePoints times as many points.
constexpr int kFramesToLookAnew = 4;
constexpr double kMorePoints = 1.1;

}  // namespace

CameraStand FloorTracker::StandOver(const Floor& floor, const Pose3& slam_from_camera) const {
  const Eigen::Quaterniond level_from_slam = RotationBetween(floor.up, Eigen::Vector3d::UnitZ());
  const Pose3 turned{(level_from_slam * slam_from_camera.rotation).normalized(),
                     slam_from_camera.translation};
  return {LevelFromCamera(turned), floor.up.dot(slam_from_camera.translation) + floor.offset_m};
}

bool FloorTracker::IsExpected(double height_m, double expected_m, double near_m) const {
  return std::abs(height_m - expected_m) <= near_m ||
         (floor_height_m_ && std::abs(height_m - *floor_height_m_) <= kNearM);
}

bool FloorTracker::AcceptOrCount(double height_m, double expected_m) {
  const bool pose_is_height = expected_m > kLeastPoseHeightM && expected_m < kMostPoseHeightM;
  if (!seen_ && !pose_is_height) return true;
  if (IsExpected(height_m, expected_m, seen_ ? kNearM : kNearPoseM)) {
    other_frames_ = 0;
    return true;
  }
  const double higher_m = height_m - expected_m;
  if (std::abs(higher_m - other_higher_m_) > kNearM) other_frames_ = 0;
  other_higher_m_ = higher_m;
  ++other_frames_;
  // A larger height means a lower floor.
  const bool table = floor_height_m_ && height_m < *floor_height_m_ - kTableM;
  const int higher = table ? kFramesToBelieveTable : kFramesToBelieveHigher;
  if (other_frames_ < (higher_m > 0.0 ? kFramesToBelieveLower : higher)) return false;
  other_frames_ = 0;
  return true;
}

CameraStand FloorTracker::Follow(const DepthImage& image, const Pose3& slam_from_camera,
                                 int epoch) {
  if (source_ == FloorSource::kPose) return StandOf(slam_from_camera, floor_z_m_);
  if (epoch_ != epoch) {
    epoch_ = epoch;
    floor_.up = Eigen::Vector3d::UnitZ();
    floor_.offset_m = height_m_ ? *height_m_ - slam_from_camera.translation.z() : -floor_z_m_;
    seen_ = false;
    other_frames_ = 0;
  }
  LookAt(image, slam_from_camera);
  const CameraStand stand = StandOver(floor_, slam_from_camera);
  if (seen_ || height_m_) height_m_ = stand.height_m;
  return stand;
}

std::optional<FloorPlane> FloorTracker::TiltedFloor(const FloorPrior& prior, double expected_m) {
  if (!seen_ || std::abs(prior.height_m - expected_m) > kNearPoseM) return {};
  const std::optional<FloorPlane> plane = FitFloor(memory_, prior);
  if (!plane || !IsExpected(plane->height_m, expected_m, kNearM)) return {};
  other_frames_ = 0;
  return plane;
}

void FloorTracker::LookAt(const DepthImage& image, const Pose3& slam_from_camera) {
  const CameraStand expected = StandOver(floor_, slam_from_camera);
  memory_ = LevelPointsOf(image, camera_, expected.level_from_camera, std::move(memory_));
  const std::optional<double> height_m = LowestSurface(memory_);
  if (!height_m) return;
  const FloorPrior wide{*height_m, kFirstSigmaM, kFirstSigmaRad};
  std::optional<FloorPlane> plane;
  if (!AcceptOrCount(*height_m, expected.height_m)) {
    plane = TiltedFloor(wide, expected.height_m);
  } else if (!seen_ || std::abs(*height_m - expected.height_m) > kNearM) {
    plane = FitFloor(memory_, wide);
  } else {
    plane = FitFloor(memory_, {expected.height_m, kStepSigmaM, kStepSigmaRad});
    if (++looks_ % kFramesToLookAnew == 0) {
      const auto anew = FitFloor(memory_, wide);
      if (anew && (!plane || anew->points > kMorePoints * plane->points)) plane = anew;
    }
  }
  if (!plane) return;
  const Eigen::Quaterniond slam_from_level =
      slam_from_camera.rotation * expected.level_from_camera.conjugate();
  floor_.up = (slam_from_level * plane->up).normalized();
  floor_.offset_m = plane->height_m - floor_.up.dot(slam_from_camera.translation);
  floor_height_m_ = plane->height_m;
  seen_ = true;
}

}  // namespace depthgrid
