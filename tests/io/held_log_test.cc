// Laser logs whose odometry holds its poses (mapper/io/held_poses.h), as frames.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "mapper/core/level.h"
#include "mapper/io/carmen_log.h"
#include "tests/io/held_room.h"
#include "tests/io/log_text.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kLogScans = 140;
constexpr double kLogPeriodS = 0.1;

// Drives at 3 cm and .01 rad a scan, beyond half a turn.
Pose2 SteadyAt(double scan) {
  return {-1.0 + 0.03 * scan, 0.0, WrapAngle(std::numbers::pi - 0.3 + 0.01 * scan)};
}
// The same with a stand from scan 30 to 65.
Pose2 StandingAt(double scan) { return SteadyAt(scan < 30.0 ? scan : std::max(scan - 35.0, 30.0)); }

using PoseAt = std::function<Pose2(double scan)>;

// `told`: the pose that the odometry gives in place of that of this scan.
std::string HeldLogText(const PoseAt& truth, const std::function<Pose2(int scan)>& told) {
  RandomStream random(7, RandomStage::kTest);
  std::string log;
  for (int i = 0; i < kLogScans; ++i) {
    log += RoomLine(truth(i), told(i), 10.0 + kLogPeriodS * i, random);
  }
  return log;
}
// An odometry that has a new pose at each fourth scan.
std::string SlowLogText(const PoseAt& truth) {
  return HeldLogText(truth, [&](int i) { return truth(i / 4 * 4); });
}

struct ReadLog {
  std::vector<Frame> frames;
  std::vector<std::string> warnings;
};
ReadLog ReadText(const std::string& text, const CarmenLogOptions& options = {},
                 const PartOptions& part = {}) {
  const TextFile file(text);
  const CarmenLog log = OpenCarmenLog(file.path(), options, {}, part);
  return {ReadAll(*log.source), log.source->Warnings()};
}

double OffBy(const Frame& frame, const Pose2& pose) {
  return Separation(BaseOf(*frame.slam_from_camera), pose);
}

TEST(HeldLog, PosesOfASlowOdometryAreInterpolated) {
  const ReadLog log = ReadText(SlowLogText(SteadyAt));
  ASSERT_EQ(log.frames.size(), 140U);
  for (int i = 0; i < kLogScans; ++i) {
    const Frame& frame = log.frames[static_cast<std::size_t>(i)];
    ASSERT_EQ(frame.slam_from_camera.has_value(), i <= 136) << i;  // no pose is after the last four
    if (i <= 136) {
      EXPECT_LT(OffBy(frame, SteadyAt(i)), 1e-9) << i;
    }
  }
  EXPECT_THAT(log.warnings, ElementsAre(HasSubstr("the odometry gives one pose for 4 scans in a "
                                                  "row, first in frame 1: 102 frames are "
                                                  "interpolated, 3 frames are taken for lost")));
}

// The robot's pose is interpolated, not that of a laser far from its axis.
TEST(HeldLog, AMountIsAppliedToInterpolatedPoses) {
  CarmenLogOptions options;
  options.mount = {2.0, 0.0, 0.0};
  const ReadLog log = ReadText(SlowLogText(SteadyAt), options);
  ASSERT_EQ(log.frames.size(), 140U);
  for (int i = 0; i < 137; ++i) {
    const Frame& frame = log.frames[static_cast<std::size_t>(i)];
    EXPECT_LT(OffBy(frame, SteadyAt(i) * Pose2{2.0, 0.0, 0.0}), 1e-9) << i;
  }
}

// The laser moves between poses that are held.
TEST(HeldLog, SweepsAreThoseOfTheInterpolatedMotion) {
  CarmenLogOptions options;
  options.sweep = {.duration_s = kLogPeriodS};
  const auto own_pose = [](int i) { return SteadyAt(i); };
  const ReadLog right = ReadText(HeldLogText(SteadyAt, own_pose), options);
  const ReadLog held = ReadText(SlowLogText(SteadyAt), options);
  for (std::size_t i = 0; i < 137; ++i) {
    const auto &a = right.frames[i].scan->beams, &b = held.frames[i].scan->beams;
    ASSERT_EQ(a.size(), b.size()) << i;
    for (std::size_t k = 0; k < a.size(); ++k) ASSERT_NEAR(a[k].range_m, b[k].range_m, 1e-6) << i;
  }
}

TEST(HeldLog, ARobotThatStandsStaysWhereItIs) {
  const ReadLog log = ReadText(SlowLogText(StandingAt));
  for (int i = 0; i < 137; ++i) {
    const Frame& frame = log.frames[static_cast<std::size_t>(i)];
    ASSERT_TRUE(frame.slam_from_camera) << i;
    // Between the poses of 28 and 32, and of 64 and 68, it stops and moves on.
    const bool is_known = i <= 28 || (i >= 32 && i <= 64) || i >= 68;
    EXPECT_LT(OffBy(frame, StandingAt(i)), is_known ? 1e-9 : 0.05) << i;
  }
}

TEST(HeldLog, OfAPartHasThePosesOfTheWhole) {
  const std::string text = SlowLogText(SteadyAt);
  const ReadLog whole = ReadText(text);
  const ReadLog part = ReadText(text, {}, {.from_s = 3.05, .to_s = 5.05});  // from scan 31 to 50
  ASSERT_EQ(part.frames.size(), 20U);
  for (const Frame& frame : part.frames) {
    EXPECT_EQ(frame.slam_from_camera,
              whole.frames[static_cast<std::size_t>(frame.index)].slam_from_camera)
        << frame.index;
  }
  EXPECT_THAT(part.warnings, ElementsAre(HasSubstr("first in frame 31: 15 frames are")));
}

// A hold of `held` scans from scan 40 on, after which the odometry goes on at this scan's pose.
ReadLog HeldOnce(int held, int goes_on_at) {
  return ReadText(HeldLogText(SteadyAt, [=](int i) {
    if (i < 40) return SteadyAt(i);
    return i < 40 + held ? SteadyAt(40) : SteadyAt(i - (40 + held) + goes_on_at);
  }));
}
int CountLost(const ReadLog& log) {
  return static_cast<int>(std::count_if(log.frames.begin(), log.frames.end(),
                                        [](const Frame& f) { return !f.slam_from_camera; }));
}

TEST(HeldLog, AShortHoldThatIsMadeUpForIsInterpolated) {
  const ReadLog log = HeldOnce(9, 49);
  EXPECT_EQ(CountLost(log), 0);
  for (int i = 0; i < kLogScans; ++i) {
    // Where it began to be held is known to half of 5 cm and the noise.
    const double most = i > 40 && i < 49 ? 0.1 : 1e-9;
    EXPECT_LT(OffBy(log.frames[static_cast<std::size_t>(i)], SteadyAt(i)), most) << i;
  }
  EXPECT_THAT(log.warnings,
              ElementsAre(AllOf(HasSubstr("one pose again and again while the scans move"),
                                HasSubstr("frames are interpolated"), Not(HasSubstr("lost")))));
}

TEST(HeldLog, LongHoldsAndThoseNeverMadeUpForAreLost) {
  EXPECT_GE(CountLost(HeldOnce(20, 60)), 15);
  EXPECT_GE(CountLost(HeldOnce(9, 41)), 4);
  EXPECT_GE(CountLost(HeldOnce(9, 99)), 4);  // nobody goes that fast
}

}  // namespace
}  // namespace depthgrid
