#include "mapper/io/slam_jumps.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mapper/core/angle.h"
#include "mapper/core/median.h"
#include "mapper/core/slam_step.h"
#include "mapper/core/trajectory.h"

namespace depthgrid {
namespace {

// Stamps of both trajectories are copies of the images'.
constexpr double kSameFrameS = 0.005;
// Steps on each side that define the usual motion.
constexpr int kStepsAround = 4;
// This few poses can really be far apart.
constexpr std::size_t kFewSpeeds = 3;
// Conditions for the two frames of a loop: least path between them, largest distance and angle in
// the final trajectory.
constexpr double kMinPathM = 2.0;
constexpr double kMaxDistanceM = 1.0;
constexpr double kMaxAngleRad = RadFromDeg(40.0);
// Weight of rotation in the choice of the nearest frame.
constexpr double kMetresPerRad = 1.0;
// Standard deviations of relative poses in a final trajectory (ORB-SLAM2 in a rendered room:
// 0.01-0.02 m).
constexpr double kSigmaTranslationM = 0.03;
constexpr double kSigmaRotationRad = 0.02;

std::vector<std::optional<Pose3>> FinalOf(const std::vector<SlamPose>& live,
                                          const Trajectory& final) {
  const std::vector<double> stamps_s = StampsOf(final);
  std::vector<std::optional<Pose3>> found;
  for (const SlamPose& pose : live) {
    const auto entry = NearestStamp(stamps_s, pose.stamp_s, kSameFrameS);
    found.push_back(entry ? std::optional(final[*entry].world_from_camera) : std::nullopt);
  }
  return found;
}

struct Step {
  int from = 0;  // indices in `live`
  int to = 0;
  SlamStep speeds;
};

// Nobody has so many images (a month of 30 a second): whole seconds since 1970.
constexpr double kMostImages = 1e8;

// Seconds per unit of the stamps: ICL-NUIM's are image numbers at 30 Hz.
double StampUnitS(const std::vector<SlamPose>& live) {
  const auto is_number = [](const SlamPose& pose) {
    return pose.stamp_s == std::floor(pose.stamp_s) && pose.stamp_s < kMostImages;
  };
  return std::all_of(live.begin(), live.end(), is_number) ? 1.0 / 30.0 : 1.0;
}

std::vector<Step> StepsOf(const std::vector<SlamPose>& live) {
  const double unit_s = StampUnitS(live);
  std::vector<Step> steps;
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < live.size(); ++i) {
    if (!live[i].slam_from_camera) continue;
    if (before && live[i].stamp_s > live[*before].stamp_s) {
      const double duration_s = (live[i].stamp_s - live[*before].stamp_s) * unit_s;
      steps.push_back(
          {static_cast<int>(*before), static_cast<int>(i),
           StepOf(*live[*before].slam_from_camera, *live[i].slam_from_camera, duration_s)});
    }
    before = i;
  }
  return steps;
}

bool IsNoMotion(const std::vector<Step>& steps, std::size_t at) {
  const std::size_t reach = kStepsAround;
  if (steps.size() < reach) return false;
  std::vector<SlamStep> around;
  const std::size_t end = std::min(at + reach + 1, steps.size());
  for (std::size_t i = at > reach ? at - reach : 0; i < end; ++i) {
    if (i != at) around.push_back(steps[i].speeds);
  }
  return BreaksMotion(steps[at].speeds, UsualOf(around));
}

// Lengths along the final path; a frame without a pose has that of the frame before.
std::vector<double> PathLengths(const std::vector<std::optional<Pose3>>& poses) {
  std::vector<double> lengths;
  double length_m = 0.0;
  const Pose3* before = nullptr;
  for (const auto& pose : poses) {
    if (pose && before != nullptr) length_m += (pose->translation - before->translation).norm();
    if (pose) before = &*pose;
    lengths.push_back(length_m);
  }
  return lengths;
}

std::optional<LoopClosure> LoopAt(int jump, const std::vector<std::optional<Pose3>>& final,
                                  const std::vector<double>& path_m) {
  const auto second = static_cast<std::size_t>(jump);
  if (!final[second]) return {};
  std::optional<LoopClosure> best;
  double best_cost = kMaxDistanceM + kMetresPerRad * kMaxAngleRad;
  for (std::size_t first = 0; first < second; ++first) {
    if (!final[first] || path_m[second] - path_m[first] < kMinPathM) continue;
    const Pose3 first_from_second = Between(*final[first], *final[second]);
    const double distance_m = first_from_second.translation.norm();
    const double angle_rad = AngleOf(first_from_second.rotation);
    const double cost = distance_m + kMetresPerRad * angle_rad;
    if (distance_m > kMaxDistanceM || angle_rad > kMaxAngleRad || cost >= best_cost) continue;
    best_cost = cost;
    best = LoopClosure{jump,
                       static_cast<int>(first),
                       jump,
                       first_from_second,
                       kSigmaTranslationM,
                       kSigmaRotationRad};
  }
  return best;
}

}  // namespace

std::vector<int> FindJumps(const std::vector<SlamPose>& live, const Trajectory& final) {
  const auto revised = FinalOf(live, final);
  const std::vector<Step> steps = StepsOf(live);
  std::vector<int> jumps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto& from = revised[static_cast<std::size_t>(steps[i].from)];
    const auto& to = revised[static_cast<std::size_t>(steps[i].to)];
    bool jump = IsNoMotion(steps, i);
    if (from && to) {
      const Pose3 live_motion =
          Between(*live[static_cast<std::size_t>(steps[i].from)].slam_from_camera,
                  *live[static_cast<std::size_t>(steps[i].to)].slam_from_camera);
      const Pose3 difference = Between(Between(*from, *to), live_motion);
      jump |=
          difference.translation.norm() > kSlamJumpM || AngleOf(difference.rotation) > kSlamJumpRad;
    }
    if (jump) jumps.push_back(steps[i].to);
  }
  return jumps;
}

std::vector<LoopClosure> LoopsFromRevision(const std::vector<SlamPose>& live,
                                           const Trajectory& final, const std::vector<int>& jumps) {
  const auto revised = FinalOf(live, final);
  const std::vector<double> path_m = PathLengths(revised);
  std::vector<LoopClosure> loops;
  for (const int jump : jumps) {
    if (const auto loop = LoopAt(jump, revised, path_m)) loops.push_back(*loop);
  }
  return loops;
}

std::optional<double> ImpossibleSpeedMps(std::vector<double> speeds_mps) {
  if (speeds_mps.size() <= kFewSpeeds) return {};
  const double usual_mps = UpperMedian(std::move(speeds_mps));
  return usual_mps > kFastestMps ? std::optional(usual_mps) : std::nullopt;
}

std::optional<std::string> DoubtOf(const std::vector<SlamPose>& live,
                                   const std::vector<int>& jumps) {
  std::vector<double> speeds_mps;
  const SlamPose* last = nullptr;
  for (const SlamPose& pose : live) {
    if (!pose.slam_from_camera) continue;
    if (last != nullptr) {
      const double step_m =
          (pose.slam_from_camera->translation - last->slam_from_camera->translation).norm();
      speeds_mps.push_back(step_m / (pose.stamp_s - last->stamp_s));
    }
    last = &pose;
  }
  if (speeds_mps.size() <= kFewSpeeds) return {};
  if (const auto speed_mps = ImpossibleSpeedMps(speeds_mps)) {
    return "the camera moves at " + std::to_string(std::llround(*speed_mps)) +
           " m/s: are the poses in metres, and the stamps in seconds?";
  }
  if (2 * jumps.size() <= speeds_mps.size()) return {};
  const std::string share =
      std::to_string(jumps.size()) + " of " + std::to_string(speeds_mps.size()) + " steps ";
  const std::string question = "are the poses in metres, and those of this recording?";
  if (StampUnitS(live) == 1.0) return share + "are jumps: " + question;
  return share + "would be jumps if the stamps, all whole, count images at 30 Hz: " + question +
         " If they are seconds, nothing is amiss: over such steps no jump is told from motion";
}

void StartEpochs(const std::vector<int>& jumps, std::vector<SlamPose>& live) {
  auto jump = jumps.begin();
  int begun = 0;
  for (std::size_t i = 0; i < live.size(); ++i) {
    for (; jump != jumps.end() && static_cast<std::size_t>(*jump) <= i; ++jump) ++begun;
    live[i].epoch += begun;
  }
}

}  // namespace depthgrid
