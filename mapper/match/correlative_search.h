// Brute-force correlative search around a predicted pose (Olson 2009; Cartographer's real-time
// matcher): every candidate of a lattice is scored by the mean probability of the cells its points
// fall in (docs/math.md, "Scan matching").
#pragma once

#include <vector>

#include "mapper/core/options.h"
#include "mapper/match/lattice_scorer.h"

namespace depthgrid {

enum class SearchMethod { kReference, kFast };

struct CorrelativeOptions {
  // Both give the same pose and score; `reference` exists to check and to measure `fast`.
  SearchMethod method = SearchMethod::kFast;
  // Half widths. A frame-to-frame prediction of SLAM errs by millimetres and 0.3 degrees
  // (measured on ORB-SLAM2's fr2/desk); the window is for jumps. Cartographer: 0.1 m, 20 degrees.
  double window_m = 0.1;
  double window_deg = 5.0;
  // The score is multiplied by exp(-(translation_cost |t| + rotation_cost |yaw|)^2) as in
  // Cartographer. 0, the default, is prior-free: fusion (Eq. 3) must not count the prediction
  // twice.
  double translation_cost_per_m = 0.0;
  double rotation_cost_per_rad = 0.0;

  void Visit(OptionsVisitor& v);
};

struct CorrelativeMatch {
  bool found = false;  // false without points
  LatticeStep step;
  Pose2 map_from_base;
  double score = 0.0;  // mean probability of the points' cells, 0..1
};

class CorrelativeSearch {
 public:
  explicit CorrelativeSearch(const CorrelativeOptions& options);

  CorrelativeMatch Search(const MatchPoints& points, const ProbabilityView& view,
                          const Pose2& predicted_map_from_base);

 private:
  CorrelativeMatch SearchFast(const SearchLattice& lattice, const MatchPoints& points,
                              const ProbabilityView& view);
  void OrderTranslations(int half_cells);

  CorrelativeOptions options_;
  LatticeScorer scorer_;
  std::vector<LatticeStep> translations_;  // of one rotation, in tie-breaking order
  int ordered_half_cells_ = -1;
};

}  // namespace depthgrid
