#include "mapper/io/slam_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "mapper/core/error.h"
#include "mapper/core/rng.h"
#include "mapper/io/file.h"
#include "mapper/io/trajectory_file.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

Pose3 RandomPose(RandomStream& random) {
  const Eigen::Vector3d turn(random.Normal(), random.Normal(), random.Normal());
  return {ExpRotation(turn), {random.Normal(), random.Normal(), random.Normal()}};
}

// Twelve frames: 4 and 5 lost, relocalised at 6, loops at 8 (two at once, one that moved nothing)
// and 10.
SlamOutput Example() {
  RandomStream random(5, RandomStage::kTest);
  SlamOutput output;
  for (int i = 0; i < 12; ++i) {
    const double stamp_s = std::round(i / 30.0 * 1e6) / 1e6;
    const bool lost = i == 4 || i == 5;
    const int epoch = (i >= 6 ? 1 : 0) + (i >= 8 ? 1 : 0);
    output.live.push_back({stamp_s, std::nullopt, epoch});
    if (lost) continue;
    output.live.back().slam_from_camera = RandomPose(random);
    output.final.push_back({stamp_s, RandomPose(random)});
  }
  output.loops.push_back({8, 0, 7, RandomPose(random), 0.011, 0.1 / 3.0});
  output.loops.push_back({8, 2, 8, RandomPose(random), 0.02, 0.01});
  output.loops.push_back({10, 3, 9, RandomPose(random), 0.02, 0.01});
  return output;
}

std::vector<double> Stamps(const SlamOutput& output) {
  std::vector<double> stamps_s;
  for (const SlamPose& pose : output.live) stamps_s.push_back(pose.stamp_s);
  return stamps_s;
}

class SlamFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = ::testing::TempDir() + "slam_files_" +
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  SlamFilePaths Paths() const {
    return {folder_ + "/slam.txt", folder_ + "/slam_final.txt", folder_ + "/loops.csv"};
  }
  std::string ErrorOf(const std::string& loops) {
    const SlamOutput example = Example();
    WriteSlamFiles(folder_, example);
    WriteFile(folder_ + "/loops.csv", loops);
    try {
      ReadSlamFiles(Paths(), Stamps(example));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  std::string folder_;
};

TEST_F(SlamFiles, ReadBackTheVerySameOutput) {
  const SlamOutput written = Example();
  WriteSlamFiles(folder_, written);
  const SlamOutput read = ReadSlamFiles(Paths(), Stamps(written));
  EXPECT_EQ(read.live, written.live);
  EXPECT_EQ(read.final, written.final);
  EXPECT_EQ(read.loops, written.loops);
  const std::string bytes = ReadFile(folder_ + "/loops.csv");
  WriteSlamFiles(folder_, read);
  EXPECT_EQ(ReadFile(folder_ + "/loops.csv"), bytes);
  EXPECT_THAT(bytes, HasSubstr("\nrelocalisation,6,1,,,"));
  EXPECT_THAT(bytes, HasSubstr("\nloop,8,2,0,7,"));
  EXPECT_THAT(bytes, HasSubstr("\nloop,10,2,3,9,"));
}

TEST_F(SlamFiles, ALiveTrajectoryAloneIsEnough) {
  const SlamOutput written = Example();
  WriteSlamFiles(folder_, written);
  const SlamOutput read = ReadSlamFiles({Paths().live, "", ""}, Stamps(written));
  EXPECT_EQ(read.final, ReadTrajectory(Paths().live));
  EXPECT_EQ(read.live[7].slam_from_camera, written.live[7].slam_from_camera);
  EXPECT_EQ(read.live[7].epoch, 0);
  EXPECT_TRUE(read.loops.empty());
}

TEST_F(SlamFiles, RefuseWhatCannotBe) {
  EXPECT_THAT(ErrorOf("kind\nloop,8,1\n"), HasSubstr("loops.csv:2: has 3 columns, must have 14"));
  EXPECT_THAT(ErrorOf("leap,8,1,,,,,,,,,,,"),
              HasSubstr("loops.csv:1: kind is 'leap', must be loop or relocalisation"));
  EXPECT_THAT(ErrorOf("relocalisation,12,1,,,,,,,,,,,"),
              HasSubstr("frame 12 is not among the 12 input frames"));
  EXPECT_THAT(ErrorOf("relocalisation,4,1.5,,,,,,,,,,,"), HasSubstr("must be a whole number"));
  EXPECT_THAT(ErrorOf("loop,8,1,0,9,0,0,0,0,0,0,1,0.1,0.1"),
              HasSubstr("cannot be reported before the frames it joins"));
  EXPECT_THAT(ErrorOf("loop,8,1,0,7,0,0,nan,0,0,0,1,0.1,0.1"),
              HasSubstr("column 8 is 'nan', must be a finite number"));
  EXPECT_THAT(ErrorOf("loop,8,1,0,7,0,0,0,0,0,0,2,0.1,0.1"), HasSubstr("norm 2, must be 1"));
  EXPECT_THAT(ErrorOf("loop,8,1,0,7,0,0,0,0,0,0,1,0,0.1"), HasSubstr("must be above 0"));
  EXPECT_THAT(ErrorOf("relocalisation,8,1,,,,,,,,,,,\nrelocalisation,6,2,,,,,,,,,,,"),
              HasSubstr("loops.csv:2: frames and epochs must not go down"));
}

TEST_F(SlamFiles, RefusePosesOfOtherFrames) {
  const SlamOutput written = Example();
  WriteSlamFiles(folder_, written);
  std::vector<double> stamps_s = Stamps(written);
  for (double& stamp_s : stamps_s) stamp_s += 100.0;
  EXPECT_THROW(ReadSlamFiles(Paths(), stamps_s), InputError);
}

}  // namespace
}  // namespace depthgrid
