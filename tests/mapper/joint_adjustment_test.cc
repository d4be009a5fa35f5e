#include "mapper/surfel/joint_adjustment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mapper/core/mapped_frame.h"

namespace depthgrid {
namespace {

constexpr int kCorridorGroups = 40;
constexpr double kCorridorStepM = 0.2;
constexpr int kFramesPerGroup = 5;

// Two walls along x on both sides of the camera: nothing says how far along them it is.
std::vector<Surfel> CorridorSeen() {
  std::vector<Surfel> surfels;
  for (double x_m = 0.5; x_m < 3.0; x_m += 0.05) {
    for (const double side : {-1.0, 1.0}) {
      Surfel surfel;
      surfel.point_m = {x_m, side};
      surfel.normal = {0.0, -side};
      surfel.information = 1e6;
      surfel.normal_information = 1e4;
      surfels.push_back(surfel);
    }
  }
  return surfels;
}

struct Corridor {
  std::vector<SurfelGroup> groups;
  std::vector<GroupMotion> motions;
};

// Along the corridor with a prior that errs by 1 mm to and fro, but for one motion, that of a jump
// which SLAM did not announce.
Corridor WalkWithAJump(double jump_m) {
  Corridor corridor;
  for (int g = 0; g < kCorridorGroups; ++g) {
    SurfelGroup group;
    group.first_frame = g * kFramesPerGroup;
    group.frames = kFramesPerGroup;
    group.map_from_group = {g * kCorridorStepM, 0.0, 0.0};
    group.surfels = CorridorSeen();
    corridor.groups.push_back(group);
    const double error_m = g % 2 == 0 ? 0.001 : -0.001;
    const double motion_m = kCorridorStepM + (g == kCorridorGroups / 2 ? jump_m : error_m);
    corridor.motions.push_back({true, {motion_m, 0.0, 0.0}, kFramesPerGroup});
  }
  return corridor;
}

TEST(JointAdjustment, OneWrongMotionDoesNotMakeThePriorWorthless) {
  const Corridor corridor = WalkWithAJump(3.0);
  JointOptions options;
  options.rounds = 0;  // as it is judged before anything has moved
  const JointResult result = AdjustJointly(corridor.groups, corridor.motions, {}, options);
  // 1 mm in five frames. As a root mean square it would be 95 mm a frame.
  EXPECT_NEAR(result.motion_sigma.x(), 1.4826 * 0.0002, 1e-6);
}

// SLAM that errs by 20 mm a group in the last quarter. The poses of the run, which are right, tell
// it before anything has moved.
TEST(JointAdjustment, WhereSlamErredByMoreIsToldBeforeTheFirstRound) {
  constexpr std::size_t kDrifts = 3 * kCorridorGroups / 4;
  Corridor corridor = WalkWithAJump(0.001);
  for (std::size_t g = kDrifts; g < kCorridorGroups; ++g)
    corridor.motions[g].before_from_group.x_m += 0.02;
  JointOptions options;
  options.rounds = 0;
  const JointResult result = AdjustJointly(corridor.groups, corridor.motions, {}, options);
  ASSERT_EQ(result.motion_growth.size(), kCorridorGroups - 1);
  EXPECT_EQ(result.motion_growth.front().x(), 1.0);
  EXPECT_NEAR(result.motion_growth[kDrifts + 4].x(), 20.0, 2.0);
}

TEST(JointAdjustment, WhatOnlyThePriorHoldsStays) {
  const Corridor corridor = WalkWithAJump(0.001);
  const JointResult result = AdjustJointly(corridor.groups, corridor.motions, {}, {});
  for (std::size_t g = 0; g < result.map_from_group.size(); ++g) {
    const Pose2 moved = Between(corridor.groups[g].map_from_group, result.map_from_group[g]);
    EXPECT_LT(std::hypot(moved.x_m, moved.y_m), 0.01) << g;
    EXPECT_LT(std::abs(moved.yaw_rad), 0.001) << g;
  }
}

// Three quarters of the groups are those of a prior map, whose motions fit their poses exactly.
TEST(JointAdjustment, APriorMapDoesNotTellHowSlamErrs) {
  constexpr int kPrior = 3 * kCorridorGroups / 4;
  Corridor corridor = WalkWithAJump(0.001);
  for (std::size_t g = 0; g < kPrior; ++g) {
    corridor.motions[g] = {true, {kCorridorStepM, 0.0, 0.0}, kFramesPerGroup, true};
  }
  corridor.motions[kPrior].known = false;
  JointOptions options;
  options.rounds = 0;
  const JointResult result = AdjustJointly(corridor.groups, corridor.motions, {}, options);
  EXPECT_NEAR(result.motion_sigma.x(), 1.4826 * 0.0002, 1e-6);
}

TEST(JointAdjustment, ALoopBendsWhatIsNewAndNotThePriorMap) {
  constexpr int kPrior = kCorridorGroups / 2;
  Corridor corridor = WalkWithAJump(0.001);
  for (std::size_t g = 0; g < kPrior; ++g) {
    corridor.motions[g] = {true, {kCorridorStepM, 0.0, 0.0}, kFramesPerGroup, true};
  }
  const Pose2 measured{(kCorridorGroups - 1) * kCorridorStepM + 0.08, 0.0, 0.0};
  const GroupLink loop{0, kCorridorGroups - 1, measured, {0.01, 0.01, 0.01}};
  JointOptions options;
  options.rounds = 0;  // the first step, which has to bring revisits within the gate
  const JointResult result = AdjustJointly(corridor.groups, corridor.motions, {loop}, options);
  const auto moved_m = [&](std::size_t g) {
    return result.map_from_group[g].x_m - corridor.groups[g].map_from_group.x_m;
  };
  EXPECT_GT(moved_m(kCorridorGroups - 1), 0.05);
  EXPECT_LT(moved_m(kPrior - 1), 0.02 * moved_m(kCorridorGroups - 1));
}

// SLAM came back 20 m away from where it was lost, in the middle of the way, and one loop says
// where it really was.
TEST(JointAdjustment, OneLoopClosesAWideGap) {
  constexpr std::size_t kBack = kCorridorGroups / 2;
  Corridor corridor = WalkWithAJump(0.001);
  corridor.motions[kBack].known = false;
  for (std::size_t g = kBack; g < kCorridorGroups; ++g) {
    Pose2& pose = corridor.groups[g].map_from_group;
    pose = Pose2{20.0, 3.0, 0.5} * pose;
  }
  const Pose2 measured{(kCorridorGroups - 11) * kCorridorStepM, 0.0, 0.0};
  const GroupLink loop{10, kCorridorGroups - 1, measured, {0.02, 0.02, 0.01}};
  const JointResult result = AdjustJointly(corridor.groups, corridor.motions, {loop}, {});
  EXPECT_TRUE(result.loop_accepted[0]);
  for (std::size_t g = 0; g < kCorridorGroups; ++g) {
    const Pose2& pose = result.map_from_group[g];
    EXPECT_NEAR(pose.x_m, static_cast<double>(g) * kCorridorStepM, 0.02) << g;
    EXPECT_NEAR(pose.y_m, 0.0, 0.02) << g;
  }
}

// SLAM jumped along the walls from one frame to the next, and a loop of a few centimetres' accuracy
// asks for 4 cm: what was known without SLAM to a millimetre stays.
TEST(JointAdjustment, AGapIsHeldAsWellAsItsMotionWasKnown) {
  constexpr std::size_t kJumped = kCorridorGroups / 2;
  const auto moved_m = [&](double gap_share) {
    Corridor corridor = WalkWithAJump(0.001);
    corridor.motions[kJumped].known = false;
    corridor.motions[kJumped].gap_share = gap_share;
    const Pose2 measured{(kCorridorGroups - 11) * kCorridorStepM + 0.04, 0.0, 0.0};
    const GroupLink loop{10, kCorridorGroups - 1, measured, {0.05, 0.05, 0.01}};
    const JointResult result = AdjustJointly(corridor.groups, corridor.motions, {loop}, {});
    return result.map_from_group[kJumped].x_m - result.map_from_group[kJumped - 1].x_m -
           kCorridorStepM;
  };
  EXPECT_GT(moved_m(1.0), 0.02);
  EXPECT_LT(std::abs(moved_m(0.012)), 0.002);
}

// SLAM was lost twice, for half a second and for several; a loop tells that it came back 3 m off.
TEST(JointAdjustment, OfTwoGapsTheLongerGivesWay) {
  constexpr std::size_t kShort = kCorridorGroups / 3, kLong = 2 * kCorridorGroups / 3;
  for (const bool swaps : {false, true}) {
    Corridor corridor = WalkWithAJump(0.001);
    corridor.motions[kShort].known = corridor.motions[kLong].known = false;
    corridor.motions[kShort].gap_share = swaps ? kGuessedShare : 1.7;
    corridor.motions[kLong].gap_share = swaps ? 1.7 : kGuessedShare;
    const Pose2 measured{(kCorridorGroups - 11) * kCorridorStepM + 3.0, 0.0, 0.0};
    const GroupLink loop{10, kCorridorGroups - 1, measured, {0.02, 0.02, 0.01}};
    const JointResult result = AdjustJointly(corridor.groups, corridor.motions, {loop}, {});
    EXPECT_TRUE(result.loop_accepted[0]);
    for (const std::size_t g : {kShort, kLong}) {
      const double step_m = result.map_from_group[g].x_m - result.map_from_group[g - 1].x_m;
      const bool opens = (g == kShort) == swaps;
      EXPECT_NEAR(step_m, kCorridorStepM + (opens ? 3.0 : 0.0), 0.05) << swaps;
    }
  }
}

// There and back: SLAM was lost where it turned, 14 m away, and what it says since is turned by a
// radian about the beginning. Where the loop closes there only the yaw is wrong, at the gap 14 m as
// well.
TEST(JointAdjustment, OneLoopClosesAGapToATurnedWorld) {
  constexpr std::size_t kMany = 140;
  std::vector<SurfelGroup> groups(kMany);
  std::vector<GroupMotion> motions(kMany);
  std::vector<Pose2> truth;
  for (std::size_t g = 0; g < kMany; ++g) {
    const bool is_back = g >= kMany / 2;
    const auto way_m = kCorridorStepM * static_cast<double>(is_back ? kMany - 1 - g : g);
    truth.push_back({way_m, 0.0, is_back ? kPi : 0.0});
    groups[g].map_from_group = Pose2{0.0, 0.0, is_back ? 1.0 : 0.0} * truth[g];
    motions[g] = {g != kMany / 2, {kCorridorStepM, 0.0, 0.0}, kFramesPerGroup};
  }
  const GroupLink loop{0, kMany - 1, truth.back(), {0.02, 0.02, 0.01}};
  JointOptions options;
  options.rounds = 0;
  const JointResult result = AdjustJointly(groups, motions, {loop}, options);
  EXPECT_TRUE(result.loop_accepted[0]);
  for (std::size_t g = 0; g < kMany; ++g) {
    EXPECT_NEAR(result.map_from_group[g].x_m, truth[g].x_m, 0.02) << g;
    EXPECT_NEAR(result.map_from_group[g].y_m, 0.0, 0.02) << g;
  }
}

// Seen from the later group the earlier one, 5 m behind, lies 0.2 m to the left: that is how well
// its place is known, wherever the later group looks. So this one turns, which is cheaper than to
// go aside.
TEST(JointAdjustment, ALoopMayRunBackInTime) {
  std::vector<SurfelGroup> groups(2);
  groups[1].map_from_group = {5.0, 0.0, 0.0};
  GroupLink loop;
  loop.first = 1;
  loop.second = 0;
  loop.first_from_second = {-5.0, 0.2, 0.0};
  loop.sigma = {0.01, 0.01, 10.0};
  JointOptions options;
  options.rounds = 0;
  // Across the gap they lie to 0.1 m and 0.05 rad: the least of y^2 / 0.1^2 + yaw^2 / 0.05^2 with
  // 5 yaw - y = 0.2.
  const JointResult result = AdjustJointly(groups, std::vector<GroupMotion>(2), {loop}, options);
  EXPECT_EQ(result.loop_accepted, std::vector<bool>{true});
  EXPECT_NEAR(result.map_from_group[1].yaw_rad, 0.0345, 0.001);
  EXPECT_NEAR(result.map_from_group[1].y_m, -0.0276, 0.003);
}

// Two loops that contradict what was seen along the way; each alone is taken out.
TEST(JointAdjustment, EndsAtTheFirstLoopOnTrialThatIsNotAccepted) {
  const Corridor corridor = WalkWithAJump(0.001);
  const auto sideways = [](int first, double by_m, bool on_trial) {
    const Pose2 measured{(kCorridorGroups - 1 - first) * kCorridorStepM, by_m, 0.0};
    GroupLink loop{first, kCorridorGroups - 1, measured, {0.02, 0.02, 0.01}};
    loop.on_trial = on_trial;
    return loop;
  };
  const auto accepted = [&](bool first_on_trial, bool second_on_trial) {
    const std::vector<GroupLink> loops = {sideways(0, 1.5, first_on_trial),
                                          sideways(1, 1.4, second_on_trial)};
    return AdjustJointly(corridor.groups, corridor.motions, loops, {}).loop_accepted;
  };
  const std::vector<bool> none = {false, false};
  EXPECT_EQ(accepted(false, false), none);
  const std::vector<bool> both = accepted(true, true);
  EXPECT_EQ(std::count(both.begin(), both.end(), false), 1);
  // The one that is not on trial may be what made the other look wrong.
  const int worst = both[0] ? 1 : 0;
  EXPECT_EQ(accepted(worst != 0, worst != 1), none);
}

// The prior is perfect, what is seen of the wall ahead is off by a centimetre, each group in its
// own way: each round believes the prior more.
TEST(JointAdjustment, GoesOnWhileThePriorTurnsOutBetter) {
  std::vector<SurfelGroup> groups;
  std::vector<GroupMotion> motions;
  for (int g = 0; g < kCorridorGroups; ++g) {
    const double off_m = 0.01 * ((g * 7) % 5 - 2);
    SurfelGroup group;
    group.first_frame = g * kFramesPerGroup;
    group.frames = kFramesPerGroup;
    group.map_from_group = {g * kCorridorStepM + off_m, 0.0, 0.0};
    for (int i = 0; i < 10; ++i) {
      Surfel surfel;
      surfel.point_m = {12.0 - group.map_from_group.x_m, 0.05 * i};
      surfel.normal = {-1.0, 0.0};
      surfel.information = 100.0;
      surfel.normal_information = 1e4;
      group.surfels.push_back(surfel);
    }
    groups.push_back(group);
    motions.push_back({true, {kCorridorStepM, 0.0, 0.0}, kFramesPerGroup});
  }
  JointOptions options;
  options.rounds = 2;
  const auto sigma_m = [&](int most_rounds) {
    options.most_rounds = most_rounds;
    return AdjustJointly(groups, motions, {}, options).motion_sigma.x();
  };
  EXPECT_LT(sigma_m(6), 0.7 * sigma_m(2));
}

}  // namespace
}  // namespace depthgrid
