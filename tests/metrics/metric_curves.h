// Scores of maps with a known kind and amount of error: the sanity curves of docs/metrics.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "eval/metrics/map_metrics.h"
#include "eval/metrics/map_quality.h"
#include "eval/metrics/picture_filter.h"
#include "mapper/core/rng.h"
#include "tests/metrics/drawn_map.h"

namespace depthgrid {

using CurvePoint = std::vector<std::pair<std::string, double>>;  // score and value; NaN: undefined

struct Curve {
  std::string disturbance;  // with its unit
  std::vector<double> amounts;
  std::vector<CurvePoint> points;  // one per amount

  std::vector<double> Of(const std::string& score) const {
    std::vector<double> values;
    for (const CurvePoint& point : points) {
      for (const auto& [name, value] : point) {
        if (name == score) values.push_back(value);
      }
    }
    return values;
  }
};

// The room is rotated against the grid, as usual.
inline Pose2 CurveRoomPose() { return {0.513, 0.521, 0.3}; }

inline OccupancyMap SureMap(const StateMap& states) {
  OccupancyMap map(states.geometry);
  for (std::size_t i = 0; i < states.states.size(); ++i) {
    if (states.states[i] == CellState::kOccupied) map.occupied_prob[i] = 0.9F;
    if (states.states[i] == CellState::kFree) map.occupied_prob[i] = 0.1F;
  }
  return map;
}

inline CurvePoint ScoresOf(const StateMap& truth, const OccupancyMap& estimate) {
  const MapScore cells = ScoreMap(truth, StatesOf(estimate), std::nullopt);
  const MapQuality q = ScoreMapQuality(truth, estimate, std::nullopt, {});
  const auto number = [](const std::optional<double>& value) { return value.value_or(NAN); };
  const StateScore& exact = cells.all.occupied[0];
  return {
      {"occupied F1, 1 cell", number(cells.all.occupied[1].f1)},
      {"occupied IoU", number(exact.iou)},
      {"F1 10 cm", number(q.walls.f1_10cm)},
      {"chamfer m", number(q.walls.chamfer_m)},
      {"Hausdorff 95 % m", number(q.walls.hausdorff95_m)},
      {"registered chamfer m", q.registered ? number(q.registered->chamfer_m) : NAN},
      {"registration shift m", q.registration ? q.registration->mean_shift_m : NAN},
      {"coverage", number(cells.all.coverage)},
      {"SSIM", number(q.ssim)},
      {"wall thickness m", q.thickness ? q.thickness->mean_m : NAN},
      {"double wall rate", number(q.double_wall_rate)},
      {"Brier score", q.calibration ? q.calibration->brier : NAN},
      {"corners", static_cast<double>(q.truthless.corners)},
      {"enclosed areas", static_cast<double>(q.truthless.enclosed_areas)},
      {"plans: success", q.navigability ? q.navigability->success_rate : NAN},
      {"plans: collisions", q.navigability ? q.navigability->collision_rate.value_or(NAN) : NAN}};
}

// Rotated about the room's centre.
inline OccupancyMap TurnedRoom(double yaw_rad) {
  const Pose2 about{2.0, 1.5, 0.0};
  return SureMap(MovedRoom(CurveRoomPose() * about * Pose2{0.0, 0.0, yaw_rad} * Inverse(about)));
}

inline OccupancyMap ShiftedRoom(double shift_m) {
  const double part_m = shift_m / std::sqrt(2.0);
  return SureMap(MovedRoom(Pose2{part_m, part_m, 0.0} * CurveRoomPose()));
}

// Walls blurred by a Gaussian, with the original probability at their centre.
inline OccupancyMap BlurredRoom(double sigma_m) {
  const StateMap room = MovedRoom(CurveRoomPose());
  OccupancyMap map = SureMap(room);
  const double sigma_cells = sigma_m / room.geometry.resolution_m;
  if (sigma_cells <= 0.0) return map;
  const Picture walls = Smoothed(PictureOfStates(room, {0.0, 0.0, 1.0}, 0), sigma_cells,
                                 static_cast<int>(std::ceil(3.0 * sigma_cells)));
  const double middle = 1.0 / std::max(1.0, std::sqrt(2.0 * kPi) * sigma_cells);
  for (std::size_t i = 0; i < room.states.size(); ++i) {
    const double share = std::min(1.0, walls.values[i] / middle);
    // The blur also extends behind the walls.
    if (room.states[i] == CellState::kUnknown && share < 0.1) continue;
    map.occupied_prob[i] = static_cast<float>(0.1 + 0.8 * share);
  }
  return map;
}

// A share of the known cells is made unknown.
inline OccupancyMap ThinnedRoom(double share) {
  OccupancyMap map = SureMap(MovedRoom(CurveRoomPose()));
  for (std::size_t i = 0; i < map.occupied_prob.size(); ++i) {
    RandomStream random(1, RandomStage::kTest, static_cast<std::uint32_t>(i));
    if (random.Uniform() < share) map.occupied_prob[i] = kUnknownProb;
  }
  return map;
}

inline Curve CurveOf(const std::string& disturbance, const std::vector<double>& amounts,
                     const std::function<OccupancyMap(double)>& disturbed) {
  const StateMap truth = MovedRoom(CurveRoomPose());
  Curve curve{disturbance, amounts, {}};
  for (const double amount : amounts) curve.points.push_back(ScoresOf(truth, disturbed(amount)));
  return curve;
}

inline std::vector<double> Steps(double last, int count) {
  std::vector<double> amounts;
  for (int i = 0; i <= count; ++i) amounts.push_back(last * i / count);
  return amounts;
}

inline std::vector<Curve> SanityCurves(int steps) {
  return {CurveOf("shift m", Steps(0.5, steps), ShiftedRoom),
          CurveOf("rotation deg", Steps(10.0, steps),
                  [](double deg) { return TurnedRoom(RadFromDeg(deg)); }),
          CurveOf("blur m", Steps(0.15, steps), BlurredRoom),
          CurveOf("dropout share", Steps(0.9, steps), ThinnedRoom)};
}

}  // namespace depthgrid
