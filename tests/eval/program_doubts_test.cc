// What `map` advises where poses and images do not fit together.
#include <gmock/gmock.h>

#include "mapper/io/trajectory_file.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

using ProgramDoubts = ProgramTest;

// Not twice: poses that are read the wrong way go other ways than the map as well.
TEST_F(ProgramDoubts, AnotherScaleOrMountIsNamedAsItIs) {
  Succeed("render ./small.yaml --no-colour --set frames=150 -o long");
  const Trajectory truth = ReadTrajectory(Path("long/groundtruth.txt"));
  const auto said_of = [&](const auto& change) {
    Trajectory poses = truth;
    for (StampedPose& pose : poses) change(pose.world_from_camera);
    WriteTrajectory(Path("poses.txt"), poses);
    const Outcome outcome = Program("map long --poses poses.txt -o out --force");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(said_of([](Pose3& pose) { pose.translation *= 2.0; }),
              AllOf(ContainsRegex("with images (1\\.9[0-9]*|2|2\\.0[0-9]*) times as deep"),
                    Not(HasSubstr("over the same stretches"))));
  // The camera looks down from what the poses say.
  const Eigen::Quaterniond up(Eigen::AngleAxisd(RadFromDeg(20.0), Eigen::Vector3d::UnitX()));
  EXPECT_THAT(said_of([&](Pose3& pose) { pose.rotation = pose.rotation * up; }),
              HasSubstr("with a camera that looks about 20 degrees below the poses' z axis"));
  EXPECT_THAT(said_of([&](Pose3& pose) { pose.rotation = pose.rotation * up.conjugate(); }),
              HasSubstr("with a camera that looks about 20 degrees above the poses' z axis"));
  // What only an experiment knows.
  const Outcome refused = Program("map long -o b --set mapper.fusion.slam_noise.source=profile");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("source is profile, must be another one: of a recording no"));
}

// Poses in millimetres span too large a map: what was noticed of them before comes first.
TEST_F(ProgramDoubts, AreToldWhereTheMapFails) {
  Succeed("render ./small.yaml --no-colour -o seq");
  Trajectory poses = ReadTrajectory(Path("seq/groundtruth.txt"));
  double along_m = 0.0;
  for (StampedPose& pose : poses) {
    pose.world_from_camera.translation = {along_m, along_m, 1.2};
    along_m += 2000.0;
  }
  WriteTrajectory(Path("poses.txt"), poses);
  const Outcome outcome = Program("map seq --poses poses.txt -o out");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, ContainsRegex("warning: poses.txt: the camera moves at [0-9]+ m/s: are "
                                         "the poses in metres(.|\n)*\ndepthgrid: map: spans"));
  EXPECT_FALSE(std::filesystem::exists(Path("out")));
}

// Where nothing of the room is in reach, the scale that the images were read with may be why.
TEST_F(ProgramDoubts, NameTheScaleOfImagesThatShowTooMuch) {
  Succeed("render ./small.yaml --no-colour -o seq");
  const Outcome outcome = Program("map seq --up z -o out --set sequence.recording.depth_scale=250");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, ContainsRegex("show depth from [0-9.]+ to [0-9.]+ m, read with 250 "
                                         "units a metre \\(depth_scale\\)\n"));
}

}  // namespace
}  // namespace depthgrid
