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

const std::vector<GroupStart> kTogether(12);

GroupLimits AtMost(int most) { return {.most = most}; }

TEST(SurfelGroups, FewAreLeftAsTheyAre) {
  const SurfelGroups groups = WalkInGroups();
  EXPECT_EQ(groups.groups().size(), 12U);
  EXPECT_EQ(groups.Joined(AtMost(12), kTogether).groups().size(), 12U);
}

// Groups may reach 0.24 m then: frames 0-2, 3-5 ...
TEST(SurfelGroups, ManyAreJoinedWithTheirNeighbours) {
  const SurfelGroups walk = WalkInGroups();
  const SurfelGroups joined = walk.Joined(AtMost(4), kTogether);
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
    const SurfelGroups joined = walk.Joined(AtMost(most), kTogether);
    const SurfelGroups bare = walk.Joined(AtMost(most), kTogether, GroupContent::kPosesOnly);
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
  std::vector<GroupStart> starts = kTogether;
  starts[4].apart = true;
  const SurfelGroups joined = WalkInGroups().Joined(AtMost(5), starts);
  EXPECT_EQ(joined.groups().size(), 5U);
  EXPECT_EQ(joined.groups()[2].first_frame, 4);
}

// The walk again and again, from the start of it each time, with frames in between that were not
// kept.
SurfelGroups WalksInGroups(int walks) {
  SurfelGroupOptions options;
  options.length_m = 0.08;
  SurfelGroups groups(options);
  for (int walk = 0; walk < walks; ++walk) {
    groups.BeginPart();
    for (int i = 0; i < 12; ++i) groups.Add(WallFrom(0.1 * i), {0.1 * i, 1e-3 * walk, 0.0});
  }
  return groups;
}

std::vector<GroupStart> ApartEachWalk(int walks, const GroupStart& later) {
  std::vector<GroupStart> starts(static_cast<std::size_t>(12 * walks), later);
  for (std::size_t i = 0; i < 12; ++i) starts[i] = {};
  for (std::size_t i = 0; i < starts.size(); i += 3) starts[i].apart = true;
  return starts;
}

// Every third frame begins apart: joined along the way alone as many groups stay as the walks are
// long. Those that are settled are one with what is there already.
TEST(SurfelGroups, SettledOnesOfAPlaceAreJoinedHoweverOftenItIsSeen) {
  const GroupLimits limits{.most = 8, .in_place = true};
  for (const int walks : {5, 50}) {
    const SurfelGroups groups = WalksInGroups(walks);
    ASSERT_EQ(groups.groups().size(), static_cast<std::size_t>(12 * walks));
    const auto guessed = ApartEachWalk(walks, {});
    EXPECT_EQ(groups.Joined(limits, guessed).groups().size(), static_cast<std::size_t>(4 * walks));
    const auto settled = ApartEachWalk(walks, {.settled = true});
    EXPECT_EQ(groups.Joined(AtMost(8), settled).groups().size(),
              static_cast<std::size_t>(4 * walks));
    const SurfelGroups joined = groups.Joined(limits, settled);
    ASSERT_LE(joined.groups().size(), 8U);
    // The last frame of all is where it was, in a group of the first walk.
    const GroupPlace& last = joined.places().back();
    const SurfelGroup& group = joined.groups()[static_cast<std::size_t>(last.group)];
    EXPECT_LT(group.first_frame, 12);
    const Pose2 map_from_last = group.map_from_group * last.group_from_base;
    EXPECT_NEAR(map_from_last.x_m, 1.1, 1e-9);
    EXPECT_NEAR(map_from_last.y_m, 1e-3 * (walks - 1), 1e-9);
    int frames = 0;
    for (const SurfelGroup& g : joined.groups()) frames += g.frames;
    EXPECT_EQ(frames, 12 * walks);
  }
}

// A prior map's groups lie as its own adjustment left them: those of a place are one before any of
// the run's own are joined.
TEST(SurfelGroups, OfAPriorMapThoseOfAPlaceAreJoinedFirst) {
  constexpr int kWalks = 6;
  const SurfelGroups groups = WalksInGroups(kWalks);
  std::vector<GroupStart> starts(std::size_t{12 * kWalks}, {.of_prior_map = true});
  for (std::size_t i = starts.size() - 12; i < starts.size(); ++i) starts[i] = {};
  starts[starts.size() - 12].apart = true;
  const SurfelGroups joined =
      groups.Joined({.most = 20, .most_of_prior_map = 8, .in_place = true}, starts);
  EXPECT_LE(joined.groups().size(), 20U);
  int own = 0;
  for (const SurfelGroup& group : joined.groups()) {
    own += group.first_frame >= 12 * (kWalks - 1) ? 1 : 0;
  }
  EXPECT_EQ(own, 12);
}

// A prior map that leads far needs more groups; those of the run stay as they would be without.
TEST(SurfelGroups, AWidePriorMapDoesNotJoinTheRunsOwn) {
  SurfelGroupOptions options;
  options.length_m = 0.08;
  SurfelGroups groups(options);
  constexpr int kPrior = 400;
  for (int i = 0; i < kPrior; ++i) groups.Add(WallFrom(0.0), {0.1 * i, 0.0, 0.0});
  groups.BeginPart();
  for (int i = 0; i < 12; ++i) groups.Add(WallFrom(0.0), {0.1 * i, 0.5, 0.0});
  std::vector<GroupStart> starts(kPrior, {.of_prior_map = true});
  starts.resize(kPrior + 12, {.settled = true});
  starts[kPrior].apart = true;
  const SurfelGroups joined =
      groups.Joined({.most = 32, .most_of_prior_map = 20, .in_place = true}, starts);
  EXPECT_EQ(joined.groups().size(), 58U + 12U);  // seven of the map's each
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
  const SurfelGroups joined = groups.Joined(AtMost(2), {{}, {}, {}, {.apart = true}});
  ASSERT_EQ(joined.groups().size(), 2U);
  EXPECT_EQ(joined.places()[5].group, 0);
  EXPECT_EQ(joined.places()[6].group, 1);
  EXPECT_EQ(joined.groups()[1].first_frame, 6);
}

}  // namespace
}  // namespace depthgrid
