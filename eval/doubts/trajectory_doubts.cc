#include "eval/doubts/trajectory_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "eval/doubts/clock_check.h"
#include "eval/doubts/lever_check.h"
#include "eval/doubts/rotation_check.h"
#include "eval/metrics/alignment.h"
#include "eval/metrics/trajectory_metrics.h"
#include "mapper/core/angle.h"
#include "mapper/core/level.h"

namespace depthgrid {
namespace {

using Doubt = std::optional<std::string>;

constexpr double kLeastPathM = 1.0;  // with less, noise would decide

bool StandsStill(const std::vector<PosePair>& pairs) {
  constexpr double kLeastMotionM = 1e-4;
  const Eigen::Vector3d first = pairs.front().estimate.world_from_camera.translation;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d moved = pair.estimate.world_from_camera.translation - first;
    if (moved.norm() > kLeastMotionM) return false;
  }
  return true;
}

Doubt DoubtOfScale(const std::vector<PosePair>& pairs, const TrajectoryNames& names) {
  constexpr double kOtherScale = 1.5;  // no SLAM that knows its scale is off by half
  const auto fit = Align(pairs, Alignment::kSim3);
  if (!fit || (fit->scale <= kOtherScale && fit->scale * kOtherScale >= 1.0)) return {};
  return fmt::format(
      "{}: fits {} best if made {:.4g} times as large: is it in other units, or without scale?",
      names.estimate, names.reference, fit->scale);
}

// Tries the poses in reverse order at the same stamps. Positions alone do not show it: a reversed
// figure eight is its mirror image, which fits upside down.
Doubt DoubtOfDirection(const std::vector<PosePair>& pairs, const TrajectoryNames& names) {
  std::vector<PosePair> backwards = pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    backwards[i].estimate.world_from_camera =
        pairs[pairs.size() - 1 - i].estimate.world_from_camera;
  }
  if (PosesFit(pairs) || !PosesFit(backwards)) return {};
  return fmt::format("{}: runs backwards in time against {}: in reverse order its poses fit",
                     names.estimate, names.reference);
}

// A robot base's axes are x forward, y left, z up; a camera's x right, y down, z forward.
Eigen::Quaterniond BaseFromCamera() { return CameraOf(Pose2{}, 0.0).rotation; }

// Mount settings with which the program corrects this rotation; a camera need not look level or
// ahead.
std::string MountText(const Eigen::Quaterniond& base_from_camera) {
  constexpr double kLeastDeg = 1.0;
  const Eigen::Vector3d forward = base_from_camera * Eigen::Vector3d::UnitZ().eval();
  const double yaw_deg = DegFromRad(std::atan2(forward.y(), forward.x()));
  const double pitch_deg = DegFromRad(std::asin(std::clamp(-forward.z(), -1.0, 1.0)));
  std::string text = "docs/examples/base_poses.awk";
  if (std::abs(yaw_deg) >= kLeastDeg) text += fmt::format(" -v yaw={:.0f}", yaw_deg);
  if (std::abs(pitch_deg) >= kLeastDeg) text += fmt::format(" -v pitch={:.0f}", pitch_deg);
  return text;
}

std::string ConstantText(const Eigen::Quaterniond& estimate_from_reference,
                         const TrajectoryNames& names) {
  constexpr double kMountRad = RadFromDeg(40.0);  // more than cameras are tilted
  const Eigen::Quaterniond reference_from_estimate = estimate_from_reference.conjugate();
  if (AngleOf(estimate_from_reference * BaseFromCamera().conjugate()) < kMountRad) {
    return fmt::format(
        "as if they were a robot base's poses (x forward), not a camera's (z forward) as {}'s; {} "
        "makes camera poses of them",
        names.reference, MountText(estimate_from_reference));
  }
  if (AngleOf(reference_from_estimate * BaseFromCamera().conjugate()) < kMountRad) {
    return fmt::format(
        "as if {}'s were a robot base's poses (x forward), not a camera's (z forward) as these; {} "
        "makes camera poses of those",
        names.reference, MountText(reference_from_estimate));
  }
  const Eigen::AngleAxisd turn(reference_from_estimate);
  return fmt::format("turned by {:.0f} degrees about ({:.2f} {:.2f} {:.2f}) of their own axes",
                     DegFromRad(turn.angle()), turn.axis().x(), turn.axis().y(), turn.axis().z());
}

Doubt DoubtOfRotations(const std::vector<PosePair>& pairs, const TrajectoryNames& names) {
  // Positions of another point of the robot would give a wrong rotation when aligned.
  const auto lever = FindLeverArm(pairs);
  const auto doubt = CheckRotations(lever ? MovedBy(pairs, lever->arm_m) : pairs);
  if (!doubt) return {};
  std::string text =
      fmt::format("{}: its positions fit {} but its rotations are off by {:.0f} degrees",
                  names.estimate, names.reference, DegFromRad(doubt->error_rad));
  if (doubt->w_first) {
    text += ", and would fit with quaternions that begin with w; rows must be t x y z qx qy qz qw";
  }
  if (doubt->estimate_from_reference) {
    text += fmt::format("{}, {}", doubt->w_first ? "; then" : " throughout",
                        ConstantText(*doubt->estimate_from_reference, names));
  }
  return text + ": errors of rotation, of motion and with first poses aligned say little";
}

std::string LeverText(const LeverArm& lever, const TrajectoryNames& names) {
  // Suppresses rounding errors.
  const auto shown = [](double arm_m) { return std::abs(arm_m) < 5e-4 ? 0.0 : arm_m; };
  return fmt::format(
      "{}: its poses seem to be of another point of the robot than {}'s, as a laser's or a "
      "camera's are beside its base's: moved by ({:.3f} {:.3f} {:.3f}) m along their own axes they "
      "fit to {:.3f} m, not to {:.3f} m (aligned)",
      names.estimate, names.reference, shown(lever.arm_m.x()), shown(lever.arm_m.y()),
      shown(lever.arm_m.z()), lever.better_misfit_m, lever.misfit_m);
}

}  // namespace

std::string SpansApart(const Trajectory& reference, const Trajectory& estimate,
                       const std::string& reference_name, double limit_s) {
  const auto span = [](const Trajectory& t) {
    return fmt::format("from {:.3f} to {:.3f} s", t.front().stamp_s, t.back().stamp_s);
  };
  return fmt::format("shares no stamp with {} (within {} s): it is {}, that one {}", reference_name,
                     limit_s, span(estimate), span(reference));
}

std::vector<std::string> DoubtsOfPairs(const std::vector<PosePair>& pairs,
                                       const TrajectoryNames& names) {
  if (pairs.empty() || ReferencePath(pairs).back() <= kLeastPathM) return {};
  if (StandsStill(pairs)) {
    return {fmt::format("{}: does not move, all its positions are the same, where {} moves",
                        names.estimate, names.reference)};
  }
  std::vector<std::string> doubts;
  for (const auto check : {DoubtOfScale, DoubtOfDirection, DoubtOfRotations}) {
    if (const Doubt doubt = check(pairs, names)) doubts.push_back(*doubt);
  }
  return doubts;
}

std::vector<std::string> DoubtsOfTime(const TrajectoryScore& score, const TrajectoryNames& names) {
  constexpr double kPercent = 100.0;
  constexpr double kMostMissing = 0.2;
  if (score.time_coverage >= 1.0 - kMostMissing) return {};
  return {fmt::format("{}: covers {:.0f} % of {}'s time; the errors are of that alone",
                      names.estimate, kPercent * score.time_coverage, names.reference)};
}

std::optional<std::string> DoubtOfPlane(const TrajectoryScore& score,
                                        const std::vector<PosePair>& pairs,
                                        const TrajectoryNames& names) {
  // In level worlds planar errors are part of those in space, so not larger by this factor.
  constexpr double kTilted = 2.0;
  constexpr double kLeastErrorM = 0.01;  // alignment may remove any share of smaller ones
  if (!score.xy_se2 || !score.xyz_se3 || score.reference_path_m <= kLeastPathM ||
      score.xy_se2->rmse <= std::max(kLeastErrorM, kTilted * score.xyz_se3->rmse)) {
    return {};
  }
  return fmt::format(
      "{}: fits {} to {:.3f} m in space (SE(3) aligned) but to {:.3f} m in the plane (SE(2)): {}, "
      "so errors in xy say little",
      names.estimate, names.reference, score.xyz_se3->rmse, score.xy_se2->rmse,
      FitsUpsideDown(pairs) ? "it is upside down or mirrored (an axis negated, x and y swapped)"
                            : "their worlds are tilted against each other");
}

std::optional<std::string> OtherUnits(const std::vector<PosePair>& pairs,
                                      const TrajectoryNames& names) {
  constexpr double kNear = 1.2;  // SLAM's own error of scale is smaller
  struct Unit {
    const char* name;
    double per_metre;
  };
  if (pairs.empty() || ReferencePath(pairs).back() <= kLeastPathM || StandsStill(pairs)) return {};
  const auto fit = Align(pairs, Alignment::kSim3);
  if (!fit || !(fit->scale > 0.0)) return {};
  for (const Unit& unit : {Unit{"millimetres", 1000.0}, Unit{"centimetres", 100.0}}) {
    const auto is_near = [](double ratio) { return ratio < kNear && ratio * kNear > 1.0; };
    if (is_near(fit->scale * unit.per_metre)) {
      return fmt::format("{} where {} is in metres", unit.name, names.reference);
    }
    if (is_near(fit->scale / unit.per_metre)) {
      return fmt::format("metres where {} is in {}", names.reference, unit.name);
    }
  }
  return {};
}

std::vector<std::string> DoubtsOfClock(const Trajectory& reference, const Trajectory& estimate,
                                       const TrajectoryNames& names, double added_s) {
  const auto clock = FindClockOffset(reference, estimate);
  const std::vector<PosePair> pairs = Associate(reference, estimate);
  const auto lever = FindLeverArm(pairs);
  if (lever && (!clock || lever->better_misfit_m < clock->better_misfit_m)) {
    if (!TellsArmFromDrift(pairs)) return {};
    return {LeverText(*lever, names)};
  }
  if (!clock) return {};
  return {fmt::format(
      "{}: its stamps seem {:.3f} s {}{}: with {:+.3f} s added (--time-offset of eval trajectory) "
      "it fits {} to {:.3f} m, not to {:.3f} m (aligned)",
      names.estimate, std::abs(clock->offset_s), clock->offset_s < 0.0 ? "late" : "early",
      clock->unsure_s > 0.0 ? fmt::format(", to {:.2f} s or so", clock->unsure_s) : "",
      added_s + clock->offset_s, names.reference, clock->better_misfit_m, clock->misfit_m)};
}

}  // namespace depthgrid
