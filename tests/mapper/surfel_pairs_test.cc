#include "mapper/surfel/surfel_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

// Surfels all around, 3 to 6 cm apart, so that a piece that turns soon belongs to another one.
std::vector<Surfel> Around(double spacing_m, double jitter_m, RandomStream& random) {
  std::vector<Surfel> surfels;
  const int count = static_cast<int>(2.0 * std::numbers::pi * 2.0 / spacing_m);
  for (int i = 0; i < count; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / count;
    Surfel surfel;
    surfel.normal = {-std::cos(angle_rad), -std::sin(angle_rad)};
    surfel.point_m = -(2.0 + jitter_m * random.Normal()) * surfel.normal;
    surfel.information = 1e4;
    surfel.normal_information = 1e4;
    surfels.push_back(surfel);
  }
  return surfels;
}

// What is kept from one pose to the next is what would be found anew there.
TEST(SurfelPairs, AreThoseOfAFreshAssociationHoweverThePoseMoves) {
  RandomStream random(5, RandomStage::kTest);
  SurfelStore map;
  for (const Surfel& surfel : Around(0.05, 0.01, random)) map.Add(surfel);
  const std::vector<Surfel> pieces = Around(0.03, 0.002, random);
  const PairGates gates{{0.075, 0.15, 0.7}, 2.5, 0.01, 0.3};
  SurfelPairs kept;
  kept.Assign(pieces);
  Pose2 pose;
  int poses = 0;
  for (const double step_rad : {0.0, 0.002, 0.006, 0.009, -0.004, 0.012, 0.03}) {
    for (const double step_m : {0.0, 0.001, 0.01}) {
      pose = pose * Pose2{step_m, -0.5 * step_m, step_rad};
      kept.Associate(map, gates, pose);
      SurfelPairs fresh;
      fresh.Assign(pieces);
      fresh.Associate(map, gates, pose);
      const PairEvaluation a = kept.Evaluate(gates, pose);
      const PairEvaluation b = fresh.Evaluate(gates, pose);
      EXPECT_EQ(a.used, b.used);
      EXPECT_EQ(a.explained, b.explained);
      EXPECT_EQ(a.equations.h, b.equations.h) << step_rad << " " << step_m;
      EXPECT_EQ(a.equations.g, b.equations.g) << step_rad << " " << step_m;
      ++poses;
    }
  }
  EXPECT_EQ(poses, 21);
}

// Where pieces hardly move as they turn, it is their normals that come into the gate and leave it.
TEST(SurfelPairs, TurnIntoTheGateAndOutOfIt) {
  RandomStream random(6, RandomStage::kTest);
  SurfelStore map;
  map.Add({{0.0, 0.0}, {1.0, 0.0}, 1e4, 1e4});
  std::vector<Surfel> pieces;
  for (int i = 0; i < 4000; ++i) {
    const double angle_rad = random.Uniform(-1.6, 1.6);
    pieces.push_back({{0.001 * random.Normal(), 0.001 * random.Normal()},
                      {std::cos(angle_rad), std::sin(angle_rad)},
                      1e4,
                      1e4});
  }
  const PairGates gates{{0.075, 0.15, 0.7}, 2.5, 0.01, 0.3};
  SurfelPairs kept;
  kept.Assign(pieces);
  for (int step = 0; step < 60; ++step) {
    const Pose2 pose{0.0, 0.0, 0.0017 * step};
    kept.Associate(map, gates, pose);
    SurfelPairs fresh;
    fresh.Assign(pieces);
    fresh.Associate(map, gates, pose);
    EXPECT_EQ(kept.Evaluate(gates, pose).used, fresh.Evaluate(gates, pose).used) << step;
  }
}

}  // namespace
}  // namespace depthgrid
