#include <gtest/gtest.h>

#include "mapper/surfel/range_noise.h"
#include "mapper/surfel/scan_surfels.h"
#include "mapper/surfel/surfel_matcher.h"
#include "mapper/surfel/surfel_store.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

// Somebody a metre ahead takes up half of the view and steps back by 6 cm.
TEST(SurfelMatcher, WhatMovesAgainstAllElseIsLeftOut) {
  const auto world = [](double person_x_m) {
    PlanarWorld walls = RectangleWorld(-2.0, -2.5, 3.0, 2.5);
    for (const Wall& side : RectangleWorld(person_x_m, -0.3, person_x_m + 0.4, 0.3)) {
      walls.push_back(side);
    }
    return walls;
  };
  const PlanarLaser laser{.sigma_of_range = 0.005};
  RangeNoise noise;
  ScanSurfelMaker maker({});
  SurfelStore map;
  constexpr int kFrames = 40;
  for (int i = 0; i < kFrames; ++i) {
    // For most of the time nobody is there.
    const double person_x_m = i < kFrames - 2 ? 2.9 : 1.0;
    const Scan scan = ScanOf(world(person_x_m), {}, laser, 11, static_cast<std::uint32_t>(i));
    noise.Add(scan);
    for (const Surfel& piece : maker.Make(scan, noise)) map.Merge(piece, {0.05, 0.05, 0.7}, i);
  }
  const Scan scan = ScanOf(world(1.06), {}, laser, 11, kFrames);
  const std::vector<Surfel> pieces = maker.Make(scan, noise);
  const Eigen::Matrix3d covariance = Eigen::Vector3d(4e-4, 4e-4, 1e-4).asDiagonal();
  const auto error_m = [&](bool judge_moving) {
    SurfelMatchOptions options;
    options.judge_moving = judge_moving;
    const MatchResult match = SurfelMatcher(options).Match(pieces, map, {Pose2{}, covariance});
    EXPECT_TRUE(match.found);
    return match.map_from_base.translation().norm();
  };
  EXPECT_GT(error_m(false), 0.02);
  EXPECT_LT(error_m(true), 0.006);
}

}  // namespace
}  // namespace depthgrid
