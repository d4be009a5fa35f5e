#include "mapper/astray_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/core/angle.h"
#include "mapper/core/median.h"
#include "mapper/graph/place.h"

namespace depthgrid {
namespace {

// A step ends with this way or turn, SLAM's or the map's: poses jitter from frame to frame.
constexpr double kStepM = 0.5;
constexpr double kStepRad = 0.5;
// Fewer do not tell what is usual, and where SLAM is nearly perfect, this is.
constexpr std::size_t kFewestSteps = 12;
constexpr double kLeastUsualM = 0.005;
// Steps beside an astray one that are this many times as far apart as usual belong to it.
constexpr double kBesideRatio = 3.0;

// From the frame `first` to the frame `last`.
struct Step {
  int first = 0;
  int last = 0;
  double apart_m = 0.0;
  bool has_tied = false;
};

// A step that grows by frames that SLAM's motion joins.
class GrowingStep {
 public:
  explicit GrowingStep(int first) { step_.first = first; }

  // Whether that ends it.
  bool Add(const std::vector<MappedFrame>& frames, int i) {
    const MappedFrame& frame = FrameAt(frames, i);
    slam_ = slam_ * *frame.slam_motion;
    slam_turn_rad_ += frame.slam_motion->yaw_rad;
    map_turn_rad_ += WrapAngle(PoseAt(frames, i).yaw_rad - PoseAt(frames, i - 1).yaw_rad);
    step_.last = i;
    step_.has_tied = step_.has_tied || !frame.kept();
    const Eigen::Vector2d slam = slam_.translation();
    const Eigen::Vector2d map =
        Between(PoseAt(frames, step_.first), PoseAt(frames, i)).translation();
    step_.apart_m =
        std::hypot((map - slam).norm(), (map_turn_rad_ - slam_turn_rad_) / kMotionUnit.z());
    const double turn_rad = std::max(std::abs(slam_turn_rad_), std::abs(map_turn_rad_));
    return std::max(slam.norm(), map.norm()) >= kStepM || turn_rad >= kStepRad;
  }
  const Step& step() const { return step_; }

 private:
  Step step_;
  Pose2 slam_;
  double slam_turn_rad_ = 0.0;  // summed, full turns included
  double map_turn_rad_ = 0.0;
};

std::vector<Step> StepsOf(const std::vector<MappedFrame>& frames) {
  std::vector<Step> steps;
  GrowingStep growing(0);
  for (int i = 1; i < static_cast<int>(frames.size()); ++i) {
    const MappedFrame& frame = FrameAt(frames, i);
    const bool joined = frame.slam_motion && !frame.of_prior_map();
    const bool ends = joined && growing.Add(frames, i);
    if (ends) steps.push_back(growing.step());
    if (ends || !joined) growing = GrowingStep(i);
  }
  return steps;
}

double MedianApartM(const std::vector<Step>& steps) {
  std::vector<double> apart_m;
  for (const Step& step : steps) apart_m.push_back(step.apart_m);
  return UpperMedian(std::move(apart_m));
}

}  // namespace

std::vector<AstrayPart> AstrayPartsOf(const std::vector<MappedFrame>& frames, double ratio) {
  const std::vector<Step> steps = StepsOf(frames);
  if (steps.size() < kFewestSteps) return {};
  const double usual_m = std::max(kLeastUsualM, MedianApartM(steps));
  std::vector<AstrayPart> parts;
  AstrayPart part;
  double most_m = 0.0;  // of a step of the part
  const auto end_part = [&] {
    if (most_m >= ratio * usual_m) parts.push_back(part);
    part = {};
    most_m = 0.0;
  };
  for (const Step& step : steps) {
    const bool beside = step.apart_m >= kBesideRatio * usual_m && !step.has_tied;
    if (!beside || step.first != part.last) end_part();
    if (!beside) continue;
    if (part.apart_m == 0.0) part.first = step.first;
    part.last = step.last;
    part.apart_m += step.apart_m;
    part.usual_m += usual_m;
    most_m = std::max(most_m, step.apart_m);
  }
  end_part();
  return parts;
}

std::vector<Pose2> FollowingSlam(const std::vector<MappedFrame>& frames, const AstrayPart& part) {
  std::vector<Pose2> poses = PosesOf(frames);
  for (int i = part.first + 1; i <= part.last; ++i) {
    const auto k = static_cast<std::size_t>(i);
    poses[k] = poses[k - 1] * *frames[k].slam_motion;
  }
  const auto last = static_cast<std::size_t>(part.last);
  const Pose2 shift = poses[last] * Inverse(frames[last].map_from_base);  // map axes
  for (std::size_t k = last + 1; k < poses.size(); ++k) poses[k] = shift * poses[k];
  return poses;
}

}  // namespace depthgrid
