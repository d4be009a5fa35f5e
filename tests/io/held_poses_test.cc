#include "mapper/io/held_poses.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "mapper/core/rng.h"
#include "mapper/io/carmen_log.h"
#include "mapper/io/file.h"
#include "tests/io/held_room.h"
#include "tests/scratch.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

int CountHeldScans(const HeldPoses& poses) {
  return static_cast<int>(std::count(poses.held().begin(), poses.held().end(), true));
}

// Stands for 20 scans, drives for 40, and its odometry stops at scan `stalled`. `before`: of
// another place, where it was before.
HeldPoses Drive(int stalled, double sigma_m, bool before = false) {
  RandomStream random(7, RandomStage::kTest);
  HeldPoses poses;
  const Pose2 elsewhere{0.5, 0.0, 0.0};
  if (before) poses.Add({-1.0, elsewhere}, RoomReadings(elsewhere, sigma_m, random), 0.1, 80.0);
  for (int i = 0; i < 60; ++i) {
    const Pose2 truth{0.05 * std::max(0, i - 20), 0.0, 0.005 * std::max(0, i - 20)};
    const Pose2 told{0.05 * std::max(0, std::min(i, stalled) - 20), 0.0, 0.0};
    poses.Add({0.1 * i, told}, RoomReadings(truth, sigma_m, random), 0.1, 80.0);
  }
  return poses;
}

TEST(HeldPoses, AreThoseThatStayWhileTheScansMove) {
  for (const double sigma_m : {0.0, 0.03}) {
    const HeldPoses poses = Drive(30, sigma_m);
    for (int i = 0; i < 60; ++i) {
      // The scan at which they stopped is right; the next ones lie within noise.
      const bool held = poses.held()[static_cast<std::size_t>(i)];
      if (i <= 30) {
        EXPECT_FALSE(held) << i << " " << sigma_m;
      } else if (i > 34) {
        EXPECT_TRUE(held) << i << " " << sigma_m;
      }
    }
    EXPECT_GE(CountHeldScans(poses), 25) << sigma_m;
  }
}

TEST(HeldPoses, ARobotThatStandsHoldsNone) {
  for (const double sigma_m : {0.0, 0.03, 0.1})
    EXPECT_EQ(CountHeldScans(Drive(60, sigma_m)), 0) << sigma_m;
}

// Standing for long with the odometry stopped: only what was driven is held.
TEST(HeldPoses, WhatStoodIsNotHeld) {
  const HeldPoses poses = Drive(0, 0.01, true);
  for (int i = 0; i <= 21; ++i) EXPECT_FALSE(poses.held()[static_cast<std::size_t>(i)]) << i;
  EXPECT_GE(CountHeldScans(poses), 35);
}

// Stands among people who come after two seconds and hide most of the room.
TEST(HeldPoses, PeopleDoNotMoveARobotThatStood) {
  RandomStream random(7, RandomStage::kTest);
  HeldPoses poses;
  poses.Add({-1.0, {0.5, 0.0, 0.0}}, RoomReadings({0.5, 0.0, 0.0}, 0.01, random), 0.1, 80.0);
  for (int i = 0; i < 60; ++i) {
    std::vector<double> range_m = RoomReadings({}, 0.01, random);
    for (std::size_t k = 0; i > 20 && k < range_m.size(); ++k) {
      if (k % 4 != 0) range_m[k] *= 0.5;
    }
    poses.Add({0.1 * i, {}}, std::move(range_m), 0.1, 80.0);
  }
  EXPECT_EQ(CountHeldScans(poses), 0);
}

// A log without odometry.
TEST(HeldPoses, PosesThatNeverMoveAreNoOdometry) { EXPECT_EQ(CountHeldScans(Drive(0, 0.01)), 0); }

// A log, of which a part is mapped: frames are counted as in the whole.
TEST(HeldPoses, OfALogHaveNoPose) {
  RandomStream random(7, RandomStage::kTest);
  std::string log;
  for (int i = 0; i < 60; ++i) {
    log +=
        RoomLine({0.05 * i, 0.0, 0.0}, {0.05 * std::min(i, 40), 0.0, 0.0}, 10.0 + 0.1 * i, random);
  }
  const std::string path = ScratchPath() + ".log";
  WriteFile(path, log);
  const CarmenLog opened = OpenCarmenLog(path, {}, {}, {.from_s = 2.0, .to_s = 5.7});
  int posed = 0, held = 0;
  while (const auto frame = opened.source->Next()) {
    if (frame->index <= 40) {
      EXPECT_TRUE(frame->slam_from_camera) << frame->index;
    } else if (frame->index > 44) {
      EXPECT_FALSE(frame->slam_from_camera) << frame->index;
    }
    ++(frame->slam_from_camera ? posed : held);
  }
  EXPECT_GE(posed, 21);
  EXPECT_GE(held, 13);
  EXPECT_THAT(opened.source->Warnings(),
              ElementsAre(AllOf(HasSubstr("the odometry gives one pose again and again"),
                                HasSubstr(fmt::format("first in frame {}", 20 + posed)),
                                HasSubstr(fmt::format("{} frames are taken for lost", held)))));
  std::filesystem::remove(path);
}

// Few readings, and those without a return, tell nothing.
TEST(HeldPoses, ScansThatSeeNothingTellNothing) {
  HeldPoses poses;
  for (int i = 0; i < 20; ++i) {
    std::vector<double> range_m(180, 81.9 + i);
    range_m[3] = 1.0 + i;
    poses.Add({0.1 * i, {}}, range_m, 0.1, 80.0);
  }
  EXPECT_EQ(CountHeldScans(poses), 0);
}

}  // namespace
}  // namespace depthgrid
