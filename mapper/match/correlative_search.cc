#include "mapper/match/correlative_search.h"

#include <cmath>

namespace depthgrid {
namespace {

double PriorWeight(const CorrelativeOptions& options, const SearchLattice& lattice,
                   const LatticeStep& step) {
  const double translation_m = lattice.resolution_m * std::hypot(step.x_cells, step.y_cells);
  const double rotation_rad = lattice.yaw_step_rad * std::abs(step.yaw_steps);
  const double cost =
      options.translation_cost_per_m * translation_m + options.rotation_cost_per_rad * rotation_rad;
  return std::exp(-cost * cost);
}

CorrelativeMatch SearchExhaustively(const CorrelativeOptions& options, const SearchLattice& lattice,
                                    const MatchPoints& points, const ProbabilityView& view) {
  CorrelativeMatch best;
  double best_score = -1.0;
  for (int yaw = -lattice.half_yaw_steps; yaw <= lattice.half_yaw_steps; ++yaw) {
    for (int y = -lattice.half_cells; y <= lattice.half_cells; ++y) {
      for (int x = -lattice.half_cells; x <= lattice.half_cells; ++x) {
        const LatticeStep step{x, y, yaw};
        const double score =
            LatticeScore(lattice, step, points, view) * PriorWeight(options, lattice, step);
        if (score < best_score) continue;
        if (score == best_score && !PrecedesInLattice(step, best.step)) continue;
        best_score = score;
        best.step = step;
      }
    }
  }
  best.found = true;
  best.map_from_base = lattice.PoseOf(best.step);
  best.score = LatticeScore(lattice, best.step, points, view) /
               (static_cast<double>(kMatchProbScale) * points.size());
  return best;
}

}  // namespace

void CorrelativeOptions::Visit(OptionsVisitor& v) {
  v.Choice("method", method,
           {{SearchMethod::kFast, "fast"}, {SearchMethod::kReference, "reference"}},
           "how the search is computed; both give the same pose");
  v.Number("window_m", window_m, {0.0, 10.0}, "half width of the searched square");
  v.Number("window_deg", window_deg, {0.0, 180.0}, "half width of the searched angles");
  v.Number("translation_cost_per_m", translation_cost_per_m, {0.0, 1e3},
           "pull of the predicted position; 0 is prior-free");
  v.Number("rotation_cost_per_rad", rotation_cost_per_rad, {0.0, 1e3},
           "pull of the predicted yaw; 0 is prior-free");
}

CorrelativeSearch::CorrelativeSearch(const CorrelativeOptions& options) : options_(options) {}

CorrelativeMatch CorrelativeSearch::Search(const MatchPoints& points, const ProbabilityView& view,
                                           const Pose2& predicted_map_from_base) {
  if (points.size() == 0) return {};
  const SearchLattice lattice =
      MakeLattice(predicted_map_from_base, options_.window_m, RadFromDeg(options_.window_deg),
                  view.geometry.resolution_m, points.farthest_m);
  return SearchExhaustively(options_, lattice, points, view);
}

}  // namespace depthgrid
