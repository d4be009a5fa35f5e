#include "eval/doubts/place_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/kept_scan.h"
#include "mapper/core/level.h"

namespace depthgrid {
namespace {

// So many frames, each of which the map explains so much.
MappingRun RunOf(int frames, double explained) {
  MappingRun run;
  for (int i = 0; i < frames; ++i) {
    FrameReport report;
    report.index = i;
    report.beams = 600;
    report.map_from_camera = CameraOf({}, 1.0);
    report.match.found = true;
    report.match.score = explained;
    run.reports.push_back(report);
  }
  return run;
}

TEST(FramesLost, AreThoseOfWhichTheMapExplainsNextToNothing) {
  MappingRun run = RunOf(20, 0.6);
  EXPECT_FALSE(FramesLost(run, true));
  run.reports[7].match.found = false;
  EXPECT_FALSE(FramesLost(run, true));  // a single one happens
  run.reports[8].match.score = 0.05;
  const auto lost = FramesLost(run, true);
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->lost, 2);
  EXPECT_EQ(lost->frames, 20);
  EXPECT_FALSE(FramesLost(run, false));  // the first fits; the others may lie on new walls
}

TEST(FramesLost, SayWhichFramesTheyWereCountedAmong) {
  const MappingRun run = RunOf(20, 0.05);
  EXPECT_THAT(
      TextOf(*FramesLost(run, true)),
      testing::StartsWith("lost: in 20 of the 20 frames that were placed and see something, "
                          "hardly anything that is seen lies on the map; "));
  EXPECT_EQ(
      TextOf(*FramesLost(run, false)),
      "lost: hardly anything that the first frame sees lies on this map, by which alone it was "
      "placed; the sequence is of another place or begins elsewhere in the map");
}

// From frame 60 on; a few lost ones before that were an accident.
TEST(FramesLost, ALongStretchAfterGoodFramesIsWhereTheMapWasLeft) {
  MappingRun run = RunOf(120, 0.6);
  run.reports[20].match.found = run.reports[21].match.found = false;
  for (std::size_t i = 60; i < 90; ++i) run.reports[i].match.score = 0.0;
  EXPECT_EQ(FramesLost(run, true)->left_at, 60);
  for (std::size_t i = 0; i < 12; ++i) run.reports[i].match.score = 0.0;
  EXPECT_FALSE(FramesLost(run, true)->left_at);  // it was hardly ever on it
}

// Out of the map and back: it is of no other place.
TEST(FramesLost, SaysThatItComesBack) {
  MappingRun run = RunOf(200, 0.6);
  for (std::size_t i = 60; i < 100; ++i) run.reports[i].match.score = 0.0;
  const auto lost = FramesLost(run, true);
  ASSERT_TRUE(lost);
  EXPECT_TRUE(lost->comes_back);
  EXPECT_THAT(
      TextOf(*lost),
      testing::EndsWith("; from frame 60 on the sequence leaves the map, where poses are SLAM's "
                        "motion alone (without --localise they extend it), and comes back"));
  run = RunOf(200, 0.6);
  for (std::size_t i = 60; i < 120; i += 2) run.reports[i].match.score = 0.0;
  EXPECT_THAT(TextOf(*FramesLost(run, true)),
              testing::HasSubstr("; in between the sequence leaves the map"));
  run = RunOf(200, 0.6);
  for (std::size_t i = 150; i < 200; ++i) run.reports[i].match.score = 0.0;
  EXPECT_FALSE(FramesLost(run, true)->comes_back);
  EXPECT_THAT(TextOf(*FramesLost(run, true)), testing::EndsWith("or it is of another place"));
}

// What the first views said of the start does not count, nor frames without a scan.
TEST(StartMoved, IsToldOfTheFinalPoseOfTheFirstFrameThatSeesSomething) {
  const Pose2 given = {2.0, 1.0, 0.1};
  MappingRun run = RunOf(3, 0.6);
  run.base_from_laser = {0.2, 0.0, 0.5};
  const auto at = [&](const Pose2& base) { return CameraOf(base * run.base_from_laser, 1.0); };
  run.result.map_from_camera = {at({7.0, 7.0, 0.0}), {}, at({2.03, 1.03, 0.13})};
  run.reports[0].beams = 0;
  EXPECT_FALSE(StartMoved(run, given));
  run.result.map_from_camera[2] = at({2.3, 1.0, 0.1});
  const auto moved = StartMoved(run, given);
  ASSERT_TRUE(moved);
  EXPECT_NEAR(moved->found.x_m, 2.3, 1e-9);
  EXPECT_NEAR(moved->move.translation().norm(), 0.3, 1e-9);
  run.result.map_from_camera[2] = at({2.0, 1.0, 0.2});
  ASSERT_TRUE(StartMoved(run, given));
  EXPECT_NEAR(StartMoved(run, given)->move.yaw_rad, 0.1, 1e-9);
  run.result.map_from_camera[2].reset();
  EXPECT_FALSE(StartMoved(run, given));
}

// A room seen from its middle at every tenth frame, and then another one.
MappingRun TwoRooms(double second_width_m) {
  MappingRun run;
  ScanArchive archive;
  for (int i = -20; i < 20; ++i) {
    Scan scan;
    scan.max_range_m = 8.0;
    for (int k = 0; k < 360; ++k) {
      const double bearing = RadFromDeg(k - 180.0);
      const double half_m = i < 0 ? 2.0 : 0.5 * second_width_m;
      const auto range = static_cast<float>(
          half_m / std::max(std::abs(std::cos(bearing)), std::abs(std::sin(bearing))));
      scan.beams.push_back({static_cast<float>(bearing), range, 0.0F, range, true});
    }
    MappedFrame frame;
    frame.frame = i;
    frame.obstacles = frame.scan = archive.Keep(scan);
    run.result.mapped.push_back(frame);
  }
  return run;
}

TEST(AgreementWithEarlier, IsOfWhatAnExtendedRunShowsOfTheMapBefore) {
  EXPECT_LT(AgreementWithEarlier(TwoRooms(4.0), {}).share_against(), 0.01);
  // Walls where it was free.
  EXPECT_GT(AgreementWithEarlier(TwoRooms(2.5), {}).share_against(), 0.9);
  MappingRun alone = TwoRooms(2.5);
  alone.result.mapped.resize(20);  // nothing was added
  EXPECT_EQ(AgreementWithEarlier(alone, {}).share_against(), 0.0);
}

TEST(FramesLost, WithoutAPoseOrAReturnNothingIsSaid) {
  MappingRun run = RunOf(20, 0.0);
  for (int i = 0; i < 10; ++i) run.reports[static_cast<std::size_t>(i)].map_from_camera.reset();
  for (int i = 10; i < 19; ++i) run.reports[static_cast<std::size_t>(i)].beams = 0;
  EXPECT_EQ(FramesLost(run, true)->frames, 1);
  run.reports.pop_back();
  EXPECT_FALSE(FramesLost(run, true));
}

// A robot that looks along the map's y axis at a wall knows how far off it is, y, and nothing of x.
TEST(SeesAlong, WhatAMatchTellsIsTurnedIntoTheMap) {
  const UnsureAlong x_axis{0.0, 1.0}, y_axis{0.5 * kPi, 1.0}, diagonal{0.25 * kPi, 1.0};
  MappingRun run = RunOf(1, 0.6);
  MatchResult& match = run.reports[0].match;
  match.map_from_base.yaw_rad = 0.5 * kPi;
  match.information.diagonal() << 1e6, 0.0, 1e6;
  EXPECT_TRUE(SeesAlong(run, y_axis));
  EXPECT_FALSE(SeesAlong(run, x_axis));
  EXPECT_FALSE(SeesAlong(run, diagonal));
  // Turned by a twelfth, what lies across the view is at 120 degrees of the map.
  match.map_from_base.yaw_rad = kPi / 6.0;
  EXPECT_TRUE(SeesAlong(run, {kPi / 6.0, 1.0}));
  EXPECT_FALSE(SeesAlong(run, {-kPi / 6.0, 1.0}));
  match.information(1, 1) = 1e6;
  EXPECT_TRUE(SeesAlong(run, x_axis));
  match.score = 0.1;  // a match at a wrong place
  EXPECT_FALSE(SeesAlong(run, y_axis));
}

}  // namespace
}  // namespace depthgrid
