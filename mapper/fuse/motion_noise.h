// SLAM's motion noise, learnt from the matches (docs/math.md, "Prior noise").
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
  // Share of the bias that remains after a frame.
  Eigen::Vector3d bias_kept = Eigen::Vector3d::Constant(0.98);
};

// How a motion propagates the errors of pose and bias. Noises are standard deviations.
struct MotionErrors {
  Eigen::Vector3d walk = Eigen::Vector3d::Zero();          // noise added to the pose
  Eigen::Vector3d bias_added = Eigen::Vector3d::Ones();    // factor of the old bias in the pose
  Eigen::Vector3d bias_kept = Eigen::Vector3d::Zero();     // factor of the old bias in the new
  Eigen::Vector3d bias_renewed = Eigen::Vector3d::Zero();  // noise added to the bias
};
// For a motion over `frames` frames (more than 1 after a pause); 0: SLAM stands and has no error.
MotionErrors ErrorsOver(int frames, const MotionNoise& noise);

// Limits noise learnt from matches alone to between once and twice the spread (docs/math.md,
// "Bounds on what is learnt").
void Bound(const MotionSpread& spread, MotionNoise& noise);

// The variances of the error summed over n = 1, 2, 4, ... frames separate the three parts: constant
// for jitter, growing with n for a walk, and with n^2 for a bias until it has changed. The matches'
// noise is constant too; the best matches tell how much of it is jitter.
class MotionNoiseLearner {
 public:
  // `error`: SLAM's motion against that between two matches, in base axes. `match_sigma`: of the
  // match; axes that it hardly observes are skipped.
  void Add(const Eigen::Vector3d& error, const Eigen::Vector3d& match_sigma);
  // The same where SLAM stands (Standing), so that the frame does not count in n. Its error still
  // enters the sums over frames before and after.
  void AddStanding(const Eigen::Vector3d& error, const Eigen::Vector3d& match_sigma);
  // Adds SLAM's motion between two consecutive matches, by Add() or AddStanding().
  void AddMatches(const Pose2& motion, bool stands, const MatchResult& before,
                  const MatchResult& now);
  // Call if the next motion does not follow the last one.
  void Break();

  int motions() const { return motions_; }
  // Number of these that the matches observed, per axis.
  std::array<int, 3> seen() const;
  // `unknown`: used for axes without observations.
  MotionNoise Fit(const MotionNoise& unknown = {}) const;

 private:
  static constexpr int kLags = 11;  // up to 1024 frames
  static constexpr int kRing = 1 << (kLags - 1);
  static constexpr int kClasses = 32;

  // Motion pairs that share a match, of those with about the same variance of that match.
  struct MatchClass {
    double products = 0.0, match_variance = 0.0;  // sums; of the two motions' errors, negated
    double count = 0.0;
  };
  struct Motion {
    double error = 0.0, match_variance = 0.0;  // of the match at its end
  };
  struct Axis {
    std::array<double, kLags> sum_squares{};
    std::array<double, kLags> count{};
    std::vector<double> summed_error = std::vector<double>(kRing, 0.0);  // before recent motions
    double total = 0.0;
    int run = 0;  // motions without a break
    double match_variance = 0.0;
    int matches = 0;
    std::optional<Motion> last;  // unless the next motion does not begin where it ended
    std::array<MatchClass, kClasses> classes{};
  };
  struct AxisNoise {
    double jitter = 0.0, walk = 0.0, bias = 0.0, kept = 0.0;
  };
  std::optional<AxisNoise> FitAxis(const Axis& axis) const;
  static void AddPair(const Motion& motion, Axis& axis);
  // By pairs of motions; `shared_bias`: the covariance that the bias gives two motions in a row.
  static double JitterVariance(const Axis& axis, double shared_bias);

  std::array<Axis, 3> axes_;
  int motions_ = 0;
};

}  // namespace depthgrid
