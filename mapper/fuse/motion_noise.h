// How SLAM's motion errs, learnt from the matches (docs/math.md, "Prior noise").
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "mapper/core/frame_report.h"
#include "mapper/core/motion_spread.h"

namespace depthgrid {

// The error of SLAM's motion from one frame to the next, per base axis (forward m, left m, yaw
// rad): white jitter of each pose (which enters two motions with opposite signs), a random walk,
// and a bias that changes slowly. Standard deviations.
struct MotionNoise {
  Eigen::Vector3d jitter = Eigen::Vector3d::Zero();
  Eigen::Vector3d walk = Eigen::Vector3d::Zero();  // a frame
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  // a frame
  // What is left of the bias after a frame.
  Eigen::Vector3d bias_kept = Eigen::Vector3d::Constant(0.98);
};

// What a motion does to the errors of a pose and of the bias before it. Standard deviations.
struct MotionErrors {
  Eigen::Vector3d walk = Eigen::Vector3d::Zero();          // added to the pose
  Eigen::Vector3d bias_added = Eigen::Vector3d::Ones();    // of the bias before, to the pose
  Eigen::Vector3d bias_kept = Eigen::Vector3d::Zero();     // of the bias before
  Eigen::Vector3d bias_renewed = Eigen::Vector3d::Zero();  // added to it
};
// Over so many frames at once, where a recording paused; 0: SLAM stands, and does not err.
MotionErrors ErrorsOver(int frames, const MotionNoise& noise);

// Keeps what is learnt from matches alone between once and twice the spread (docs/math.md, "Bounds
// on what is learnt").
void Bound(const MotionSpread& spread, MotionNoise& noise);

// Variances of the summed error over 1, 2, 4, ... frames tell the three parts apart: jitter's stays
// the same, that of a walk grows with the number of frames, that of a bias with its square until
// the bias has changed.
class MotionNoiseLearner {
 public:
  // `error`: SLAM's motion against that between two matches, in base axes. `match_sigma` is that of
  // the match; an axis that the match hardly sees says nothing.
  void Add(const Eigen::Vector3d& error, const Eigen::Vector3d& match_sigma);
  // The same where SLAM stands (Standing): no frame in which it erred. What poses and matches
  // jitter by meanwhile is in the sums over frames before and after.
  void AddStanding(const Eigen::Vector3d& error, const Eigen::Vector3d& match_sigma);
  // The same from two matches in a row and SLAM's motion between them.
  void AddMatches(const Pose2& motion, bool stands, const MatchResult& before,
                  const MatchResult& now);
  // The next motion does not follow the last.
  void Break();

  int motions() const { return motions_; }
  // Of them, those that the matches saw along each axis.
  std::array<int, 3> seen() const;
  // `unknown`: of axes along which nothing was seen yet.
  MotionNoise Fit(const MotionNoise& unknown = {}) const;

 private:
  static constexpr int kLags = 11;  // up to 1024 frames
  static constexpr int kRing = 1 << (kLags - 1);

  struct Axis {
    std::array<double, kLags> sum_squares{};
    std::array<double, kLags> count{};
    std::vector<double> summed_error = std::vector<double>(kRing, 0.0);  // of the last frames
    double total = 0.0;
    int run = 0;  // motions without a break
    double match_variance = 0.0;
    int matches = 0;
  };
  struct AxisNoise {
    double jitter = 0.0, walk = 0.0, bias = 0.0, kept = 0.0;
  };
  std::optional<AxisNoise> FitAxis(const Axis& axis) const;

  std::array<Axis, 3> axes_;
  int motions_ = 0;
};

}  // namespace depthgrid
