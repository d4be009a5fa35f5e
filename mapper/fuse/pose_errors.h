// How the errors of the online poses go together (docs/math.md, "What the map passes on"). What is
// drawn at a pose carries that pose's error on, and every match against it repeats the error: a
// filter that takes the map for exact believes its poses far better known than they are. Here the
// error of the newest pose is carried along with those of earlier ones, and of a match's error that
// share is theirs which they drew. Nothing here changes a pose; it says how well motions are known.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/fuse/filter_step.h"

namespace depthgrid {

class PoseErrors {
 public:
  // Motions are told over at most so many frames.
  explicit PoseErrors(int stretch_frames);

  // The next frame with a pose. `index` is its own number, `mapped` its position among the mapped
  // frames, or the one it would have. `information` is that of the match that the step took,
  // `parts` what it was made against; none: the frame was not matched.
  void Add(const FilterStep& step, int index, int mapped, const Eigen::Matrix3d& information,
           std::span<const MapPart> parts);
  // The map was corrected: no motion goes on from before.
  void Break() { broken_ = true; }
  // SLAM began anew: the next frame lies at this pose, which errs by so much in addition (base
  // axes), and nothing goes on from before, the bias neither.
  void BeginEpoch(const Pose2& map_from_base, const Eigen::Matrix3d& added,
                  const std::optional<Eigen::Vector3d>& bias);

  // The positions, among the mapped frames, of those whose errors are remembered.
  std::vector<int> Mapped() const;
  // Poses and map were adjusted together: what is left of the errors of the frames at Mapped()
  // (three rows each, map axes; empty: not known), the newest of them last, and of the bias.
  void Adjusted(const Eigen::MatrixXd& covariance, const std::optional<Eigen::Vector3d>& bias);

  // The frame that motions are told from; the newest itself after a break.
  int motion_from() const { return knots_[marked_].index; }
  // Of the last match's innovation, in base axes of the predicted pose: what the pose and what it
  // was matched against have in common is not in it. Of what the match does not see only the
  // prediction's part is told. Empty: the last frame was not matched.
  const std::optional<Eigen::Matrix3d>& innovation_covariance() const { return innovation_; }
  // Of the motion from there to the newest frame, in base axes of the newest, at this pose.
  Eigen::Matrix3d MotionCovariance(const Pose2& map_from_base) const;

 private:
  // So many earlier frames are remembered, denser the newer they are.
  static constexpr int kKnots = 32;
  // Rows of newest_, in axes of origin_ but for the bias: true pose = Exp(error) * estimate.
  static constexpr int kPose = 0;      // the filter's state
  static constexpr int kBias = 3;      // and its bias, in base axes
  static constexpr int kMapNoise = 6;  // of the map's surface that is in view
  static constexpr int kCamera = 9;    // the pose as reported
  using Matrix9 = Eigen::Matrix<double, 9, 9>;
  using Matrix93 = Eigen::Matrix<double, 9, 3>;
  using KnotsWith = Eigen::Matrix<double, 3 * kKnots, 3>;

  struct Knot {
    int frame = 0;  // counted by Add()
    int index = 0;
    int mapped = 0;  // position among the mapped frames
    int slot = 0;    // its columns, in threes
  };
  // The error of a match: covariance, and that with the state and the knots.
  struct MatchError {
    Eigen::Matrix3d covariance;
    Matrix93 with_state;
  };

  // Errors are kept in axes of the origin, which lie as the map's. Far away a heading's error would
  // be so large an error of place that nothing were left of the digits.
  Eigen::Matrix3d OriginFromBase(const Pose2& map_from_base) const;
  Eigen::Matrix3d BaseFromOrigin(const Pose2& map_from_base) const;
  void Predict(const FilterStep& step, std::span<const MapPart> parts);
  void Weigh(std::span<const MapPart> parts, const Pose2& map_from_base);
  MatchError See(const FilterStep& step, const Eigen::Matrix3d& information,
                 std::span<const MapPart> parts);
  void Take(const FilterStep& step, const MatchError& match);
  void RenewBias(const Eigen::Vector3d& bias);
  void Keep(int index, int mapped);
  int SlotOf(double mapped) const;
  std::size_t Spare() const;

  int stretch_frames_;
  Pose2 origin_;  // where the first pose lies
  bool broken_ = false;
  std::optional<Eigen::Matrix3d> innovation_;
  int frame_ = -1;
  Eigen::Matrix<double, 12, 12> newest_ = Eigen::Matrix<double, 12, 12>::Zero();
  // Rows: the knots, so that they lie side by side; columns: those of newest_.
  Eigen::Matrix<double, 3 * kKnots, 12> knots_with_newest_;
  Eigen::Matrix<double, 3 * kKnots, 3 * kKnots> covariance_;  // of the knots
  std::vector<Knot> knots_;                                   // by frame
  std::size_t marked_ = 0;
  // Of the match at hand: the share of its error that is a knot's, by slot; slots with a share; and
  // the match's covariance with the knots.
  std::array<Eigen::Matrix3d, kKnots> share_;
  std::vector<int> shared_;
  KnotsWith knots_with_match_;
};

}  // namespace depthgrid
