#include "mapper/frame_check.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/match/find_place.h"

namespace depthgrid {
namespace {

// Deviation of a unit quaternion's norm after rounding to floats or to four digits.
constexpr double kNormSlack = 1e-3;

std::string NameOf(const Frame& frame) { return "frame " + std::to_string(frame.index); }

[[noreturn]] void Refuse(const Frame& frame, const std::string& why) {
  throw InputError(NameOf(frame), why);
}

void RequirePose(const std::string& place, const Pose3& pose, const std::string& name) {
  const double norm = pose.rotation.norm();
  if (!(std::abs(norm - 1.0) <= kNormSlack)) {
    throw InputError(place,
                     name + "'s quaternion has the norm " + std::to_string(norm) + ", must be 1");
  }
  if (!IsWithinReach(pose.translation)) {
    const Eigen::Vector3d& at = pose.translation;
    throw InputError(place, name + " lies at (" + std::to_string(at.x()) + ", " +
                                std::to_string(at.y()) + ", " + std::to_string(at.z()) +
                                "), must lie within 10,000 km");
  }
}

void RequirePlanar(const std::string& place, const Pose2& pose, const std::string& name) {
  if (std::isfinite(pose.yaw_rad) && IsWithinReach({pose.x_m, pose.y_m, 0.0})) return;
  throw InputError(place, name + " is (" + std::to_string(pose.x_m) + ", " +
                              std::to_string(pose.y_m) + ", " + std::to_string(pose.yaw_rad) +
                              "), must be finite and within 10,000 km");
}

void RequireReach(const std::string& place, const Scan& scan) {
  if (scan.max_range_m >= 0.0 && std::isfinite(scan.max_range_m)) return;
  throw InputError(place, "its scan's max_range_m is " + std::to_string(scan.max_range_m) +
                              ", must be 0 (unknown) or more");
}

void RequireKept(const std::string& place, const Scan& scan) {
  RequireReach(place, scan);
  for (const Beam& beam : scan.beams) {
    if (CanBeKept(beam)) continue;
    throw InputError(place, "its scan has a beam at bearing " + std::to_string(beam.bearing_rad) +
                                " with range " + std::to_string(beam.range_m) + ", clear from " +
                                std::to_string(beam.clear_from_m) + " to " +
                                std::to_string(beam.clear_to_m) +
                                ", must be finite and from 1 mm to 1 km");
  }
}

void RequirePriorFrame(const std::string& place, const MappedFrame& frame) {
  if (!frame.of_prior_map()) {
    throw InputError(place, "is frame " + std::to_string(frame.frame) + ", must be below 0");
  }
  if (!frame.kept() || !frame.scan || !frame.obstacles) {
    throw InputError(place, "has no scans of its own, must have both");
  }
  if (!std::isfinite(frame.stamp_s)) {
    throw InputError(place, "its stamp is " + std::to_string(frame.stamp_s) + ", must be seconds");
  }
  RequirePlanar(place, frame.map_from_base, "its pose");
  for (const auto& scan : {frame.scan, frame.obstacles}) RequireKept(place, *scan);
}

// Depths in millimetres would map everything as free. No depth camera measures to 100 m; a constant
// value is a renderer's far plane.
void RequireMetres(const Frame& frame, const DepthImage& depth) {
  constexpr float kBeyondAnyM = 100.0F;
  // Not a divisor of the width, which would sample the same columns again and again.
  constexpr std::size_t kPrime = 251;
  const std::size_t stride = kPrime + (depth.width_px % static_cast<int>(kPrime) == 0 ? 1 : 0);
  float least = INFINITY, most = 0.0F;
  for (std::size_t i = 0; i < depth.z_m.size(); i += stride) {
    const float z_m = depth.z_m[i];
    if (!(z_m > 0.0F) || !std::isfinite(z_m)) continue;
    if (z_m < kBeyondAnyM) return;
    least = std::min(least, z_m);
    most = std::max(most, z_m);
  }
  if (!(least < most)) return;
  Refuse(frame, "its depths are " + std::to_string(least) + " to " + std::to_string(most) +
                    ", must be metres: are these millimetres?");
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
  RequireMetres(frame, depth);
}

// Detects a base pose given as camera pose: its rotation is about z only, so the camera would look
// up. Scans made from images are exempt; they come with a stand.
void RequireHeading(const Frame& frame) {
  if (!frame.scan || frame.stand || !frame.slam_from_camera) return;
  if (!LooksUpOrDown(*frame.slam_from_camera)) return;
  Refuse(frame,
         "has a scan, but its camera looks straight up or down, so that it has no heading: the "
         "pose of a laser must be CameraOf() of its planar pose (mapper/core/level.h)");
}

void RequireLoop(const Frame& frame, const LoopClosure& loop) {
  const std::string name = "the loop closure of frames " + std::to_string(loop.first_frame) +
                           " and " + std::to_string(loop.second_frame);
  RequirePose(NameOf(frame), loop.first_from_second, name);
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
  if (frame.slam_from_camera) RequirePose(NameOf(frame), *frame.slam_from_camera, "its pose");
  if (frame.depth) RequireDepth(frame, camera);
  RequireHeading(frame);
  if (frame.matched_scan && !frame.scan) Refuse(frame, "has a matched_scan, but no scan");
  if (frame.stand && !frame.scan) Refuse(frame, "has a stand, but no scan that it belongs to");
  if (frame.stand) {
    const Pose3 stand{frame.stand->level_from_camera, {0.0, 0.0, frame.stand->height_m}};
    RequirePose(NameOf(frame), stand, "its stand");
  }
  for (const auto& scan : {frame.scan, frame.matched_scan}) {
    if (scan) RequireReach(NameOf(frame), *scan);
  }
  for (const LoopClosure& loop : frame.loops) RequireLoop(frame, loop);
}

void RequireSoundFinal(const std::vector<std::optional<Pose3>>& slam_final, std::size_t frames) {
  if (!slam_final.empty() && slam_final.size() != frames) {
    throw InputError("slam_final", "has " + std::to_string(slam_final.size()) +
                                       " poses, must have one for each of the " +
                                       std::to_string(frames) + " frames, or none");
  }
  for (std::size_t i = 0; i < slam_final.size(); ++i) {
    if (slam_final[i]) RequirePose("slam_final", *slam_final[i], "entry " + std::to_string(i));
  }
}

void RequireSound(const PriorMap& prior) {
  const std::string place = "prior map";
  if (prior.fixed && prior.frames.empty()) throw InputError(place, "is empty, must have frames");
  for (std::size_t i = 0; i < prior.frames.size(); ++i) {
    const MappedFrame& frame = prior.frames[i];
    const std::string entry = place + ", entry " + std::to_string(i);
    RequirePriorFrame(entry, frame);
    if (i > 0 && prior.frames[i - 1].frame >= frame.frame) {
      throw InputError(entry, "is frame " + std::to_string(frame.frame) +
                                  ", must come after the one before it, " +
                                  std::to_string(prior.frames[i - 1].frame));
    }
  }
  RequirePlanar(place, prior.map_from_slam, "its map_from_slam");
}

void RequireSoundStart(const Pose2& map_from_base, double within_m) {
  const std::string place = "start in the map";
  RequirePlanar(place, map_from_base, "map_from_base");
  if (within_m >= 0.0 && within_m <= kMostWithinM) return;
  throw InputError(place, "within_m is " + std::to_string(within_m) + ", must be from 0 to " +
                              std::to_string(kMostWithinM));
}

}  // namespace depthgrid
