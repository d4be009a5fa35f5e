#include "sim/slam/slam_surrogate.h"

#include <algorithm>

#include "sim/slam/loop_correction.h"
#include "sim/slam/slam_error.h"
#include "sim/slam/slam_loops.h"

namespace depthgrid {
namespace {

// Identities are skipped so that poses without error are unchanged bit for bit.
Pose3 Composed(const Pose3& a_from_b, const Pose3& b_from_c) {
  if (a_from_b == Pose3{}) return b_from_c;
  if (b_from_c == Pose3{}) return a_from_b;
  return a_from_b * b_from_c;
}

// SLAM's estimate of the frames so far, without jitter and bias.
class Estimate {
 public:
  explicit Estimate(const Trajectory& truth) : truth_(truth) {}

  void Add(const Pose3& motion_error) {
    const Pose3& true_pose = truth_[poses_.size()].world_from_camera;
    poses_.push_back(Composed(Composed(slam_from_world_, true_pose), motion_error));
    if (!(motion_error == Pose3{})) slam_from_world_ = poses_.back() * Inverse(true_pose);
  }

  // Closes a loop; poses corrected by earlier closures stay. Returns whether anything moved.
  bool Correct(const LoopClosure& loop) {
    const int fixed = std::max(loop.first_frame, corrected_until_);
    if (loop.second_frame <= fixed) return false;
    const Pose3 target =
        poses_[static_cast<std::size_t>(loop.first_frame)] * loop.first_from_second;
    poses_ = CorrectChain(std::move(poses_), fixed, loop.second_frame, target);
    corrected_until_ = loop.second_frame;
    const Pose3& true_pose = truth_[poses_.size() - 1].world_from_camera;
    slam_from_world_ = poses_.back() * Inverse(true_pose);
    return true;
  }

  const std::vector<Pose3>& poses() const { return poses_; }

 private:
  const Trajectory& truth_;
  std::vector<Pose3> poses_;
  Pose3 slam_from_world_;  // the drift at the last pose
  int corrected_until_ = 0;
};

std::vector<bool> TrackedFrames(const std::vector<FrameErrors>& errors) {
  std::vector<bool> tracked;
  for (const FrameErrors& error : errors) tracked.push_back(!error.lost);
  return tracked;
}

}  // namespace

SlamOutput DisturbTrajectory(const Trajectory& truth, const SlamOptions& options,
                             std::uint64_t seed) {
  const std::vector<FrameErrors> errors = DrawFrameErrors(truth, options, seed);
  const std::vector<SimulatedLoop> loops =
      SimulateLoops(truth, TrackedFrames(errors), options.loops, seed);
  SlamOutput output;
  Estimate estimate(truth);
  auto loop = loops.begin();
  int epoch = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    estimate.Add(errors[i].motion);
    bool corrected = errors[i].relocalised;
    for (; loop != loops.end() && loop->closure.reported_at_frame == static_cast<int>(i); ++loop) {
      output.loops.push_back(loop->closure);
      if (loop->is_true || options.loops.follow_false) {
        corrected = estimate.Correct(loop->closure) || corrected;
      }
    }
    epoch += corrected ? 1 : 0;
    output.live.push_back({truth[i].stamp_s, std::nullopt, epoch});
    if (errors[i].lost) continue;
    output.live.back().slam_from_camera = Composed(estimate.poses().back(), errors[i].offset);
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (errors[i].lost) continue;
    output.final.push_back({truth[i].stamp_s, Composed(estimate.poses()[i], errors[i].offset)});
  }
  return output;
}

}  // namespace depthgrid
