#include "mapper/match/correlative_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

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
           "pull towards the predicted position; 0 is prior-free");
  v.Number("rotation_cost_per_rad", rotation_cost_per_rad, {0.0, 1e3},
           "pull towards the predicted yaw; 0 is prior-free");
}

CorrelativeSearch::CorrelativeSearch(const CorrelativeOptions& options) : options_(options) {}

CorrelativeMatch CorrelativeSearch::Search(const MatchPoints& points, const ProbabilityView& view,
                                           const Pose2& predicted_map_from_base) {
  if (points.size() == 0) return {};
  const SearchLattice lattice =
      MakeLattice(predicted_map_from_base, options_.window_m, RadFromDeg(options_.window_deg),
                  view.geometry.resolution_m, points.farthest_m);
  return options_.method == SearchMethod::kFast
             ? SearchFast(lattice, points, view)
             : SearchExhaustively(options_, lattice, points, view);
}

CorrelativeMatch CorrelativeSearch::SearchFast(const SearchLattice& lattice,
                                               const MatchPoints& points,
                                               const ProbabilityView& view) {
  scorer_.Prepare(lattice, points, view);
  OrderTranslations(lattice.half_cells);
  const bool has_prior =
      options_.translation_cost_per_m > 0.0 || options_.rotation_cost_per_rad > 0.0;
  CorrelativeMatch best;
  double best_score = -1.0;
  std::uint32_t best_sum = 0;
  // From the predicted yaw outwards, -n before n; a later candidate with an equal score does not
  // win.
  for (int i = 0; i <= 2 * lattice.half_yaw_steps; ++i) {
    const int yaw = i % 2 == 1 ? -(i + 1) / 2 : i / 2;
    // The prior's weight is at most 1, so a rotation that cannot reach best_score without it is
    // skipped.
    if (!scorer_.ScoreRotation(yaw, static_cast<std::int64_t>(std::floor(best_score)))) continue;
    for (const LatticeStep& translation : translations_) {
      const LatticeStep step{translation.x_cells, translation.y_cells, yaw};
      const std::uint32_t sum = scorer_.Score(step.x_cells, step.y_cells);
      if (sum <= best_score) continue;
      const double score = has_prior ? sum * PriorWeight(options_, lattice, step) : sum;
      if (score <= best_score) continue;
      best_score = score;
      best_sum = sum;
      best.step = step;
    }
  }
  best.found = true;
  best.map_from_base = lattice.PoseOf(best.step);
  best.score = best_sum / (static_cast<double>(kMatchProbScale) * points.size());
  return best;
}

void CorrelativeSearch::OrderTranslations(int half_cells) {
  if (ordered_half_cells_ == half_cells) return;
  ordered_half_cells_ = half_cells;
  translations_.clear();
  for (int y = -half_cells; y <= half_cells; ++y) {
    for (int x = -half_cells; x <= half_cells; ++x) translations_.push_back({x, y, 0});
  }
  std::sort(translations_.begin(), translations_.end(), PrecedesInLattice);
}

}  // namespace depthgrid
