#include "mapper/scan/floor_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mapper/core/level.h"

namespace depthgrid {
namespace {

// A surface this near to the expected floor is the floor: SLAM's drift between two sights of it
// plus the tilt's error times the distance.
constexpr double kNearM = 0.12;
// Plausible heights of a pose if its z is above the floor; in recordings z often begins at 0.
constexpr double kLeastPoseHeightM = 0.1;
// A camera lower than this may be one of a vacuum cleaner, as may one whose height is unknown. Of
// others nothing that is so close below them is looked at: it is no floor.
constexpr double kLowM = 0.2;
constexpr double kMostPoseHeightM = 3.0;
// Of level surfaces, noise and skirting boards below a floor have less than this share of the
// largest one's points.
constexpr double kMinPeakShare = 0.25;
// A surface below the assumed floor is the real floor (the assumed one was a table) once a few
// frames in a row show it, unless the camera is known to stand on the assumed one. A surface above
// it is mostly a table that hides the floor; only if it stays, SLAM has jumped.
constexpr int kFramesToBelieveLower = 5;
constexpr int kFramesToBelieveHigher = 60;
// If the camera stands on the assumed floor, or its height above the surface is kTableM less than
// above the floor when last seen, the surface is believed only if it stays very long.
constexpr int kFramesToBelieveAnything = 600;
constexpr double kTableM = 0.3;
// The camera stands on what it has passed over for this many cells, a robot's length; of two
// surfaces on that which has this many more: a table has fewer along its edge. Both are choices.
constexpr std::size_t kCellsOfStand = 3;
constexpr std::size_t kMoreCellsOfStand = 8;
// One in so many points of the floor is noted as trodden.
constexpr std::size_t kPointsPerNote = 4;
constexpr double kOnPlaneM = 0.03;
// What was taken for the floor before is forgotten after this many frames.
constexpr int kFramesToForget = 1800;
// If only SLAM's tilt made a surface look higher or lower, the camera's height above its plane is
// the expected one.
constexpr double kTiltedM = 0.06;
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
// Where a ramp meets the floor, what fits both draws a narrow prior along. So a plane tilted as it
// usually is, in the last 10 s, is taken if it has this share of the points: a floor beside a ramp
// had .43 (docs/tried.md, "Heights and tilts").
constexpr double kUsualShare = 0.6;
constexpr double kStandShare = 0.4;  // if the camera stands on it
// It may be off by this much, and by what SLAM drifts meanwhile.
constexpr double kSameRad = RadFromDeg(0.3);
constexpr double kUsualSigmaRad = RadFromDeg(0.1);
constexpr double kFramesOfUsual = 300.0;

FloorPrior WideAt(double height_m) { return {height_m, kFirstSigmaM, kFirstSigmaRad}; }

// The lowest of the larger surfaces. A table top that hides the floor is mistaken for it.
const LevelSurface& Lowest(const std::vector<LevelSurface>& surfaces) {
  int most = 0;
  for (const LevelSurface& surface : surfaces) most = std::max(most, surface.points);
  return *std::find_if(surfaces.begin(), surfaces.end(), [&](const LevelSurface& surface) {
    return surface.points >= kMinPeakShare * most;
  });
}

// The one nearest to a height, if any is this near.
const LevelSurface* Nearest(const std::vector<LevelSurface>& surfaces, double height_m,
                            double near_m) {
  const LevelSurface* nearest = nullptr;
  for (const LevelSurface& surface : surfaces) {
    const double off_m = std::abs(surface.height_m - height_m);
    if (off_m > near_m) continue;
    near_m = off_m;
    nearest = &surface;
  }
  return nearest;
}

}  // namespace

CameraStand FloorTracker::StandOver(const Plane& plane, const Pose3& slam_from_camera) const {
  const Eigen::Quaterniond level_from_slam = RotationBetween(plane.up, Eigen::Vector3d::UnitZ());
  const Pose3 turned{(level_from_slam * slam_from_camera.rotation).normalized(),
                     slam_from_camera.translation};
  return {LevelFromCamera(turned), plane.up.dot(slam_from_camera.translation) + plane.offset_m};
}

bool FloorTracker::Stands() const { return floor_.trodden.Count() >= kCellsOfStand; }

bool FloorTracker::IsAsLastSeen(double height_m, double expected_m) const {
  return floor_height_m_ && std::abs(height_m - *floor_height_m_) <= kNearM &&
         drift_.CanBe(std::abs(height_m - expected_m));
}

bool FloorTracker::IsAsHigh(double height_m, double expected_m) const {
  const double off_m = std::abs(height_m - expected_m);
  return off_m <= kTiltedM || drift_.CanBe(off_m);
}

bool FloorTracker::IsBelieved(double height_m, double expected_m, double posed_m) {
  const double other_m = expected_m + other_.plane.offset_m - floor_.plane.offset_m;
  if (other_frames_ == 0 || std::abs(height_m - other_m) > kNearM) {
    other_ = {{floor_.plane.up, floor_.plane.offset_m + height_m - expected_m}, {}};
    other_frames_ = 0;
  }
  ++other_frames_;
  int frames = kFramesToBelieveAnything;
  if (height_m > expected_m) {  // a larger height means a lower floor
    const bool posed =
        seen_ && posed_off_m_ <= kNearM && std::abs(height_m - posed_m) >= posed_off_m_;
    if (!Stands() && !posed) frames = kFramesToBelieveLower;
  } else {
    const bool table = floor_height_m_ && height_m < *floor_height_m_ - kTableM;
    if (!Stands() && !table) frames = kFramesToBelieveHigher;
  }
  return other_frames_ >= frames || other_.trodden.Count() >= kCellsOfStand;
}

void FloorTracker::BeginEpoch(const Pose3& slam_from_camera) {
  floor_ = {};
  floor_.plane.offset_m = height_m_ ? *height_m_ - slam_from_camera.translation.z() : -floor_z_m_;
  posed_offset_m_ = floor_.plane.offset_m;
  left_.reset();
  seen_ = false;
  other_frames_ = 0;
  drift_.Forget();
}

CameraStand FloorTracker::Follow(const DepthImage& image, const Pose3& slam_from_camera,
                                 int epoch) {
  if (source_ == FloorSource::kPose) return StandOf(slam_from_camera, floor_z_m_);
  if (epoch_ != epoch) BeginEpoch(slam_from_camera);
  epoch_ = epoch;
  LookAt(image, slam_from_camera);
  const CameraStand stand = StandOver(floor_.plane, slam_from_camera);
  if (seen_ || height_m_) height_m_ = stand.height_m;
  return stand;
}

std::optional<FloorPlane> FloorTracker::TiltedFloor(const LevelSurface& surface,
                                                    double expected_m) const {
  if (!seen_ || std::abs(surface.height_m - expected_m) > kNearPoseM) return {};
  const std::optional<FloorPlane> plane = FindFloorPlane(memory_, WideAt(surface.height_m));
  if (!plane || !drift_.CanTilt(std::acos(plane->up.z()))) return {};
  const bool is_expected = std::abs(plane->height_m - expected_m) <= kTiltedM ||
                           IsAsLastSeen(plane->height_m, expected_m);
  return is_expected ? plane : std::nullopt;
}

std::optional<FloorPlane> FloorTracker::Followed(const LevelSurface& surface, double expected_m,
                                                 const Eigen::Vector3d& usual_up) {
  const FloorPrior wide = WideAt(surface.height_m);
  if (!seen_ || std::abs(surface.height_m - expected_m) > kNearM) {
    return FindFloorPlane(memory_, wide);
  }
  std::optional<FloorPlane> plane = FitFloor(memory_, {expected_m, kStepSigmaM, kStepSigmaRad});
  if (++looks_ % kFramesToLookAnew != 0) return plane;
  const auto has = [&](double share, const std::optional<FloorPlane>& one,
                       const FloorPlane& other) {
    return one && one->points >= share * other.points;
  };
  // Where nearly all points lie on it none can be better.
  const bool has_all =
      plane && kMorePoints * plane->points >= static_cast<double>(memory_.points.size());
  auto anew = has_all ? std::nullopt : FindFloorPlane(memory_, wide);
  if (!drift_.IsSlow()) return anew && !has(1.0 / kMorePoints, plane, *anew) ? anew : plane;
  // A plane from the floor to a table has more points than either, but not the camera's height.
  if (anew && !IsAsHigh(anew->height_m, expected_m)) anew.reset();
  const double share = Stands() ? kStandShare : kUsualShare;
  const auto usual = FitFloor(memory_, {expected_m, kStepSigmaM, kUsualSigmaRad, usual_up});
  // Drawn away, as where a ramp begins?
  const bool is_usual =
      usual && plane &&
      usual->up.dot(plane->up) > std::cos(kSameRad + drift_.TiltIn(kFramesOfUsual));
  if (usual && !is_usual && (!plane || has(share, usual, *plane))) plane = usual;
  return anew && !has(share, plane, *anew) ? anew : plane;
}

void FloorTracker::Leave() {
  left_ = floor_;
  left_since_ = left_frames_ = 0;
}

bool FloorTracker::GoBack(const LevelSurface* own, const Pose3& slam_from_camera,
                          double expected_m) {
  if (!left_ || ++left_since_ > kFramesToForget) return false;
  const double left_m = StandOver(left_->plane, slam_from_camera).height_m;
  const LevelSurface* there = Nearest(surfaces_, left_m, kNearM);
  const std::size_t own_cells = floor_.trodden.Count(), left_cells = left_->trodden.Count();
  // What is higher was a table, unless the camera stood on it.
  const std::size_t more_cells = own ? kMoreCellsOfStand : kCellsOfStand;
  const bool more_likely = left_m < expected_m ? left_cells >= own_cells + more_cells
                                               : own_cells < left_cells + kMoreCellsOfStand;
  left_frames_ = there && there != own && more_likely ? left_frames_ + 1 : 0;
  if (left_frames_ < kFramesToBelieveLower) return false;
  std::swap(floor_, *left_);
  left_since_ = left_frames_ = other_frames_ = 0;
  return true;
}

std::optional<FloorPlane> FloorTracker::FindFloor(const Pose3& slam_from_camera,
                                                  const CameraStand& expected) {
  double expected_m = expected.height_m;
  const Eigen::Quaterniond level_from_slam =
      expected.level_from_camera * slam_from_camera.rotation.conjugate();
  surfaces_ = LevelSurfaces(memory_, std::move(surfaces_));
  if (surfaces_.empty()) return {};
  const LevelSurface& lowest = Lowest(surfaces_);
  const bool pose_is_height = expected_m > kLeastPoseHeightM && expected_m < kMostPoseHeightM;
  if (!seen_ && !pose_is_height) {
    posed_off_m_ = std::numeric_limits<double>::infinity();
    return FindFloorPlane(memory_, WideAt(lowest.height_m));
  }
  const double posed_m = slam_from_camera.translation.z() + posed_offset_m_;
  const LevelSurface* own = Nearest(surfaces_, expected_m, seen_ ? kNearM : kNearPoseM);
  if (GoBack(own, slam_from_camera, expected_m)) {
    expected_m = StandOver(floor_.plane, slam_from_camera).height_m;
    own = Nearest(surfaces_, expected_m, kNearM);
    return own ? FindFloorPlane(memory_, WideAt(own->height_m)) : std::nullopt;
  }
  if (!own && IsAsLastSeen(lowest.height_m, expected_m)) {
    Leave();
    own = &lowest;
  }
  const bool other_is_own = own && lowest.height_m < own->height_m + kNearM;
  if (other_is_own) {
    other_frames_ = 0;
  } else if (IsBelieved(lowest.height_m, expected_m, posed_m)) {
    if (seen_) Leave();
    floor_.trodden = other_.trodden;
    other_frames_ = 0;
    posed_off_m_ = std::abs(lowest.height_m - posed_m);
    return FindFloorPlane(memory_, WideAt(lowest.height_m));
  }
  if (!own) {
    const std::optional<FloorPlane> tilted = TiltedFloor(lowest, expected_m);
    if (tilted) other_frames_ = 0;
    return tilted;
  }
  if (!seen_) posed_off_m_ = std::abs(own->height_m - posed_m);
  return Followed(*own, expected_m, level_from_slam * usual_up_);
}

void FloorTracker::LookAt(const DepthImage& image, const Pose3& slam_from_camera) {
  const CameraStand expected = StandOver(floor_.plane, slam_from_camera);
  drift_.Step(height_m_ ? expected.height_m - *height_m_ : 0.0);
  const Eigen::Vector2d here = slam_from_camera.translation.head<2>();
  floor_.trodden.Pass(here);
  if (left_) left_->trodden.Pass(here);
  if (!floor_.trodden.IsSeen(here)) other_.trodden.Pass(here);
  memory_ = LevelPointsOf(image, camera_, expected.level_from_camera, std::move(memory_),
                          expected.height_m < kLowM);
  const std::optional<FloorPlane> plane = FindFloor(slam_from_camera, expected);
  const Eigen::Quaterniond slam_from_level =
      slam_from_camera.rotation * expected.level_from_camera.conjugate();
  if (plane) {
    const Eigen::Vector3d up = (slam_from_level * plane->up).normalized();
    const double off_m = plane->height_m - expected.height_m;
    if (seen_ && std::abs(off_m) < kNearM) {
      drift_.Seen(off_m, up - floor_.plane.up);
    } else {
      drift_.Seen(0.0, Eigen::Vector3d::Zero());
    }
    if (!seen_) usual_up_ = up;
    floor_.plane = {up, plane->height_m - up.dot(slam_from_camera.translation)};
    usual_up_ = (usual_up_ + (up - usual_up_) / kFramesOfUsual).normalized();
    floor_height_m_ = plane->height_m;
    seen_ = true;
  }
  Note(slam_from_camera, slam_from_level);
}

void FloorTracker::Note(const Pose3& slam_from_camera, const Eigen::Quaterniond& slam_from_level) {
  const auto note = [&](Floor& floor) {
    for (std::size_t i = 0; i < memory_.points.size(); i += kPointsPerNote) {
      const Eigen::Vector3d place =
          slam_from_level * memory_.points[i].cast<double>() + slam_from_camera.translation;
      const double off_m = floor.plane.up.dot(place) + floor.plane.offset_m;
      if (std::abs(off_m) < kOnPlaneM) floor.trodden.See(place.head<2>());
    }
  };
  if (seen_) note(floor_);
  if (left_) note(*left_);
  if (other_frames_ > 0) note(other_);
}

}  // namespace depthgrid
