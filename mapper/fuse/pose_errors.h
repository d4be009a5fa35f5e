// Joint covariance of the online poses' errors (docs/math.md, "What the map passes on"). The map
// inherits the error of the poses it was drawn at, and a match against it repeats that error, so a
// filter that takes the map as exact is overconfident. Here the newest pose's error is tracked
// jointly with those of earlier ones, which contribute to a match's error as they drew the surface
// matched. Changes no pose; gives the covariance of motions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/fuse/filter_step.h"

namespace depthgrid {

// The part of a scan's own error that is not new in each frame but lasts while the view does.
struct LastingError {
  double share = 0.0;                               // of the match's variance
  Eigen::Vector3d least = Eigen::Vector3d::Zero();  // sigma in base axes, added
};
// That of a depth camera, of which `share` (FusionOptions::lasting_share) is set; none if it is 0.
LastingError LastingErrorOfCamera(double share);

class PoseErrors {
 public:
  // `stretch_frames`: most frames over which motions are reported.
  explicit PoseErrors(int stretch_frames);

  // Adds the next frame with a pose. `index`: its Frame::index; `mapped`: its (would-be) index
  // among the mapped frames. `information`: of the match used in the step; `parts`: what was
  // matched against, empty if the frame was not matched.
  void Add(const FilterStep& step, int index, int mapped, const Eigen::Matrix3d& information,
           std::span<const MapPart> parts, const LastingError& lasting = {});
  // Call when the map was corrected: reported motions restart.
  void Break() { broken_ = true; }
  // Call when a new SLAM epoch begins with the next frame at this pose: adds covariance (base
  // axes), restarts motions and resets the bias.
  void BeginEpoch(const Pose2& map_from_base, const Eigen::Matrix3d& added,
                  const std::optional<Eigen::Vector3d>& bias);

  // Indices, among the mapped frames, of the frames whose errors are tracked.
  std::vector<int> Mapped() const;
  // Sets the covariance after a joint adjustment: of the frames in Mapped() order (three rows each,
  // map axes; empty: unknown), and of the bias.
  void Adjusted(const Eigen::MatrixXd& covariance, const std::optional<Eigen::Vector3d>& bias);

  // Frame::index from which motions are reported; the newest frame itself after a break.
  int motion_from() const { return knots_[marked_].index; }
  // Covariance of the last innovation, in base axes of the predicted pose, without the errors that
  // pose and matched map share. Along unobserved directions only the prediction's part is included.
  // Empty if the last frame was not matched.
  const std::optional<Eigen::Matrix3d>& innovation_covariance() const { return innovation_; }
  // Covariance of the motion from motion_from() to the newest frame at `map_from_base`, in its base
  // axes.
  Eigen::Matrix3d MotionCovariance(const Pose2& map_from_base) const;

 private:
  // Number of earlier frames tracked (knots), denser the newer they are.
  static constexpr int kKnots = 32;
  // Rows of newest_, in axes of origin_ except the bias: true pose = Exp(error) * estimate.
  static constexpr int kPose = 0;      // the filter's state
  static constexpr int kBias = 3;      // the filter's bias, in base axes
  static constexpr int kMapNoise = 6;  // of the surface in view, with the scan's lasting error
  static constexpr int kCamera = 9;    // the pose as reported
  using Matrix9 = Eigen::Matrix<double, 9, 9>;
  using Matrix93 = Eigen::Matrix<double, 9, 3>;
  using KnotsWith = Eigen::Matrix<double, 3 * kKnots, 3>;

  struct Knot {
    int frame = 0;  // count of Add() calls
    int index = 0;
    int mapped = 0;  // index among the mapped frames
    int slot = 0;    // its block of 3 rows and columns
  };
  // The error of a match: its covariance, and its covariance with the state.
  struct MatchError {
    Eigen::Matrix3d covariance;
    Matrix93 with_state;
  };

  // Errors are kept in axes parallel to the map's at the first pose: with a distant origin, heading
  // errors would cause huge position errors and lose all digits.
  Eigen::Matrix3d OriginFromBase(const Pose2& map_from_base) const;
  Eigen::Matrix3d BaseFromOrigin(const Pose2& map_from_base) const;
  void Predict(const FilterStep& step, std::span<const MapPart> parts);
  void Weigh(std::span<const MapPart> parts, const Pose2& map_from_base);
  MatchError See(const FilterStep& step, const Eigen::Matrix3d& information,
                 std::span<const MapPart> parts, const LastingError& lasting);
  void Take(const FilterStep& step, const MatchError& match);
  void RenewBias(const Eigen::Vector3d& bias);
  void Keep(int index, int mapped);
  int SlotOf(double mapped) const;
  std::size_t Spare() const;

  int stretch_frames_;
  Pose2 origin_;  // position of the first pose, yaw 0
  bool broken_ = false;
  std::optional<Eigen::Matrix3d> innovation_;
  int frame_ = -1;
  Eigen::Matrix<double, 12, 12> newest_ = Eigen::Matrix<double, 12, 12>::Zero();
  // Covariance of the knots (rows) with newest_ (columns).
  Eigen::Matrix<double, 3 * kKnots, 12> knots_with_newest_;
  Eigen::Matrix<double, 3 * kKnots, 3 * kKnots> covariance_;  // of the knots
  std::vector<Knot> knots_;                                   // in order of frame
  std::size_t marked_ = 0;
  // For the current match: weight of each knot's error in its error, by slot; slots with a weight;
  // and the match's covariance with the knots.
  std::array<Eigen::Matrix3d, kKnots> share_;
  std::vector<int> shared_;
  KnotsWith knots_with_match_;
};

}  // namespace depthgrid
