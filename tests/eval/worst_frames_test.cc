#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "eval/output/run_tables.h"
#include "eval/report/frame_reference.h"
#include "eval/report/match_surface.h"
#include "eval/report/worst_frames_impl.h"
#include "mapper/core/level.h"
#include "mapper/core/rng.h"
#include "mapper/io/file.h"
#include "mapper/match/bicubic.h"
#include "tests/scratch.h"

namespace depthgrid {
namespace {

// A wall along x at y = 2 m, as long as the map is wide, and if wanted one along y at x = 2 m.
OccupancyMap Walls(bool corner) {
  OccupancyMap map({0.05, {-60, -60}, 120, 120});
  std::fill(map.occupied_prob.begin(), map.occupied_prob.end(), 0.1F);
  for (int i = -60; i < 60; ++i) {
    map.occupied_prob[map.geometry.Index({i, 40})] = 0.9F;
    if (corner) map.occupied_prob[map.geometry.Index({40, i})] = 0.9F;
  }
  return map;
}

// What is seen of it from the origin: the middles of its cells.
MatchPoints PointsOf(bool corner) {
  MatchPoints points;
  for (int i = -10; i <= 10; ++i) {
    points.x_m.push_back(0.1F * static_cast<float>(i));
    points.y_m.push_back(2.025F);
    if (!corner) continue;
    points.x_m.push_back(2.025F);
    points.y_m.push_back(0.1F * static_cast<float>(i));
  }
  points.farthest_m = 2.3F;
  return points;
}

TEST(MatchSurface, IsLowestAtTheTruePose) {
  const OccupancyMap map = Walls(true);
  // Seen from 3 cm to the right of the truth and 2 cm below it, turned by one step of yaw.
  const MatchSurfaceOptions options;
  const Pose2 shifted = {0.03, -0.02, 0.0};
  const MatchSurface surface = MatchSurfaceAround(PointsOf(true), ViewOf(map), shifted, options);
  ASSERT_EQ(surface.half_steps, 20);
  ASSERT_EQ(surface.residual.size(), 41U * 41U);
  const auto best = std::min_element(surface.residual.begin(), surface.residual.end());
  const auto index = best - surface.residual.begin();
  EXPECT_EQ(index % 41 - 20, -3);
  EXPECT_EQ(index / 41 - 20, 2);
  EXPECT_NEAR(*best, 0.1, 1e-3);  // 1 - 0.9

  const MatchSurface turned = MatchSurfaceAround(PointsOf(true), ViewOf(map),
                                                 {0.0, 0.0, 2 * options.yaw_step_rad}, options);
  const auto least = std::min_element(turned.yaw_residual.begin(), turned.yaw_residual.end());
  EXPECT_EQ(least - turned.yaw_residual.begin(), 20 - 2);
}

TEST(MatchSurface, IsFlatAlongASingleWall) {
  const OccupancyMap map = Walls(false);
  const MatchSurface surface = MatchSurfaceAround(PointsOf(false), ViewOf(map), {}, {});
  for (int x = 0; x < 41; ++x) {
    EXPECT_NEAR(surface.residual[20 * 41 + static_cast<std::size_t>(x)], 0.1, 1e-3);
    EXPECT_GT(surface.residual[static_cast<std::size_t>(x)], 0.5);  // 20 cm beside the wall
  }
}

// Random cells, beyond whose edge some of the points lie.
TEST(MatchSurface, IsTheCostAtEachOffset) {
  RandomStream random(31, RandomStage::kTest);
  OccupancyMap map({0.05, {-30, -29}, 60, 57});
  for (float& prob : map.occupied_prob) prob = static_cast<float>(random.Uniform(0.0, 1.0));
  const MatchPoints points = PointsOf(true);
  const Pose2 pose = {-1.02, -1.31, 0.013};
  const MatchSurface surface = MatchSurfaceAround(points, ViewOf(map), pose, {});
  ASSERT_EQ(surface.residual.size(), 41U * 41U);
  for (int y = -20; y <= 20; ++y) {
    for (int x = -20; x <= 20; ++x) {
      const Pose2 moved = {pose.x_m + 0.01 * x, pose.y_m + 0.01 * y, pose.yaw_rad};
      double sum = 0.0;
      for (std::size_t i = 0; i < points.x_m.size(); ++i) {
        const double value =
            BicubicValue(ViewOf(map), moved * Eigen::Vector2d(points.x_m[i], points.y_m[i]));
        sum += (1.0 - value) * (1.0 - value);
      }
      EXPECT_NEAR(surface.residual[static_cast<std::size_t>((y + 20) * 41 + x + 20)],
                  std::sqrt(sum / static_cast<double>(points.x_m.size())), 1e-9);
    }
  }
  // The middle of the rotations is the middle of the offsets.
  EXPECT_NEAR(surface.yaw_residual[20], surface.residual[20 * 41 + 20], 1e-9);
  const auto [least, most] = std::minmax_element(surface.residual.begin(), surface.residual.end());
  EXPECT_GT(*most - *least, 0.02);
}

TEST(WorstRows, AreTheLargestApartFromEachOther) {
  std::vector<double> badness(200, 0.0);
  badness[50] = 5.0;
  badness[52] = 4.9;  // nearer than 200 / 50 rows to a worse one
  badness[54] = 4.8;
  badness[120] = std::numeric_limits<double>::quiet_NaN();
  badness[130] = 9.0;
  const std::vector<std::size_t> rows = WorstRows(badness);
  ASSERT_EQ(rows.size(), 10U);
  EXPECT_EQ(rows[0], 130U);
  EXPECT_EQ(rows[1], 50U);
  EXPECT_EQ(rows[2], 54U);
  EXPECT_EQ(std::count(rows.begin(), rows.end(), 120U), 0);
}

// Three rows of frames.csv: one without a match, one with, one that closed a loop.
CsvTable Frames() {
  const double none = std::numeric_limits<double>::quiet_NaN();
  CsvTable frames;
  frames.rows = 3;
  frames.columns = {{"frame", {0, 1, 2}},
                    {"map_x_m", {0.0, 1.0, 2.0}},
                    {"map_y_m", {0.0, 0.0, 0.0}},
                    {"map_yaw_rad", {0.0, 0.0, 0.0}},
                    {"innovation_forward_m", {none, 0.04, 0.0}},
                    {"innovation_left_m", {none, -0.02, 0.0}},
                    {"innovation_yaw_rad", {none, 0.0, 0.0}},
                    {"gain_forward", {none, 0.25, 0.5}},
                    {"gain_left", {none, 0.5, 0.5}},
                    {"gain_yaw", {none, 0.5, 0.5}},
                    {"loops_accepted", {0, 0, 1}}};
  return frames;
}

TEST(FrameAtRow, UndoesTheFusion) {
  const auto first = FrameAtRow(Frames(), 0);
  ASSERT_TRUE(first);
  EXPECT_FALSE(first->predicted_map_from_base);
  const auto second = FrameAtRow(Frames(), 1);
  ASSERT_TRUE(second && second->predicted_map_from_base);
  // A quarter of 4 cm forward and half of 2 cm to the right were taken.
  EXPECT_NEAR(second->predicted_map_from_base->x_m, 0.99, 1e-12);
  EXPECT_NEAR(second->predicted_map_from_base->y_m, 0.01, 1e-12);
  EXPECT_NEAR(second->matched_map_from_base->x_m, 1.03, 1e-12);
  EXPECT_NEAR(second->matched_map_from_base->y_m, -0.01, 1e-12);
}

// A full gain, as Kalman's is: nothing of it is undone, the table has the match itself.
TEST(FrameAtRow, TakesTheMatchOfTheTable) {
  CsvTable frames = Frames();
  const double none = std::numeric_limits<double>::quiet_NaN();
  frames.columns["match_x_m"] = {none, 1.2, 2.0};
  frames.columns["match_y_m"] = {none, 0.1, 0.0};
  frames.columns["match_yaw_rad"] = {none, 0.0, 0.0};
  EXPECT_FALSE(FrameAtRow(frames, 0)->matched_map_from_base);
  const auto second = FrameAtRow(frames, 1);
  ASSERT_TRUE(second && second->predicted_map_from_base);
  EXPECT_EQ(*second->matched_map_from_base, Pose2(1.2, 0.1, 0.0));
  EXPECT_NEAR(second->predicted_map_from_base->x_m, 1.16, 1e-12);
  EXPECT_NEAR(second->predicted_map_from_base->y_m, 0.12, 1e-12);
}

// As a run writes it.
TEST(FrameAtRow, ReadsTheMatchBack) {
  const Pose2 predicted{1.0, -0.5, 2.0};
  const Pose2 matched{1.03, -0.52, 2.01};
  MappingRun run;
  run.reports.resize(1);
  FrameReport& report = run.reports.front();
  report.map_from_camera = CameraOf(Pose2{1.02, -0.51, 2.004}, 1.0);
  report.match.found = true;
  report.match.map_from_base = matched;
  const Eigen::Vector3d innovation = Between(predicted, matched).vector();
  report.innovation = {innovation.x(), innovation.y(), innovation.z()};
  report.gain = {0.9, 0.1, 0.2};
  const std::string path = ScratchPath();
  WriteFile(path, FramesCsv(run, nullptr));
  const auto frame = FrameAtRow(ReadCsv(path), 0);
  std::filesystem::remove(path);
  ASSERT_TRUE(frame && frame->predicted_map_from_base);
  EXPECT_EQ(*frame->matched_map_from_base, matched);
  EXPECT_LT((frame->predicted_map_from_base->vector() - predicted.vector()).norm(), 1e-12);
}

Scan OneHit() {
  return {.beams = {{.range_m = 1.01F, .clear_to_m = 1.0F, .hit = true}}, .max_range_m = 5.0};
}

TEST(ReferenceOf, HoldsTheScansBeforeAtTheirPosesOfTheTime) {
  RunFiles run;
  run.frames = Frames();
  ScanArchive archive;
  for (int i = 0; i < 3; ++i) {
    run.scans.push_back({i, 0.1 * i, {5.0 + 2.0 * i, 3.0, 0.0}, archive.Keep(OneHit())});
  }
  EXPECT_EQ(ReferenceOf(run, 0, {}, {}).geometry.size(), 0U);
  // The first scan lay at the origin then, wherever it lies in the end.
  const OccupancyMap second = ReferenceOf(run, 1, {}, {});
  EXPECT_GT(second.At({20, 0}), 0.5F);
  EXPECT_TRUE(std::isnan(second.At({40, 0})));
  // With a loop in between: as in the finished map, the third scan where it lay then, at x = 2 m.
  const OccupancyMap third = ReferenceOf(run, 2, {}, {});
  EXPECT_GT(third.At({-20, 0}), 0.5F);
  EXPECT_GT(third.At({20, 0}), 0.5F);
  EXPECT_TRUE(std::isnan(third.At({40, 0})));
}

// Of a map that the run went on in no row tells; its scans lie where they lie in the end.
TEST(ReferenceOf, HoldsTheMapThatTheRunWentOnIn) {
  RunFiles run;
  run.frames = Frames();
  run.frames.columns["loops_accepted"] = {0, 0, 0};
  run.prior_scans = 2;
  ScanArchive archive;
  for (int i = -2; i < 3; ++i) {
    run.scans.push_back({i, 0.1 * i, {0.0, i < 0 ? 1.0 : 5.0, 0.0}, archive.Keep(OneHit())});
  }
  EXPECT_EQ(ReferenceOf(run, 1, {}, {}).geometry.size(), 0U);
  EXPECT_GT(ReferenceOf(run, 2, {}, {}).At({20, 20}), 0.5F);
  const OccupancyMap second = ReferenceOf(run, 3, {}, {});
  EXPECT_GT(second.At({20, 20}), 0.5F);
  EXPECT_GT(second.At({20, 0}), 0.5F);  // the run's own first scan, where it lay then
}

// Poses a hundred kilometres apart: the map is as small as one of a camera that stood still.
TEST(ReferenceOf, HoldsOnlyTheSurroundings) {
  RunFiles run;
  run.frames = Frames();
  run.frames.columns["loops_accepted"] = {0, 0, 0};
  run.frames.columns["map_x_m"] = {1e5, 0.0, 0.0};
  ScanArchive archive;
  for (int i = 0; i < 3; ++i) run.scans.push_back({i, 0.1 * i, {}, archive.Keep(OneHit())});
  const OccupancyMap second = ReferenceOf(run, 1, {}, {});
  EXPECT_GT(second.geometry.size(), 0U);
  for (const float prob : second.occupied_prob) EXPECT_TRUE(std::isnan(prob));
  const OccupancyMap third = ReferenceOf(run, 2, {}, {});
  EXPECT_GT(third.At({20, 0}), 0.5F);
  EXPECT_LT(third.geometry.width_cells, 1000);
  // Where no run is there is no pose.
  run.frames.columns["map_x_m"] = {0.0, 1e20, 0.0};
  EXPECT_EQ(ReferenceOf(run, 1, {}, {}).geometry.size(), 0U);
  EXPECT_GT(ReferenceOf(run, 2, {}, {}).At({20, 0}), 0.5F);
  // The scans far away still count: a submap of two scans is over after them.
  run.frames.columns["map_x_m"] = {0.0, 1e5, 0.0};
  EXPECT_GT(ReferenceOf(run, 2, {}, {.scans = 2}).At({20, 0}), 0.5F);
}

}  // namespace
}  // namespace depthgrid
