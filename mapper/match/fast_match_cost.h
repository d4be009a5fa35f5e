// The cost of Eq. 4 (match_cost.h), eight points at a time in single precision.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "mapper/match/match_cost.h"
#include "mapper/match/match_information.h"

namespace depthgrid {

// For a solver that evaluates one scan at many nearby poses. Between two of them most points stay
// within their square of four cell centres, so the square's bicubic polynomial is kept and only
// evaluated again. Keeps its memory from scan to scan.
class FastMatchCost {
 public:
  // Copies the part of the map that the points can reach from here. Not empty; the points and the
  // map's cells must live until the last evaluation.
  void Prepare(const MatchPoints& points, const ProbabilityView& view, const Pose2& map_from_base);

  // As EvaluateMatchCost, to single precision, anywhere.
  MatchCost Evaluate(const Pose2& map_from_base);
  // As SumUpInformation.
  InformationSums SumUp(const Pose2& map_from_base, const MatchInformationOptions& options);

  // What the last Prepare was given; the points are borrowed.
  const MatchPoints& points() const { return *points_; }
  const ProbabilityView& view() const { return view_; }
  // Length scales: typical lever arm of the points, and a cell.
  double arm_m() const { return std::max(0.5 * points_->farthest_m, 1e-3); }
  double resolution_m() const { return view_.geometry.resolution_m; }

 private:
  template <typename Visitor>
  void ForEachVector(const Pose2& map_from_base, Visitor visit);
  bool Reaches(const Pose2& map_from_base) const;
  void CopyMap(const Pose2& map_from_base);
  float* AlignedPolynomials();

  const MatchPoints* points_ = nullptr;
  ProbabilityView view_;

  // The copied rectangle around the points at `middle_`.
  Pose2 middle_;
  GridGeometry copied_;
  std::vector<float> probs_;

  // Per point, filled up to whole vectors.
  std::vector<float> x_m_;
  std::vector<float> y_m_;
  std::vector<float> weight_;         // 1; 0 for padding
  std::vector<std::int32_t> square_;  // index of the point's square in probs_; -1 for none yet
  std::vector<float> polynomial_;     // 16 coefficients a point, vector by vector
};

}  // namespace depthgrid
