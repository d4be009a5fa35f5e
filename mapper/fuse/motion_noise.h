// How SLAM's motion errs, learnt from the matches (docs/math.md, "Prior noise").
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "mapper/frame_report.h"

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
// Over so many frames at once, where a recording paused.
MotionErrors ErrorsOver(int frames, const MotionNoise& noise);

// The same as seen from poses and map adjusted together: the error of SLAM's motion over stretches
// of so many frames, as that of one frame if it grows with their number.
struct MotionSpread {
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
  double frames = 1.0;
  int stretches = 0;  // that saw something
  // How well such a motion, of one frame, is told by what was seen; infinite where nothing tells
  // it.
  Eigen::Vector3d seen_sigma = Eigen::Vector3d::Zero();

  // Fewer are not believed for long: from the seven of the first 60 frames a prior that drifts
  // 0.375 m was once called nearly perfect (docs/tried.md, "A nearly perfect prior").
  bool IsSure() const { return stretches >= 20; }
  // Of so few it says nothing of an axis along which they hardly saw, nor of one along which SLAM
  // errs by so much that matches had better lead (docs/math.md, "The first frames again").
  bool Tells(int axis) const { return IsSure() || seen_sigma[axis] <= 0.01; }
};

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
  // The same from two matches in a row and SLAM's motion between them.
  void AddMatches(const Pose2& motion, const MatchResult& before, const MatchResult& now);
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
