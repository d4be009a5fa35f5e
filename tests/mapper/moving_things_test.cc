#include <gtest/gtest.h>

#include "mapper/surfel/range_noise.h"
#include "mapper/surfel/scan_surfels.h"
#include "mapper/surfel/surfel_matcher.h"
#include "mapper/surfel/surfel_store.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

PlanarWorld RoomWith(double person_x_m) {
  PlanarWorld walls = RectangleWorld(-2.0, -2.5, 3.0, 2.5);
  for (const Wall& side : RectangleWorld(person_x_m, -0.3, person_x_m + 0.4, 0.3)) {
    walls.push_back(side);
  }
  return walls;
}

// Somebody a metre ahead takes up half of the view and steps back by 6 cm: the error of a match
// after so many frames, for most of which nobody is there.
double ErrorBeforeAPersonM(bool judge_moving, int frames) {
  const PlanarLaser laser{.sigma_of_range = 0.005};
  RangeNoise noise;
  ScanSurfelMaker maker({});
  SurfelStore map;
  for (int i = 0; i < frames; ++i) {
    const double person_x_m = i < frames - 2 ? 2.9 : 1.0;
    const Scan scan = ScanOf(RoomWith(person_x_m), {}, laser, 11, static_cast<std::uint32_t>(i));
    noise.Add(scan);
    for (const Surfel& piece : maker.Make(scan, noise)) map.Merge(piece, {0.05, 0.05, 0.7}, i);
  }
  const Scan scan = ScanOf(RoomWith(1.06), {}, laser, 11, static_cast<std::uint32_t>(frames));
  const Eigen::Matrix3d covariance = Eigen::Vector3d(4e-4, 4e-4, 1e-4).asDiagonal();
  SurfelMatchOptions options;
  options.judge_moving = judge_moving;
  const MatchResult match =
      SurfelMatcher(options).Match(maker.Make(scan, noise), map, {Pose2{}, covariance});
  EXPECT_TRUE(match.found);
  return match.map_from_base.translation().norm();
}

TEST(SurfelMatcher, WhatMovesAgainstAllElseIsLeftOut) {
  EXPECT_GT(ErrorBeforeAPersonM(false, 80), 0.02);
  EXPECT_LT(ErrorBeforeAPersonM(true, 80), 0.006);
}

// Nothing has shown yet whether SLAM errs or something moves.
TEST(SurfelMatcher, NothingIsLeftOutOfARunsFirstFrames) {
  EXPECT_EQ(ErrorBeforeAPersonM(true, 40), ErrorBeforeAPersonM(false, 40));
}

}  // namespace
}  // namespace depthgrid
