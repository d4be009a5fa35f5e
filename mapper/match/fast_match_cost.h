// The cost of Eq. 4 (match_cost.h), eight points at a time in single precision.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/match/match_cost.h"

namespace depthgrid {

// For a solver that evaluates one scan at many nearby poses. Between two of them most points stay
// within their square of four cell centres, so the square's bicubic polynomial is kept and only
// evaluated again. Keeps its memory from scan to scan.
class FastMatchCost {
 public:
  // Copies the points and the part of the map they can reach from here. Not empty.
  void Prepare(const MatchPoints& points, const ProbabilityView& view, const Pose2& map_from_base);

  // As EvaluateMatchCost, to single precision, anywhere.
  MatchCost Evaluate(const Pose2& map_from_base);

 private:
  bool Reaches(const Pose2& map_from_base) const;
  void CopyMap(const Pose2& map_from_base);

  const MatchPoints* points_ = nullptr;  // of the last Prepare, as is the view
  ProbabilityView view_;

  // The copied rectangle around the points at `middle_`.
  Pose2 middle_;
  GridGeometry copied_;
  std::vector<float> probs_;

  // Per point, filled up to whole vectors.
  std::vector<float> x_m_;
  std::vector<float> y_m_;
  std::vector<float> weight_;         // 1; 0 for what fills up
  std::vector<std::int32_t> square_;  // index of the point's square in probs_; -1 for none yet
  std::vector<float> polynomial_;     // 16 coefficients a point, vector by vector
};

}  // namespace depthgrid
