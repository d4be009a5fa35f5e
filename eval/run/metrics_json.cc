#include "eval/run/metrics_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace depthgrid {
namespace {

using Json = nlohmann::ordered_json;

Json ToJson(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json ToJson(const Statistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std},
          {"min", s.min},   {"max", s.max},   {"sse", s.sse},       {"count", s.count}};
}

Json ToJson(const std::optional<Statistics>& s) { return s ? ToJson(*s) : Json(nullptr); }

Json RmseOf(const std::optional<Statistics>& s) { return s ? Json(s->rmse) : Json(nullptr); }

Json ToJson(const StateScore& score) {
  return {{"precision", ToJson(score.precision)},
          {"recall", ToJson(score.recall)},
          {"f1", ToJson(score.f1)},
          {"iou", ToJson(score.iou)},
          {"estimated_cells", score.estimated_cells},
          {"right_cells", score.right_cells},
          {"true_cells", score.true_cells},
          {"found_cells", score.found_cells}};
}

// The default tolerance's figures at the top, the others under their own names.
Json ByTolerance(const std::array<StateScore, kMaxToleranceCells + 1>& scores) {
  Json json = ToJson(scores[kDefaultToleranceCells]);
  for (std::size_t tolerance = 0; tolerance < scores.size(); ++tolerance) {
    if (tolerance == kDefaultToleranceCells) continue;
    json["tolerance_" + std::to_string(tolerance)] = ToJson(scores[tolerance]);
  }
  return json;
}

Json ToJson(const CellScores& scores) {
  constexpr std::array<const char*, 3> kStates = {"unknown", "free", "occupied"};
  Json confusion;
  for (std::size_t truth = 0; truth < kStates.size(); ++truth) {
    for (std::size_t estimate = 0; estimate < kStates.size(); ++estimate) {
      confusion[std::string("truth_") + kStates[truth]]
               [std::string("estimate_") + kStates[estimate]] = scores.confusion[truth][estimate];
    }
  }
  return {{"occupied", ByTolerance(scores.occupied)},
          {"free", ByTolerance(scores.free)},
          {"chamfer_m", ToJson(scores.chamfer_m)},
          {"estimate_to_truth_m", ToJson(scores.estimate_to_truth_m)},
          {"truth_to_estimate_m", ToJson(scores.truth_to_estimate_m)},
          {"hausdorff95_m", ToJson(scores.hausdorff95_m)},
          {"coverage", ToJson(scores.coverage)},
          {"occupied_mcc", ToJson(scores.occupied_mcc)},
          {"free_mcc", ToJson(scores.free_mcc)},
          {"scored_cells", scores.scored_cells},
          {"confusion", confusion}};
}

Json ToJson(const std::vector<Drift>& drifts, const char* over) {
  Json rows = Json::array();
  for (const Drift& drift : drifts) {
    rows.push_back({{over, drift.over},
                    {"motions", drift.motions},
                    {"translation_rms_m", drift.translation_rms_m},
                    {"rotation_rms_rad", drift.rotation_rms_rad},
                    {"translation_mean_m", drift.translation_mean_m},
                    {std::string("mean_") + over, drift.mean_over}});
  }
  return rows;
}

// The lag and the length whose drift has a key of its own.
constexpr double kMainDriftLagS = 10.0;
constexpr double kMainDriftLengthM = 1.0;
static_assert(std::find(kDriftLagsS.begin(), kDriftLagsS.end(), kMainDriftLagS) !=
              kDriftLagsS.end());
static_assert(std::find(kDriftLengthsM.begin(), kDriftLengthsM.end(), kMainDriftLengthM) !=
              kDriftLengthsM.end());

// Mean drift per unit, from the motions over `over` units.
Json DriftAt(const std::vector<Drift>& drifts, double over) {
  for (const Drift& drift : drifts) {
    if (drift.over == over) return drift.PerUnit();
  }
  return nullptr;
}

Json ToJson(const TrajectoryScore& score) {
  Json json = {
      {"mean_euclidean_m", score.xy_unaligned.mean},
      {"ate_rmse_m", score.xy_unaligned.rmse},
      {"ate_rmse_origin_m", score.xy_origin.rmse},
      {"ate_rmse_se2_m", RmseOf(score.xy_se2)},
      {"mean_euclidean_xyz_m", score.xyz_unaligned.mean},
      {"ate_rmse_xyz_m", score.xyz_unaligned.rmse},
      {"ate_rmse_se3_m", RmseOf(score.xyz_se3)},
      {"ate_rmse_sim3_m", RmseOf(score.xyz_sim3)},
      {"sim3_scale", ToJson(score.sim3_scale)},
      {"heading_mean_rad", score.heading_unaligned.mean},
      {"heading_rmse_rad", score.heading_unaligned.rmse},
      {"heading_rmse_se2_rad", RmseOf(score.heading_se2)},
      {"rpe_frame_rmse_m", RmseOf(score.rpe_frame_translation)},
      {"rpe_frame_rmse_rad", RmseOf(score.rpe_frame_rotation)},
      {"rpe_metre_rmse_m", RmseOf(score.rpe_metre_translation)},
      {"rpe_metre_rmse_rad", RmseOf(score.rpe_metre_rotation)},
      {"drift_m_per_s", DriftAt(score.drift_over_time, kMainDriftLagS)},
      {"drift_m_per_m", DriftAt(score.drift_over_path, kMainDriftLengthM)},
      {"reference_poses", score.reference_poses},
      {"estimate_poses", score.estimate_poses},
      {"matched_poses", score.matched_poses},
      {"reference_path_m", score.reference_path_m},
      {"time_coverage", score.time_coverage},
      {"xy",
       {{"unaligned", ToJson(score.xy_unaligned)},
        {"origin", ToJson(score.xy_origin)},
        {"se2", ToJson(score.xy_se2)}}},
      {"xyz",
       {{"unaligned", ToJson(score.xyz_unaligned)},
        {"origin", ToJson(score.xyz_origin)},
        {"se3", ToJson(score.xyz_se3)},
        {"sim3", ToJson(score.xyz_sim3)}}},
      {"rotation_rad",
       {{"unaligned", ToJson(score.rotation_unaligned)}, {"se3", ToJson(score.rotation_se3)}}},
      {"heading_rad",
       {{"unaligned", ToJson(score.heading_unaligned)}, {"se2", ToJson(score.heading_se2)}}},
      {"rpe",
       {{"frame_m", ToJson(score.rpe_frame_translation)},
        {"frame_rad", ToJson(score.rpe_frame_rotation)},
        {"metre_m", ToJson(score.rpe_metre_translation)},
        {"metre_rad", ToJson(score.rpe_metre_rotation)}}},
      {"drift",
       {{"over_time", ToJson(score.drift_over_time, "s")},
        {"over_path", ToJson(score.drift_over_path, "m")}}},
  };
  if (score.by_row) json["paired_by"] = "row";
  return json;
}

Json ToJson(const WallDistanceScore& score) {
  return {{"f1_5cm", ToJson(score.f1_5cm)},
          {"f1_10cm", ToJson(score.f1_10cm)},
          {"chamfer_m", ToJson(score.chamfer_m)},
          {"estimate_to_truth_m", ToJson(score.estimate_to_truth_m)},
          {"truth_to_estimate_m", ToJson(score.truth_to_estimate_m)},
          {"hausdorff95_m", ToJson(score.hausdorff95_m)}};
}

Json Registered(const MapQuality& quality) {
  if (!quality.registration || !quality.registered) return nullptr;
  const Pose2& motion = quality.registration->truth_from_estimate;
  Json json = {{"x_m", motion.x_m},
               {"y_m", motion.y_m},
               {"yaw_rad", motion.yaw_rad},
               {"mean_shift_m", quality.registration->mean_shift_m}};
  json.update(ToJson(*quality.registered));
  return json;
}

Json ToJson(const std::optional<WallThickness>& thickness) {
  if (!thickness) return nullptr;
  return {{"mean_m", thickness->mean_m}, {"p95_m", thickness->p95_m}};
}

Json ToJson(const std::optional<Calibration>& calibration) {
  if (!calibration) return nullptr;
  Json bins = Json::array();
  for (const ReliabilityBin& bin : calibration->bins) {
    bins.push_back({{"cells", bin.cells},
                    {"mean_prob", bin.mean_prob},
                    {"occupied_share", bin.occupied_share}});
  }
  return {{"cells", calibration->cells},
          {"brier", calibration->brier},
          {"log_loss", calibration->log_loss},
          {"calibration_error", calibration->calibration_error},
          {"reliability", bins}};
}

Json ToJson(const TruthlessScore& score) {
  return {{"occupied_share", ToJson(score.occupied_share)},
          {"corners", score.corners},
          {"enclosed_areas", score.enclosed_areas}};
}

Json ToJson(const std::optional<Navigability>& score) {
  if (!score) return nullptr;
  return {{"success_rate", score->success_rate},
          {"falsely_blocked_rate", score->falsely_blocked_rate},
          {"collision_rate", ToJson(score->collision_rate)},
          {"length_ratio", ToJson(score->length_ratio)},
          {"pairs", score->pairs},
          {"planned", score->planned},
          {"collisions", score->collisions}};
}

void AddQuality(const MapQuality& quality, Json& json) {
  json["walls"] = ToJson(quality.walls);
  json["registered"] = Registered(quality);
  json["wall_thickness"] = ToJson(quality.thickness);
  json["true_wall_thickness"] = ToJson(quality.true_thickness);
  json["double_wall_rate"] = ToJson(quality.double_wall_rate);
  json["calibration"] = ToJson(quality.calibration);
  json["ssim"] = ToJson(quality.ssim);
  json["truthless"] = ToJson(quality.truthless);
  json["truthless_of_truth"] = ToJson(quality.truthless_of_truth);
  json["navigability"] = ToJson(quality.navigability);
}

Json ToJson(const MapScore& score) {
  const CellScores& headline = score.observable ? *score.observable : score.all;
  Json json;
  json["chamfer_m"] = ToJson(headline.chamfer_m);
  json["hausdorff95_m"] = ToJson(headline.hausdorff95_m);
  json["coverage"] = ToJson(headline.coverage);
  json["tolerance_cells"] = kDefaultToleranceCells;
  if (score.compared_cell_m) json["compared_cell_m"] = *score.compared_cell_m;
  if (score.observable) json["observable"] = ToJson(*score.observable);
  json["all"] = ToJson(score.all);
  if (score.quality) AddQuality(*score.quality, json);
  return json;
}

// Per degree of freedom; `low` to `high` is the 95 % interval of the mean.
Json ToJson(const std::optional<Consistency>& consistency) {
  const auto value = [&](double Consistency::*member) {
    return consistency ? Json((*consistency).*member) : Json(nullptr);
  };
  return {{"mean", value(&Consistency::mean)},
          {"low", value(&Consistency::low)},
          {"high", value(&Consistency::high)},
          {"within_95", value(&Consistency::share_within_95)},
          {"samples", consistency ? consistency->count : 0}};
}

}  // namespace

std::string MetricsJson(const std::vector<NamedTrajectoryScore>& trajectories, const MapScore* map,
                        const ConsistencyScores* consistency) {
  Json json;
  for (const auto& [name, score] : trajectories) {
    json["trajectory"][name] = score ? ToJson(*score) : Json(nullptr);
  }
  if (map != nullptr) json["map"] = ToJson(*map);
  if (consistency != nullptr) {
    json["consistency"]["nis"] = ToJson(consistency->nis);
    json["consistency"]["nees"] = ToJson(consistency->nees);
  }
  return json.dump(2) + "\n";
}

}  // namespace depthgrid
