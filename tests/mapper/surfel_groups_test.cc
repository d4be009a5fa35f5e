#include "mapper/surfel/surfel_groups.h"

#include <gtest/gtest.h>

namespace depthgrid {
namespace {

// A wall 1 m to the left, seen anew from each frame.
std::vector<Surfel> WallFrom(double x_m) {
  std::vector<Surfel> pieces;
  for (int i = 0; i < 5; ++i) {
    Surfel piece;
    piece.point_m = {0.5 * i - x_m, 1.0};
    piece.normal = {0.0, -1.0};
    piece.information = 1e4;
    piece.normal_information = 1e4;
    pieces.push_back(piece);
  }
  return pieces;
}

// Twelve frames 0.1 m apart, a group each.
SurfelGroups WalkInGroups() {
  SurfelGroupOptions options;
  options.length_m = 0.08;
  SurfelGroups groups(options);
  for (int i = 0; i < 12; ++i) groups.Add(WallFrom(0.1 * i), {0.1 * i, 0.0, 0.0});
  return groups;
}

const std::vector<bool> kTogether(12, false);

TEST(SurfelGroups, FewAreLeftAsTheyAre) {
  const SurfelGroups groups = WalkInGroups();
  EXPECT_EQ(groups.groups().size(), 12U);
  EXPECT_EQ(groups.Joined(12, kTogether).groups().size(), 12U);
}

// Groups may reach 0.24 m then: frames 0-2, 3-5 ...
TEST(SurfelGroups, ManyAreJoinedWithTheirNeighbours) {
  const SurfelGroups walk = WalkInGroups();
  const SurfelGroups joined = walk.Joined(4, kTogether);
  ASSERT_EQ(joined.groups().size(), 4U);
  EXPECT_EQ(joined.groups()[1].first_frame, 3);
  EXPECT_EQ(joined.groups()[1].frames, 3);
  EXPECT_EQ(joined.groups()[1].surfels.size(), 5U);  // the same pieces of wall
  EXPECT_NEAR(joined.groups()[1].surfels[0].point_m.x(), -0.3, 1e-9);
  ASSERT_EQ(joined.places().size(), 12U);
  EXPECT_EQ(joined.places()[4].group, 1);
  EXPECT_NEAR(joined.places()[4].group_from_base.x_m, 0.1, 1e-9);
}

TEST(SurfelGroups, PosesAloneAreJoinedTheSame) {
  const SurfelGroups walk = WalkInGroups();
  for (const int most : {12, 4}) {
    const SurfelGroups joined = walk.Joined(most, kTogether);
    const SurfelGroups bare = walk.Joined(most, kTogether, GroupContent::kPosesOnly);
    ASSERT_EQ(bare.groups().size(), joined.groups().size());
    for (std::size_t g = 0; g < bare.groups().size(); ++g) {
      EXPECT_EQ(bare.groups()[g].first_frame, joined.groups()[g].first_frame);
      EXPECT_EQ(bare.groups()[g].frames, joined.groups()[g].frames);
      EXPECT_EQ(bare.groups()[g].map_from_group, joined.groups()[g].map_from_group);
      EXPECT_TRUE(bare.groups()[g].surfels.empty());
    }
    ASSERT_EQ(bare.places().size(), joined.places().size());
    for (std::size_t i = 0; i < bare.places().size(); ++i) {
      EXPECT_EQ(bare.places()[i].group, joined.places()[i].group);
      EXPECT_EQ(bare.places()[i].group_from_base, joined.places()[i].group_from_base);
    }
  }
}

TEST(SurfelGroups, WhatSlamJumpedBetweenStaysApart) {
  std::vector<bool> apart = kTogether;
  apart[4] = true;
  const SurfelGroups joined = WalkInGroups().Joined(5, apart);
  EXPECT_EQ(joined.groups().size(), 5U);
  EXPECT_EQ(joined.groups()[2].first_frame, 4);
}

// The two frames of the second group, and no others.
TEST(SurfelGroups, TheNewestMovesAsAWholeUnlessItIsTheFirst) {
  SurfelGroupOptions options;
  options.length_m = 0.15;
  SurfelGroups groups(options);
  const Pose2 motion{0.0, 0.03, 0.01};
  groups.Add(WallFrom(0.0), {});
  groups.MoveNewest(motion);
  EXPECT_EQ(groups.groups()[0].map_from_group, Pose2());
  for (int i = 1; i < 4; ++i) groups.Add(WallFrom(0.1 * i), {0.1 * i, 0.0, 0.0});
  ASSERT_EQ(groups.groups().size(), 2U);
  const std::vector<GroupPlace> before = groups.places();
  groups.MoveNewest(motion);
  EXPECT_EQ(groups.groups()[0].map_from_group, Pose2());
  EXPECT_EQ(groups.groups()[1].map_from_group, motion * Pose2(0.2, 0.0, 0.0));
  EXPECT_EQ(groups.places()[3].group_from_base, before[3].group_from_base);
  groups.AddTied(0, {});
  groups.MoveNewest(motion);
  groups.Add(WallFrom(0.3), {0.3, 0.0, 0.0});
  groups.BeginPart();
  groups.MoveNewest(motion);
  EXPECT_EQ(groups.groups()[1].map_from_group, motion * Pose2(0.2, 0.0, 0.0));
}

// Frames 3 to 5 see what frame 0 saw and move with its group.
TEST(SurfelGroups, TiedFramesMoveWithTheirGroup) {
  SurfelGroupOptions options;
  options.length_m = 0.08;
  SurfelGroups groups(options);
  for (int i = 0; i < 3; ++i) groups.Add(WallFrom(0.1 * i), {0.1 * i, 0.0, 0.0});
  for (int i = 3; i < 6; ++i) groups.AddTied(0, {0.01 * i, 0.0, 0.0});
  groups.Add(WallFrom(0.6), {0.6, 0.0, 0.0});
  ASSERT_EQ(groups.groups().size(), 4U);
  EXPECT_EQ(groups.groups()[3].first_frame, 6);
  EXPECT_EQ(groups.places()[4].group, 0);
  std::vector<Pose2> moved;
  for (const GroupPlace& place : groups.places()) {
    moved.push_back(Pose2{0.0, 0.1, 0.0} *
                    groups.groups()[static_cast<std::size_t>(place.group)].map_from_group *
                    place.group_from_base);
  }
  groups.MoveTo(moved);
  EXPECT_NEAR(groups.groups()[0].map_from_group.y_m, 0.1, 1e-12);
  EXPECT_NEAR(groups.places()[4].group_from_base.x_m, 0.04, 1e-12);
  const SurfelGroups joined = groups.Joined(2, {false, false, false, true});
  ASSERT_EQ(joined.groups().size(), 2U);
  EXPECT_EQ(joined.places()[5].group, 0);
  EXPECT_EQ(joined.places()[6].group, 1);
  EXPECT_EQ(joined.groups()[1].first_frame, 6);
}

}  // namespace
}  // namespace depthgrid
