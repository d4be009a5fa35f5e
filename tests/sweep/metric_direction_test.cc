// What is wanted of each score that a sweep has.
#include "eval/statistics/metric_direction.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "eval/output/run_folder.h"
#include "eval/statistics/score_names.h"
#include "eval/sweep/sweep_metrics.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;

std::string AimOf(const std::string& metric) {
  if (const auto target = TargetOf(metric)) {
    EXPECT_EQ(BetterOf(metric), Better::kLower) << metric;
    return fmt::format("{}", *target);
  }
  const Better better = BetterOf(metric);
  return better == Better::kLower ? "lower" : better == Better::kHigher ? "higher" : "neither";
}

TEST(MetricDirection, OfEveryScoreOfASweep) {
  std::map<std::string, std::vector<std::string>> by_aim;
  for (const std::string& metric : SweepMetricNames()) {
    // Three trajectories, and cells of two kinds, are named alike.
    if (metric.starts_with("trajectory.slam") || metric.starts_with("trajectory.online")) continue;
    if (metric.starts_with("map.all.")) continue;
    by_aim[AimOf(metric)].push_back(metric);
  }
  EXPECT_THAT(by_aim["0"],
              ElementsAre("map.registered.x_m", "map.registered.y_m", "map.registered.yaw_rad"));
  EXPECT_THAT(by_aim["0.95"],
              ElementsAre("consistency.nis.within_95", "consistency.nees.within_95"));
  EXPECT_THAT(by_aim["1"], ElementsAre("trajectory.est.sim3_scale", "map.navigability.length_ratio",
                                       "consistency.nis.mean", "consistency.nees.mean"));
  EXPECT_THAT(by_aim["neither"],
              ElementsAre("trajectory.est.reference_path_m", "map.wall_thickness.mean_m",
                          "map.wall_thickness.p95_m", "map.true_wall_thickness.mean_m",
                          "map.true_wall_thickness.p95_m", "map.calibration.cells",
                          "map.truthless.occupied_share", "map.truthless.corners",
                          "map.truthless.enclosed_areas", "map.truthless_of_truth.occupied_share",
                          "map.truthless_of_truth.corners", "map.truthless_of_truth.enclosed_areas",
                          "map.navigability.pairs", "map.navigability.planned",
                          "map.navigability.collisions"));
  for (const std::string& metric : by_aim["higher"]) {
    EXPECT_THAT(metric, testing::ContainsRegex(
                            "precision$|recall$|f1|iou$|mcc$|coverage$|ssim$|success_rate$"));
  }
  for (const std::string& metric : by_aim["lower"]) {
    EXPECT_THAT(metric, testing::ContainsRegex("_m$|_rad$|_rate$|_error$|brier$|log_loss$|_per_s$"))
        << metric;
  }
  EXPECT_GT(by_aim["higher"].size() + by_aim["lower"].size(), 35U);
}

TEST(MetricDirection, IsOfWholeWords) {
  EXPECT_EQ(BetterOf("map.occupied.iou"), Better::kHigher);
  EXPECT_EQ(BetterOf("map.iou_of_rooms"), Better::kHigher);
  EXPECT_EQ(BetterOf("map.walls_of_previous_run_m"), Better::kLower);  // "iou"
  EXPECT_EQ(BetterOf("map.inaccuracy"), Better::kLower);
  EXPECT_EQ(BetterOf("map.wall_thickness.mean_m"), Better::kNeither);
  EXPECT_EQ(BetterOf("map.wall_thickness_error.mean_m"), Better::kLower);
}

// Keys of what a metrics.json has besides columns; a score that should be one needs another name.
void CollectBreakdowns(const nlohmann::json& json, const std::string& path,
                       std::set<std::string>& keys) {
  for (const auto& [key, value] : json.items()) {
    const std::string name = path.empty() ? key : path + "." + key;
    if (IsBreakdown(name)) {
      keys.insert(key);
    } else if (value.is_object()) {
      CollectBreakdowns(value, name, keys);
    }
  }
}

std::set<std::string> AsSet(const NamedValues& values) {
  std::set<std::string> names;
  for (const auto& [name, value] : values) names.insert(name);
  return names;
}

TEST(ScoreNames, WhatIsNoColumn) {
  std::set<std::string> keys;
  CollectBreakdowns(nlohmann::json::parse(MetricsOf(FullScores())), "", keys);
  EXPECT_THAT(keys, ElementsAre("confusion", "drift", "estimate_poses", "estimated_cells",
                                "found_cells", "heading_rad", "high", "low", "matched_poses",
                                "reference_poses", "right_cells", "rotation_rad", "rpe", "samples",
                                "scored_cells", "tolerance_0", "tolerance_2", "tolerance_cells",
                                "true_cells", "xy", "xyz"));
  EXPECT_FALSE(IsBreakdown("map.walls.low"));  // of consistency alone
}

// Of a map that shows nothing they are null, which makes no column of the group's name.
TEST(ScoreNames, GroupsThatAreNotThereAreNoColumns) {
  const std::set<std::string> all = AsSet(SweepMetrics(FullScores()));
  for (const std::string& name : AsSet(SweepMetrics(RunScores{}))) {
    EXPECT_TRUE(all.contains(name)) << name;
  }
}

TEST(ScoreNames, ThoseThatComeFirstAreColumns) {
  const std::vector<std::string> names = SweepMetricNames();
  for (const auto& list : {ScoresOfASweepsPage(), ScoresToCompare(), ScoresOfAnAblation()}) {
    for (const std::string_view score : list) {
      EXPECT_THAT(names, testing::Contains(std::string(score)));
    }
  }
}

}  // namespace
}  // namespace depthgrid
