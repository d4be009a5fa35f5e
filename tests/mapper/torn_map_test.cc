// Maps of two parts, each right in itself, of which the second one lies wrong.
#include "mapper/torn_map.h"

#include <gtest/gtest.h>

#include "mapper/graph/place.h"
#include "tests/mapper/mapped_frame.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

// Sees one or two walls at a time.
constexpr PlanarLaser kTornLaser{
    .beams = 160, .field_of_view_rad = RadFromDeg(60), .max_range_m = 4.0, .sigma_of_range = 0.01};
constexpr int kTornAt = 120, kBlind = 20, kTornFrames = 280;

PlanarWorld TornRoom() {
  PlanarWorld world = RectangleWorld(0.0, 0.0, 8.0, 6.0);
  AddRectangle(world, 6.6, 0.0, 7.4, 0.5);
  AddRectangle(world, 0.0, 2.2, 0.4, 3.7);
  AddRectangle(world, 3.0, 5.6, 4.3, 6.0);
  return world;
}

// Round in the room and back, with a stretch in between of which no match tells the position. All
// after it lies `error` (map axes) wrong.
std::vector<MappedFrame> Torn(const PlanarWorld& world, const Pose2& error) {
  std::vector<MappedFrame> frames;
  for (int i = 0; i < kTornFrames; ++i) {
    const double turned = 2.0 * kPi / 120.0 * i;
    const Pose2 truth{4.0 + 1.5 * std::cos(turned), 3.0 + std::sin(turned),
                      WrapAngle(turned + 0.3 * std::sin(3.0 * turned))};
    const bool lies_wrong = i >= kTornAt + kBlind;
    MappedFrame frame =
        MappedFrameAt(world, kTornLaser, truth, lies_wrong ? error * truth : truth, i);
    frame.match.found = i < kTornAt || lies_wrong;
    frame.match.map_from_base = frame.map_from_base;
    frame.match.information = Eigen::Vector3d(1e5, 1e5, 1e7).asDiagonal();
    frames.push_back(frame);
  }
  return frames;
}

std::vector<Mending> Mendings(const std::vector<MappedFrame>& frames,
                              const std::vector<GuessedPart>& guessed = {}) {
  return MendingsOf(frames, {}, {}, guessed);
}

TEST(TornMap, IsMendedByMovingTheLaterPart) {
  const std::vector<MappedFrame> right = Torn(TornRoom(), {});
  for (const Pose2& error :
       {Pose2{0.8, -0.5, 0.0}, Pose2{-0.3, 0.2, 0.08}, Pose2{0.2, 1.2, -0.1}}) {
    const std::vector<MappedFrame> torn = Torn(TornRoom(), error);
    const std::vector<Mending> mendings = Mendings(torn);
    ASSERT_FALSE(mendings.empty()) << error.x_m;
    for (const Mending& mending : mendings) {
      EXPECT_LT(mending.loop.first, kTornAt);
      EXPECT_GE(mending.loop.second, kTornAt + kBlind);
      const Pose2 off =
          Between(Between(PoseAt(right, mending.loop.first), PoseAt(right, mending.loop.second)),
                  mending.loop.first_from_second);
      EXPECT_LT(off.translation().norm(), 0.03) << error.x_m;
      EXPECT_LT(std::abs(off.yaw_rad), RadFromDeg(0.5)) << error.x_m;
      for (int i = 0; i < kTornAt; ++i) {
        const Pose2 moved = mending.map_from_base[static_cast<std::size_t>(i)];
        EXPECT_FALSE(AreApart(PoseAt(torn, i), moved, 1e-3, 1e-4)) << i;
      }
      for (int i = kTornAt + kBlind; i < kTornFrames; ++i) {
        const Pose2 moved = mending.map_from_base[static_cast<std::size_t>(i)];
        EXPECT_FALSE(AreApart(PoseAt(right, i), moved, 0.05, RadFromDeg(0.5))) << i;
      }
    }
  }
}

// In between, ever more of the way, without a jump.
TEST(TornMap, WhatLiesWithinTheTearMovesInPart) {
  const std::vector<MappedFrame> torn = Torn(TornRoom(), {0.8, -0.5, 0.0});
  const std::vector<Mending> mendings = Mendings(torn);
  ASSERT_FALSE(mendings.empty());
  const auto moved_m = [&](int i) {
    const Pose2& moved = mendings.front().map_from_base[static_cast<std::size_t>(i)];
    return (moved.translation() - PoseAt(torn, i).translation()).norm();
  };
  for (int i = kTornAt; i < kTornAt + kBlind; ++i) {
    EXPECT_GE(moved_m(i + 1), moved_m(i)) << i;
    EXPECT_LT(moved_m(i + 1) - moved_m(i), 0.3 * moved_m(kTornFrames - 1)) << i;
  }
}

TEST(TornMap, IsNoneIfThePartsAgree) {
  EXPECT_TRUE(Mendings(Torn(TornRoom(), {})).empty());
  EXPECT_TRUE(Mendings(Torn(TornRoom(), {0.02, 0.0, 0.0})).empty());
  EXPECT_TRUE(Mendings({}).empty());
}

// After a loss whose place was not found the later part may lie anywhere.
TEST(TornMap, IsNotMendedWhereAPlaceWasGuessed) {
  const std::vector<MappedFrame> torn = Torn(TornRoom(), {0.8, -0.5, 0.0});
  EXPECT_TRUE(Mendings(torn, {{kTornAt + kBlind, kTornFrames}}).empty());
  EXPECT_FALSE(Mendings(torn, {{0, kTornFrames}}).empty());
}

TEST(TornMap, OfAPriorMapIsLeftAsItIs) {
  std::vector<MappedFrame> torn = Torn(TornRoom(), {0.8, -0.5, 0.0});
  for (MappedFrame& frame : torn) frame.frame -= kTornFrames;
  EXPECT_TRUE(Mendings(torn).empty());
  // What was mapped since moves alone, even if the prior map ends with frames that tell nothing.
  for (int i = 0; i < kTornFrames; ++i) {
    MappedFrame& frame = torn[static_cast<std::size_t>(i)];
    frame.frame = i < kTornAt ? i - kTornAt : i;
    if (i >= kTornAt - 10 && i < kTornAt) frame.match.found = false;
  }
  const std::vector<Mending> mendings = Mendings(torn);
  ASSERT_FALSE(mendings.empty());
  for (int i = 0; i < kTornAt; ++i) {
    const Pose2& moved = mendings.front().map_from_base[static_cast<std::size_t>(i)];
    EXPECT_FALSE(AreApart(moved, PoseAt(torn, i), 1e-9, 1e-9)) << i;
  }
}

// Between bare walls all places along them fit.
TEST(TornMap, IsNotMendedWhereManyPlacesFit) {
  const PlanarWorld corridor = {{{-100.0, 0.0}, {100.0, 0.0}}, {{-100.0, 6.0}, {100.0, 6.0}}};
  EXPECT_TRUE(Mendings(Torn(corridor, {0.3, 0.6, 0.0})).empty());
}

}  // namespace
}  // namespace depthgrid
