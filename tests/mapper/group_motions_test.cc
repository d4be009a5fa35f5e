#include "mapper/surfel/group_motions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

constexpr int kSteps = 12;  // of a walk

// A walk there and back along a line, again and again, a group each frame. In each walk but the
// first every third frame is of a place that is well seen.
struct Walks {
  explicit Walks(int walks, bool of_prior_map = false) {
    SurfelGroupOptions options;
    options.length_m = 0.08;
    groups = SurfelGroups(options);
    for (int i = 0; i < walks * kSteps; ++i) Add(i, of_prior_map);
  }

  void Add(int i, bool of_prior_map) {
    const int in_walk = i % kSteps;
    const int to_and_fro = std::min(in_walk, kSteps - in_walk);
    MappedFrame frame;
    frame.frame = of_prior_map ? i - 100000 : i;
    frame.map_from_base = {0.1 * to_and_fro, 0.0, 0.0};
    frame.match.found = true;
    frame.match.map_from_base = frame.map_from_base;
    frame.match.information = Eigen::Vector3d(1e6, 1e6, 1e6).asDiagonal();
    if (i > 0) frame.slam_motion = Between(frames.back().map_from_base, frame.map_from_base);
    if (!of_prior_map && i >= kSteps && in_walk % 3 == 2) frame.tied_to = in_walk;
    frames.push_back(frame);
    if (frame.kept()) {
      groups.Add({}, frame.map_from_base);
    } else {
      groups.AddTied(frame.tied_to, frame.map_from_base);
    }
  }

  // The next frame, kept, after this motion.
  void AddAfter(const Pose2& motion) {
    MappedFrame frame = frames.back();
    frame.frame += 1;
    frame.tied_to = -1;
    frame.slam_motion = motion;
    frame.map_from_base = frame.map_from_base * motion;
    frames.push_back(frame);
    groups.Add({}, frame.map_from_base);
  }

  SurfelGroups Joined(int most) const {
    return groups.Joined({.most = most, .most_of_prior_map = most, .in_place = true},
                         StartsOf(groups, frames));
  }

  SurfelGroups groups{SurfelGroupOptions()};
  std::vector<MappedFrame> frames;
};

TEST(GroupMotions, AGroupIsSettledOnceAFrameBeforeItWasTied) {
  const Walks walks(3);
  const std::vector<GroupStart> starts = StartsOf(walks.groups, walks.frames);
  ASSERT_EQ(starts.size(), walks.groups.groups().size());
  int settled = 0;
  for (std::size_t g = 0; g < starts.size(); ++g) {
    const bool after_a_tie = walks.groups.groups()[g].first_frame > kSteps + 2;
    EXPECT_EQ(starts[g].settled, after_a_tie) << g;
    settled += starts[g].settled ? 1 : 0;
  }
  EXPECT_EQ(settled, 14);
}

TEST(GroupMotions, NeitherIsOneThatWasHardlySeenNorOneAfterAJump) {
  constexpr std::size_t kUnseen = 2 * kSteps;
  constexpr std::size_t kJump = 2 * kSteps + 3;
  Walks walks(3);
  walks.frames[kUnseen].match.information(0, 0) = 1.0;
  walks.frames[kJump].slam_motion.reset();
  const std::vector<GroupStart> starts = StartsOf(walks.groups, walks.frames);
  const auto group_of = [&](std::size_t frame) {
    return static_cast<std::size_t>(walks.groups.places()[frame].group);
  };
  EXPECT_TRUE(starts[group_of(kUnseen - 2)].settled);
  EXPECT_FALSE(starts[group_of(kUnseen)].settled);
  EXPECT_TRUE(starts[group_of(kUnseen + 1)].settled);
  EXPECT_FALSE(starts[group_of(kJump)].settled);
  EXPECT_TRUE(starts[group_of(kJump)].apart);
  EXPECT_FALSE(starts[group_of(kJump + 1)].settled);
  EXPECT_TRUE(starts.back().settled);  // after the next tie
}

// Groups of two frames each.
SurfelGroups PairsOf(const std::vector<MappedFrame>& frames) {
  SurfelGroupOptions options;
  options.length_m = 0.15;
  SurfelGroups pairs(options);
  for (const MappedFrame& frame : frames) pairs.Add({}, frame.map_from_base);
  return pairs;
}

// Of several steps without SLAM's motion between two groups the variances add up.
TEST(GroupMotions, AGapIsAsWideAsItsStepsTogether) {
  Walks walks(1);
  const SurfelGroups pairs = PairsOf(walks.frames);
  ASSERT_EQ(pairs.groups()[2].first_frame, 4);
  walks.frames[3].slam_motion.reset();
  walks.frames[3].gap_share = 0.03;
  walks.frames[4].slam_motion.reset();
  walks.frames[4].gap_share = 0.04;
  const std::vector<GroupMotion> motions = MotionsOf(pairs, walks.frames);
  EXPECT_TRUE(motions[1].known);
  EXPECT_FALSE(motions[2].known);
  EXPECT_NEAR(motions[2].gap_share, 0.05, 1e-12);
}

// However often the place is walked through.
TEST(GroupMotions, ManyWalksBecomeAsManyGroupsAsAFew) {
  for (const int count : {4, 40, 400}) {
    const Walks walks(count);
    EXPECT_GE(walks.groups.groups().size(), static_cast<std::size_t>(8 * count));
    EXPECT_LE(walks.Joined(20).groups().size(), 20U) << count;
  }
}

// What SLAM says between two frames whose groups follow each other in time; where frames between
// are in other groups, how the frame before lies, with no word of SLAM's over all of them.
TEST(GroupMotions, GroupsOfOnePlaceGoOnFromTheFrameBefore) {
  Walks walks(6);
  for (const int more : {0, 1}) walks.Add(6 * kSteps + more, false);
  walks.AddAfter({3.0, 1.0, 0.0});
  const MappedFrame& elsewhere = walks.frames.back();
  const SurfelGroups joined = walks.Joined(15);
  ASSERT_LE(joined.groups().size(), 15U);
  const std::vector<GroupMotion> motions = MotionsOf(joined, walks.frames);
  const GroupMotion& motion = motions.back();
  EXPECT_FALSE(motion.known);
  ASSERT_TRUE(motion.tie);
  EXPECT_LT(motion.tie->first, static_cast<int>(joined.groups().size()) - 2);
  EXPECT_EQ(motion.tie->second, static_cast<int>(joined.groups().size()) - 1);
  const Pose2 first = joined.groups()[static_cast<std::size_t>(motion.tie->first)].map_from_group;
  EXPECT_NEAR(Separation(first * motion.tie->first_from_second, elsewhere.map_from_base), 0.0,
              1e-9);
  EXPECT_TRUE(motions[1].known);
  EXPECT_FALSE(motions[1].tie);
}

// Nor is a round from the group that began last and back to it a motion.
TEST(GroupMotions, ARoundBackToTheLastGroupIsNoMotion) {
  const Pose2 away{3.0, 1.0, 0.0};
  Walks walks(6);
  walks.AddAfter(away);
  const Pose2 there = walks.frames.back().map_from_base;
  for (int i = 6 * kSteps + 1; i < 7 * kSteps; ++i) walks.Add(i, false);
  walks.AddAfter(Between(walks.frames.back().map_from_base, there));
  walks.AddAfter(away);
  const SurfelGroups joined = walks.Joined(15);
  const int last = static_cast<int>(joined.groups().size()) - 2;
  ASSERT_EQ(joined.places()[walks.frames.size() - 2].group, last);
  const GroupMotion motion = MotionsOf(joined, walks.frames).back();
  EXPECT_FALSE(motion.known);
  ASSERT_TRUE(motion.tie);
  EXPECT_EQ(motion.tie->first, last);
}

TEST(GroupMotions, APriorMapsGroupsOfOnePlaceAreHeldAsItHadThem) {
  Walks walks(6, true);
  MappedFrame elsewhere = walks.frames.back();
  elsewhere.map_from_base = elsewhere.map_from_base * Pose2{3.0, 0.0, 0.0};
  elsewhere.slam_motion = Pose2{3.0, 0.0, 0.0};
  walks.frames.push_back(elsewhere);
  walks.groups.Add({}, elsewhere.map_from_base);
  const SurfelGroups joined = walks.Joined(8);
  ASSERT_LE(joined.groups().size(), 8U);
  const GroupMotion motion = MotionsOf(joined, walks.frames).back();
  ASSERT_TRUE(motion.tie);
  EXPECT_TRUE(motion.of_prior_map);
  EXPECT_EQ(motion.tie->sigma, kPriorMapSigma);
}

// A round during a run in a prior map takes of it what a place needs, however often it was seen
// there, and of the run's own groups as many as without one.
TEST(GroupMotions, ARoundTakesFewGroupsOfAPriorMapHoweverLongItWas) {
  const JointOptions joint;
  constexpr int kOwn = 600;
  const auto limits_with = [&](int prior, AdjustEffort effort) {
    std::vector<GroupStart> starts(static_cast<std::size_t>(prior), {.of_prior_map = true});
    starts.resize(starts.size() + kOwn);
    return LimitsFor(effort, joint, starts);
  };
  const GroupLimits without = limits_with(0, AdjustEffort::kRefine);
  EXPECT_EQ(without.most, 2 * kOwn / 3);
  for (const int prior : {1000, 10000}) {
    const GroupLimits round = limits_with(prior, AdjustEffort::kRefine);
    EXPECT_EQ(round.most_of_prior_map, joint.refine_groups);
    EXPECT_EQ(round.most, without.most + joint.refine_groups);
    const GroupLimits end = limits_with(prior, AdjustEffort::kFinish);
    EXPECT_EQ(end.most, joint.groups.most);
    EXPECT_EQ(end.most_of_prior_map, joint.groups.most / 2);
  }
}

// A tied frame lies as well as its match says, which is believed a quarter, but not to more than
// 5 mm and 3 mrad.
TEST(GroupMotions, ATieIsAsSureAsAQuarterOfItsMatch) {
  Walks walks(2);
  MappedFrame& tied = walks.frames[kSteps + 2];
  ASSERT_FALSE(tied.kept());
  tied.match.information = Eigen::Vector3d(1e4, 1e3, 1e8).asDiagonal();
  const std::vector<GroupMotion> motions = MotionsOf(walks.groups, walks.frames);
  const int after = walks.groups.places()[kSteps + 3].group;
  const GroupMotion& motion = motions[static_cast<std::size_t>(after)];
  ASSERT_TRUE(motion.tie);
  EXPECT_NEAR(motion.tie->sigma.x(), 2.0 / std::sqrt(1e4), 1e-4);
  EXPECT_NEAR(motion.tie->sigma.y(), 2.0 / std::sqrt(1e3), 1e-3);
  EXPECT_EQ(motion.tie->sigma.z(), 0.003);
}

// Frames that came without a scan between two are no pause of the recording.
TEST(GroupMotions, OnlyFramesThatFollowEachOtherHaveAPauseBetweenThem) {
  for (const bool is_pause : {true, false}) {
    Walks walks(1);
    for (std::size_t i = 0; i < walks.frames.size(); ++i) {
      MappedFrame& frame = walks.frames[i];
      frame.stamp_s = 0.1 * static_cast<double>(i);
      if (i < 6) continue;
      frame.stamp_s += 1.0;  // ten steps
      if (!is_pause) frame.frame += 10;
    }
    walks.frames[6].slam_motion = Pose2{1.1, 0.0, 0.0};
    const std::vector<GroupMotion> motions = MotionsOf(walks.groups, walks.frames);
    const auto group = static_cast<std::size_t>(walks.groups.places()[6].group);
    ASSERT_EQ(walks.groups.groups()[group].first_frame, 6);
    EXPECT_EQ(motions[group].frames, is_pause ? 11 : 1);
  }
}

// SLAM that jitters about one place for a minute has gone no farther than it seems.
TEST(GroupMotions, AMotionOfManyFramesCountsAsThoseItTakesToGoThatFar) {
  for (const double jitter_m : {0.004, 0.0}) {
    SCOPED_TRACE(jitter_m);
    Walks walks(4);
    for (int i = 0; i < 1800; ++i) walks.AddAfter({i % 2 == 0 ? jitter_m : -jitter_m, 0.0, 0.0});
    if (jitter_m == 0.0) {
      for (auto frame = walks.frames.end() - 1800; frame != walks.frames.end(); ++frame) {
        frame->stands = true;
      }
    }
    walks.AddAfter({0.1, 0.0, 0.0});
    const std::vector<GroupMotion> motions = MotionsOf(walks.groups, walks.frames);
    ASSERT_TRUE(motions.back().known);
    EXPECT_GE(motions.back().frames, 1);
    EXPECT_LE(motions.back().frames, 30);
  }
}

// The frames of a motion are those after a group's first one up to the next group's. Of the last
// group's others SLAM errs as it did before.
TEST(GroupMotions, AFrameHasTheGrowthOfTheMotionThatContainsIt) {
  Walks walks(1);
  const SurfelGroups pairs = PairsOf(walks.frames);
  walks.frames[4].slam_motion.reset();  // the first frame of group 2
  const std::vector<GroupMotion> motions = MotionsOf(pairs, walks.frames);
  std::vector<Eigen::Vector3d> of_motions;
  for (std::size_t g = 1; g < motions.size(); ++g) {
    if (g != 2) of_motions.push_back(Eigen::Vector3d::Constant(10.0 * static_cast<double>(g)));
  }
  const std::vector<Eigen::Vector3d> growth = GrowthAt(motions, of_motions, pairs);
  ASSERT_EQ(growth.size(), walks.frames.size());
  const std::vector<SurfelGroup>& groups = pairs.groups();
  for (std::size_t i = 0; i < growth.size(); ++i) {
    std::size_t g = 0;
    while (g + 1 < groups.size() && groups[g].first_frame < static_cast<int>(i)) ++g;
    const double expected = g == 0 || g == 2 ? 1.0 : 10.0 * static_cast<double>(g);
    EXPECT_EQ(growth[i].x(), expected) << i;
  }
  EXPECT_EQ(GrowthAt(motions, {}, pairs),
            std::vector<Eigen::Vector3d>(growth.size(), Eigen::Vector3d::Ones().eval()));
}

}  // namespace
}  // namespace depthgrid
