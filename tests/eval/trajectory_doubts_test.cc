// What is said of an estimate whose errors do not say what they seem to.
#include "eval/doubts/trajectory_doubts.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "eval/doubts/clock_check.h"
#include "eval/doubts/lever_check.h"
#include "eval/doubts/rotation_check.h"
#include "eval/metrics/trajectory_metrics.h"
#include "mapper/core/angle.h"
#include "mapper/core/level.h"
#include "mapper/core/rng.h"
#include "mapper/io/trajectory_file.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const TrajectoryNames kNames = {"truth", "estimate"};

// 40 s along an eight of 6 x 4 m at 10 Hz, looking around; jitter as a SLAM system has it.
Trajectory Eight(double jitter_m = 0.0) {
  RandomStream random(5, RandomStage::kTest);
  Trajectory path;
  for (int i = 0; i < 400; ++i) {
    const double turn_rad = 2.0 * kPi * i / 400.0;
    const Pose2 base = {3.0 * std::cos(turn_rad), 2.0 * std::sin(2.0 * turn_rad), 3.0 * turn_rad};
    Pose3 camera = CameraOf(base, 1.0 + 0.1 * std::sin(5.0 * turn_rad));
    for (int axis = 0; axis < 3; ++axis) camera.translation[axis] += jitter_m * random.Normal();
    path.push_back({100.0 + 0.1 * i, camera});
  }
  return path;
}

// Poses with other axes: `camera_from_own` of those.
Trajectory OfAxes(Trajectory path, const Eigen::Quaterniond& camera_from_own) {
  for (StampedPose& pose : path) {
    pose.world_from_camera.rotation = pose.world_from_camera.rotation * camera_from_own;
  }
  return path;
}

// A base's x is the camera's z, its y the camera's -x, its z the camera's -y.
Eigen::Quaterniond CameraFromBase(double pitch_down_deg = 0.0) {
  Eigen::Matrix3d level;
  level << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  const Eigen::AngleAxisd down(RadFromDeg(pitch_down_deg), Eigen::Vector3d::UnitX());
  return Eigen::Quaterniond(down * level);
}

// Of rows that are written w x y z and read x y z w.
Trajectory WFirst(Trajectory path) {
  for (StampedPose& pose : path) {
    Eigen::Quaterniond& q = pose.world_from_camera.rotation;
    q = Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y());
  }
  return path;
}

Trajectory Later(Trajectory path, double by_s) {
  for (StampedPose& pose : path) pose.stamp_s += by_s;
  return path;
}

Trajectory Backwards(const Trajectory& path) {
  Trajectory backwards = path;
  for (std::size_t i = 0; i < path.size(); ++i) {
    backwards[i].world_from_camera = path[path.size() - 1 - i].world_from_camera;
  }
  return backwards;
}

std::vector<std::string> DoubtsOf(const Trajectory& truth, const Trajectory& estimate) {
  return DoubtsOfPairs(Associate(truth, estimate), kNames);
}

TEST(TrajectoryDoubts, NoneOfAnEstimateThatErrsAsUsual) {
  EXPECT_THAT(DoubtsOf(Eight(), Eight()), IsEmpty());
  EXPECT_THAT(DoubtsOf(Eight(), Eight(0.03)), IsEmpty());
  EXPECT_THAT(DoubtsOfClock(Eight(), Eight(0.03), kNames), IsEmpty());
  // Nor of a world of its own, as the first camera's.
  Trajectory own = Eight(0.03);
  const Pose3 first_from_world = Inverse(own.front().world_from_camera);
  for (StampedPose& pose : own) pose.world_from_camera = first_from_world * pose.world_from_camera;
  EXPECT_THAT(DoubtsOf(Eight(), own), IsEmpty());
}

TEST(TrajectoryDoubts, PosesOfARobotsBase) {
  EXPECT_THAT(
      DoubtsOf(Eight(), OfAxes(Eight(0.02), CameraFromBase())),
      ElementsAre("estimate: its positions fit truth but its rotations are off by 120 degrees "
                  "throughout, as if they were a robot base's poses (x forward), not a camera's (z "
                  "forward) as truth's; docs/examples/base_poses.awk makes camera poses of them: "
                  "errors of rotation, of motion and with first poses aligned say little"));
  EXPECT_THAT(DoubtsOf(OfAxes(Eight(0.02), CameraFromBase()), Eight()),
              ElementsAre(HasSubstr("as if truth's were a robot base's poses")));
}

// The camera looks 20 degrees down, the base does not.
TEST(TrajectoryDoubts, TheMountOfThatBasesCameraIsTold) {
  EXPECT_THAT(DoubtsOf(Eight(), OfAxes(Eight(), CameraFromBase(20.0))),
              ElementsAre(HasSubstr("docs/examples/base_poses.awk -v pitch=20 makes")));
}

TEST(TrajectoryDoubts, OtherAxes) {
  const Eigen::Quaterniond up_and_back(0.0, 1.0, 0.0, 0.0);  // a half turn about x
  EXPECT_THAT(
      DoubtsOf(Eight(), OfAxes(Eight(0.02), up_and_back)),
      ElementsAre(HasSubstr("off by 180 degrees throughout, turned by 180 degrees about (")));
}

TEST(TrajectoryDoubts, QuaternionsThatBeginWithW) {
  EXPECT_THAT(DoubtsOf(Eight(), WFirst(Eight(0.02))),
              ElementsAre(HasSubstr("and would fit with quaternions that begin with w")));
  EXPECT_THAT(DoubtsOf(Eight(), WFirst(OfAxes(Eight(0.02), CameraFromBase()))),
              ElementsAre(testing::AllOf(HasSubstr("begin with w"), HasSubstr("robot base's"))));
}

// An upside-down world has a warning of its own, and turns no rotation against another.
TEST(TrajectoryDoubts, NoneOfAWorldWhoseZPointsDown) {
  Trajectory flipped = Eight(0.02);
  const Pose3 half_turn{Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0), Eigen::Vector3d::Zero()};
  for (StampedPose& pose : flipped) pose.world_from_camera = half_turn * pose.world_from_camera;
  EXPECT_THAT(DoubtsOf(Eight(), flipped), IsEmpty());
  EXPECT_TRUE(FitsUpsideDown(Associate(Eight(), flipped)));
}

// Positions on a line do not tell how it is turned about itself.
TEST(TrajectoryDoubts, OfALineOnlyWhatALevelWorldTells) {
  Trajectory line = Eight(), noisy = Eight(0.02);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector3d on_line(0.02 * static_cast<double>(i), 0.0, 1.0);
    noisy[i].world_from_camera.translation += on_line - line[i].world_from_camera.translation;
    line[i].world_from_camera = CameraOf({on_line.x(), 0.0, 0.0}, 1.0);
    noisy[i].world_from_camera.rotation = line[i].world_from_camera.rotation;
  }
  EXPECT_THAT(DoubtsOf(line, noisy), IsEmpty());
  EXPECT_THAT(DoubtsOf(line, OfAxes(noisy, CameraFromBase())),
              ElementsAre(HasSubstr("a robot base's poses")));
}

TEST(TrajectoryDoubts, StandingStillOrBackwardsOrOfAnotherScale) {
  Trajectory frozen = Eight(), small = Eight();
  for (StampedPose& pose : frozen) pose.world_from_camera = frozen.front().world_from_camera;
  for (StampedPose& pose : small) pose.world_from_camera.translation *= 0.5;
  EXPECT_THAT(DoubtsOf(Eight(), frozen), ElementsAre(HasSubstr("estimate: does not move")));
  EXPECT_THAT(DoubtsOf(Eight(), small),
              ElementsAre(HasSubstr("fits truth best if made 2 times as large")));
  EXPECT_THAT(DoubtsOf(Eight(), Backwards(Eight(0.02))),
              ElementsAre(HasSubstr("estimate: runs backwards in time against truth: in reverse "
                                    "order its poses fit")));
  // Whose positions fit backwards too, upside down.
  EXPECT_THAT(DoubtsOf(Eight(), Later(Eight(), 1.0)), IsEmpty());
}

TEST(ClockCheck, FindsTheOffsetEitherWay) {
  for (const double late_s : {-4.0, -0.35, -0.02, 0.02, 1.0, 4.9}) {
    SCOPED_TRACE(late_s);
    const auto found = FindClockOffset(Eight(), Later(Eight(0.005), late_s));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->offset_s, -late_s, 0.006);
    EXPECT_LT(found->better_misfit_m, 0.7 * found->misfit_m);
  }
  EXPECT_FALSE(FindClockOffset(Eight(), Later(Eight(), 9.0)));  // further than is looked for
  EXPECT_THAT(DoubtsOfClock(Eight(), Later(Eight(), 1.0), kNames),
              ElementsAre(HasSubstr("estimate: its stamps seem 1.000 s late: with -1.000 s added "
                                    "(--time-offset of eval trajectory) it fits truth to ")));
}

// Between two steps of the search, of an estimate that errs: no other one that is rounder.
TEST(ClockCheck, AnOffsetIsAsExactAsPosesTell) {
  for (const double noise_m : {0.005, 0.02, 0.05}) {
    for (const double late_s : {0.25, 0.35, -0.65, 0.435}) {
      const auto found = FindClockOffset(Eight(), Later(Eight(noise_m), late_s));
      ASSERT_TRUE(found) << noise_m << " " << late_s;
      EXPECT_NEAR(found->offset_s, -late_s, 0.02) << noise_m;
      EXPECT_LE(std::abs(found->offset_s + late_s), found->unsure_s + 0.011) << noise_m;
    }
  }
}

// A walk of 1 cm a pose along each axis.
Trajectory Drifting(std::uint64_t seed) {
  RandomStream random(seed, RandomStage::kTest);
  Trajectory drifting = Eight();
  Eigen::Vector3d drift_m = Eigen::Vector3d::Zero();
  for (StampedPose& pose : drifting) {
    for (int axis = 0; axis < 3; ++axis) drift_m[axis] += 0.01 * random.Normal();
    pose.world_from_camera.translation += drift_m;
  }
  return drifting;
}

// Drift that grows towards the ends is no clock's.
TEST(ClockCheck, DriftIsNoOffset) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_FALSE(FindClockOffset(Eight(), Drifting(seed))) << seed;
  }
}

// The Eight with headings that err by up to so much, one way and back.
Trajectory Bent(double size_rad) {
  const Trajectory truth = Eight();
  Trajectory bent = {truth.front()};
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Pose3& last = truth[i - 1].world_from_camera;
    const Pose3& next = truth[i].world_from_camera;
    const double turn_rad = size_rad * std::cos(2.0 * kPi * static_cast<double>(i) / 400.0);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()));
    const Eigen::Vector3d at =
        bent.back().world_from_camera.translation + turn * (next.translation - last.translation);
    bent.push_back({truth[i].stamp_s, {turn * next.rotation, at}});
  }
  return bent;
}

// As a whole it fits better half a second and more earlier or later, its stretches do not.
TEST(ClockCheck, ABentEstimateIsNotLate) {
  for (const double size_rad : {-0.7, -0.4, -0.2, 0.2, 0.4, 0.7}) {
    EXPECT_FALSE(FindClockOffset(Eight(), Bent(size_rad))) << size_rad;
  }
}

// A laser ahead of its robot's base that looks to the left: laid over each other by their
// positions, the paths lie turned.
TEST(LeverCheck, TheArmIsNoPartOfTheRotation) {
  Trajectory truth, base;
  for (int i = 0; i < 200; ++i) {
    const double at_rad = RadFromDeg(300.0) * i / 200;
    const Pose2 robot = {std::cos(at_rad) + 0.1 * at_rad, std::sin(at_rad), at_rad + 1.57};
    base.push_back({0.1 * i, Lift(robot)});
    truth.push_back({0.1 * i, Lift(robot * Pose2{0.5, 0.0, RadFromDeg(40.0)})});
  }
  EXPECT_THAT(
      DoubtsOf(truth, base),
      ElementsAre(HasSubstr("its rotations are off by 40 degrees throughout, turned by 40 ")));
}

TEST(LeverCheck, FindsThePointOfTheRobot) {
  const Eigen::Vector3d laser_m(0.1, -0.05, 0.4);
  Trajectory moved = Eight(0.003);
  for (StampedPose& pose : moved) {
    Pose3& own = pose.world_from_camera;
    own.translation += own.rotation * laser_m;
  }
  const auto found = FindLeverArm(Associate(Eight(), moved));
  ASSERT_TRUE(found);
  // The camera turns about its y axis alone, along which nothing tells how far.
  EXPECT_NEAR(found->arm_m.x(), -0.1, 0.002);
  EXPECT_NEAR(found->arm_m.y(), 0.0, 0.002);
  EXPECT_NEAR(found->arm_m.z(), -0.4, 0.002);
  EXPECT_LT(found->better_misfit_m, 0.01);
  EXPECT_THAT(DoubtsOfClock(Eight(), moved, kNames),
              ElementsAre(HasSubstr("estimate: its poses seem to be of another point of the robot "
                                    "than truth's, as a laser's or a camera's are beside its "
                                    "base's: moved by (-0.1")));
}

// Nor is drift an arm, whichever way it goes.
TEST(LeverCheck, DriftIsNoArm) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_FALSE(FindLeverArm(Associate(Eight(), Drifting(seed)))) << seed;
  }
}

// SLAM's drift over a few poses goes with their turn too.
TEST(LeverCheck, ShortStretchesDoNotTellAnArm) {
  Trajectory moved = Eight();
  for (StampedPose& pose : moved) {
    Pose3& own = pose.world_from_camera;
    own.translation += own.rotation * Eigen::Vector3d(0.4, 0.0, 0.0);
  }
  const auto said = [&](std::size_t poses) {
    const Trajectory some(moved.begin(), moved.begin() + static_cast<std::ptrdiff_t>(poses));
    return DoubtsOfClock(Eight(), some, kNames);
  };
  EXPECT_THAT(said(20), IsEmpty());  // 1.3 m with 51 degrees in them
  EXPECT_THAT(said(50), ElementsAre(HasSubstr("another point of the robot")));  // 132 degrees
  // Nor do many poses in one place.
  EXPECT_FALSE(TellsArmFromDrift(std::vector<PosePair>(100, PosePair{})));
  EXPECT_FALSE(TellsArmFromDrift({}));
}

TEST(TimeCoverage, OfGapsAndEnds) {
  const Trajectory truth = Eight();
  const auto coverage = [&](const Trajectory& estimate) {
    return TimeCoverage(truth, Associate(truth, estimate));
  };
  EXPECT_EQ(coverage(truth), 1.0);
  EXPECT_EQ(coverage({truth.begin(), truth.begin() + 40}), 0.1);
  Trajectory sparse, gap;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i % 30 == 0) sparse.push_back(truth[i]);
    if (i < 100 || i >= 200) gap.push_back(truth[i]);
  }
  EXPECT_EQ(coverage(sparse), 391.0 / 400.0);  // to the last of them
  EXPECT_EQ(coverage(gap), 0.75);
}

class TrajectoryCommands : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Save("truth.txt", Eight());
    Save("estimate.txt", Eight(0.01));
    Save("base.txt", OfAxes(Eight(0.01), CameraFromBase()));
    Save("late.txt", Later(Eight(0.01), 1.0));
    Save("between.txt", Later(Eight(0.01), 1.05));
    Save("afternoon.txt", Later(Eight(0.01), 50000.0));
    const Trajectory truth = Eight();
    Save("lost.txt", {truth.begin(), truth.begin() + 40});
  }
  void Save(const std::string& name, const Trajectory& path) const {
    Write(name, TrajectoryText(path));
  }
};

TEST_F(TrajectoryCommands, EvalTrajectoryAndSlamFitSayIt) {
  for (const std::string command : {"eval trajectory truth.txt ", "slam-fit truth.txt "}) {
    EXPECT_EQ(Program(command + "estimate.txt").err, "");
    EXPECT_THAT(Program(command + "base.txt").err,
                HasSubstr("base.txt: its positions fit truth.txt"));
    EXPECT_THAT(Program(command + "late.txt").err, HasSubstr("late.txt: its stamps seem 1.00"));
  }
}

TEST_F(TrajectoryCommands, ATimeOffsetTakesAnotherClockAway) {
  const Outcome mended = Program("eval trajectory truth.txt late.txt --time-offset -1");
  EXPECT_EQ(mended.err, "");
  EXPECT_EQ(mended.out, Program("eval trajectory truth.txt estimate.txt").out);
  EXPECT_THAT(Program("eval trajectory truth.txt late.txt --time-offset -1.2").err,
              HasSubstr("seem 0.200 s early: with -1.000 s added"));
  const Outcome none = Program("eval trajectory truth.txt between.txt");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("between.txt: shares no stamp with truth.txt (within 0.01 s): it "
                                  "is from 101.050 to 140.950 s, that one from 100.000 to 139.900 "
                                  "s; --max-difference S takes stamps further apart, --time-offset "
                                  "-1.05"));
  const Outcome apart = Program("eval trajectory truth.txt afternoon.txt");
  EXPECT_THAT(apart.err, HasSubstr("--time-offset -50000.000 makes the first of both coincide\n"));
  EXPECT_EQ(Program("eval trajectory truth.txt afternoon.txt --time-offset -50000").err, "");
}

TEST_F(TrajectoryCommands, AnEstimateThatStopsEarlyIsSaid) {
  const Outcome lost = Program("eval trajectory truth.txt lost.txt");
  EXPECT_EQ(lost.err,
            "depthgrid: warning: lost.txt: covers 10 % of truth.txt's time; the errors are of that "
            "alone\n");
  EXPECT_THAT(Program("eval trajectory truth.txt lost.txt --json").out,
              HasSubstr("\"time_coverage\": 0.1,"));
}

}  // namespace
}  // namespace depthgrid
