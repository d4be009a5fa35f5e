#include "mapper/frame_check.h"

#include <cmath>
#include <string>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// What rounding to floats, or to four digits, leaves of a unit quaternion's norm.
constexpr double kNormSlack = 1e-3;

[[noreturn]] void Refuse(const Frame& frame, const std::string& why) {
  throw InputError("frame " + std::to_string(frame.index), why);
}

void RequirePose(const Frame& frame, const Pose3& pose, const std::string& name) {
  const double norm = pose.rotation.norm();
  if (!(std::abs(norm - 1.0) <= kNormSlack)) {
    Refuse(frame, name + "'s quaternion has the norm " + std::to_string(norm) + ", must be 1");
  }
  if (!IsWithinReach(pose.translation)) {
    const Eigen::Vector3d& at = pose.translation;
    Refuse(frame, name + " lies at (" + std::to_string(at.x()) + ", " + std::to_string(at.y()) +
                      ", " + std::to_string(at.z()) + "), must lie within 10,000 km");
  }
}

void RequireDepth(const Frame& frame, const std::optional<PinholeCamera>& camera) {
  const auto size_of = [](int width_px, int height_px) {
    return std::to_string(width_px) + " x " + std::to_string(height_px) + " pixels";
  };
  const DepthImage& depth = *frame.depth;
  if (!camera) Refuse(frame, "has a depth image, but the mapper was made without a camera");
  if (frame.scan) Refuse(frame, "has a depth image and a scan, must have one of them");
  if (depth.width_px != camera->width_px || depth.height_px != camera->height_px) {
    Refuse(frame, "its depth image has " + size_of(depth.width_px, depth.height_px) +
                      ", must have the camera's " + size_of(camera->width_px, camera->height_px));
  }
  const auto wanted =
      static_cast<std::size_t>(depth.width_px) * static_cast<std::size_t>(depth.height_px);
  if (depth.z_m.size() != wanted) {
    Refuse(frame, "its depth image holds " + std::to_string(depth.z_m.size()) +
                      " values, must hold " + std::to_string(wanted));
  }
}

void RequireReach(const Frame& frame, const Scan& scan) {
  if (scan.max_range_m >= 0.0 && std::isfinite(scan.max_range_m)) return;
  Refuse(frame, "its scan's max_range_m is " + std::to_string(scan.max_range_m) +
                    ", must be 0 (unknown) or more");
}

void RequireLoop(const Frame& frame, const LoopClosure& loop) {
  const std::string name = "the loop closure of frames " + std::to_string(loop.first_frame) +
                           " and " + std::to_string(loop.second_frame);
  RequirePose(frame, loop.first_from_second, name);
  for (const double sigma : {loop.sigma_translation_m, loop.sigma_rotation_rad}) {
    if (std::isfinite(sigma) && sigma > 0.0) continue;
    Refuse(frame, name + " has a sigma of " + std::to_string(sigma) + ", must be positive");
  }
}

}  // namespace

void RequireSound(const Frame& frame, const std::optional<PinholeCamera>& camera) {
  if (frame.index < 0) Refuse(frame, "must have a number from 0 on");
  if (!std::isfinite(frame.stamp_s)) {
    Refuse(frame, "its stamp is " + std::to_string(frame.stamp_s) + ", must be seconds");
  }
  if (frame.slam_from_camera) RequirePose(frame, *frame.slam_from_camera, "its pose");
  if (frame.depth) RequireDepth(frame, camera);
  if (frame.matched_scan && !frame.scan) Refuse(frame, "has a matched_scan, but no scan");
  for (const auto& scan : {frame.scan, frame.matched_scan}) {
    if (scan) RequireReach(frame, *scan);
  }
  for (const LoopClosure& loop : frame.loops) RequireLoop(frame, loop);
}

}  // namespace depthgrid
