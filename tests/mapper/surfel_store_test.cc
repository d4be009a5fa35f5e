#include "mapper/surfel/surfel_store.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

Surfel DrawSurfel(RandomStream& random) {
  Surfel surfel;
  surfel.point_m = {random.Uniform(-2.0, 2.0), random.Uniform(-2.0, 2.0)};
  const double angle_rad = random.Uniform(-kPi, kPi);
  surfel.normal = {std::cos(angle_rad), std::sin(angle_rad)};
  surfel.information = surfel.normal_information = 1.0;
  return surfel;
}

TEST(SurfelStore, NearestAgreesWithLookingAtAll) {
  RandomStream random(11, RandomStage::kTest);
  const auto draw = [&] { return DrawSurfel(random); };
  SurfelStore store;
  for (int i = 0; i < 3000; ++i) store.Add(draw());
  const AssociationGate gate{0.08, 0.2, 0.7};
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const Surfel piece = draw();
    int nearest = -1;
    double nearest_distance2 = 2.0;
    for (int k = 0; k < store.size(); ++k) {
      const Surfel& surfel = store[k];
      const Eigen::Vector2d d = piece.point_m - surfel.point_m;
      const Eigen::Vector2d tangent(surfel.normal.y(), -surfel.normal.x());
      const double along = d.dot(tangent) / gate.along_m;
      const double off = d.dot(surfel.normal) / gate.off_m;
      if (surfel.normal.dot(piece.normal) < gate.min_cosine) continue;
      if (std::abs(along) > 1.0 || std::abs(off) > 1.0) continue;
      if (along * along + off * off >= nearest_distance2) continue;
      nearest_distance2 = along * along + off * off;
      nearest = k;
    }
    // The grid looks in the piece's box, which misses corners of turned gates only.
    const int by_place = store.Nearest(piece, gate);
    found += nearest >= 0 ? 1 : 0;
    if (nearest_distance2 < 0.5) {
      EXPECT_EQ(by_place, nearest);
    }
  }
  EXPECT_GT(found, 1000);
}

TEST(SurfelStore, FirmPiecesKeepTheirSurfel) {
  RandomStream random(12, RandomStage::kTest);
  SurfelStore store;
  for (int i = 0; i < 1000; ++i) store.Add(DrawSurfel(random));
  const AssociationGate gate{0.08, 0.2, 0.7};
  int firm = 0;
  int lost = 0;
  for (int i = 0; i < 4000; ++i) {
    const Surfel piece = DrawSurfel(random);
    const Association found = store.NearestFirmly(piece, gate);
    EXPECT_EQ(found.index, store.Nearest(piece, gate));
    if (found.firm_m <= 0.0) continue;
    ++firm;
    for (int k = 0; k < 8; ++k) {
      const double to_rad = random.Uniform(-kPi, kPi);
      const double turn_rad = SurfelStore::kFirmRad * random.Uniform(-1.0, 1.0);
      const auto shifted = [&](double shift_m) {
        Surfel moved = piece;
        moved.point_m += shift_m * Eigen::Vector2d(std::cos(to_rad), std::sin(to_rad));
        moved.normal = Motion2({0.0, 0.0, turn_rad}).Turn(piece.normal);
        return store.Nearest(moved, gate);
      };
      EXPECT_EQ(shifted(0.999 * found.firm_m), found.index);
      lost += shifted(3.0 * found.firm_m) != found.index ? 1 : 0;
    }
  }
  EXPECT_GT(firm, 400);
  EXPECT_GT(lost, 100);  // three times as far some do not
}

// A nearer surfel whose normal just misses the gate may be the piece's next, whichever was added
// first.
TEST(SurfelStore, WhatMissesAGateNarrowlyKeepsNoPieceFirm) {
  const AssociationGate gate{0.08, 0.2, 0.9};
  const double turn_rad = std::acos(0.8975);
  const Surfel near{{1.0, 0.0}, {std::cos(turn_rad), std::sin(turn_rad)}, 1.0, 1.0};
  const Surfel other{{1.0, 0.02}, {1.0, 0.0}, 1.0, 1.0};
  const Surfel piece{{1.0, 0.0}, {1.0, 0.0}, 1.0, 1.0};
  for (const bool near_first : {true, false}) {
    SurfelStore store;
    store.Add(near_first ? near : other);
    store.Add(near_first ? other : near);
    const Association found = store.NearestFirmly(piece, gate);
    EXPECT_EQ(found.index, near_first ? 1 : 0);
    EXPECT_EQ(found.firm_m, 0.0);
  }
}

TEST(SurfelStore, MergingMovesAlongTheNormalByInformation) {
  SurfelStore store;
  store.Add({{1.0, 0.0}, {-1.0, 0.0}, 3.0, 1.0});
  const int index = store.Merge({{1.04, 0.01}, {-1.0, 0.0}, 1.0, 1.0}, {0.05, 0.1, 0.7});
  EXPECT_EQ(index, 0);
  EXPECT_TRUE(store[0].point_m.isApprox(Eigen::Vector2d(1.01, 0.0), 1e-12));
  EXPECT_EQ(store[0].information, 4.0);
  // The other side of the wall is another surfel.
  EXPECT_EQ(store.Merge({{1.0, 0.0}, {1.0, 0.0}, 1.0, 1.0}, {0.05, 0.1, 0.7}), 1);
}

TEST(SurfelStore, FramesAreThoseOfTheFirstVisit) {
  const AssociationGate gate{0.05, 0.1, 0.7};
  const Surfel piece{{1.0, 0.0}, {-1.0, 0.0}, 1.0, 1.0};
  SurfelStore store;
  for (const int frame : {100, 101, 102, 103}) store.Merge(piece, gate, frame);
  EXPECT_NEAR(store.FrameOf(0), 101.5, 1e-4);
  for (const int frame : {2000, 2001, 2002}) store.Merge(piece, gate, frame);
  EXPECT_NEAR(store.FrameOf(0), 101.5, 1e-4);
  EXPECT_EQ(store[0].information, 7.0);
}

}  // namespace
}  // namespace depthgrid
