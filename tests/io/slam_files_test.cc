#include "mapper/io/slam_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "mapper/core/error.h"
#include "mapper/core/rng.h"
#include "mapper/io/file.h"
#include "mapper/io/trajectory_file.h"
#include "tests/refusal.h"
#include "tests/scratch.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

// Near the others, so that no step between two is a jump.
Pose3 RandomPose(RandomStream& random) {
  const auto small = [&] { return 0.005 * random.Normal(); };
  const Eigen::Vector3d turn(small(), small(), small());
  return {ExpRotation(turn), {small(), small(), small()}};
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

std::vector<std::string> Lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

class SlamFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = ScratchPath();
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
    return RefusalOf([&] { ReadSlamFiles(Paths(), {Stamps(example)}); });
  }
  std::string folder_;
};

TEST_F(SlamFiles, ReadBackTheVerySameOutput) {
  const SlamOutput written = Example();
  WriteSlamFiles(folder_, written);
  const SlamOutput read = ReadSlamFiles(Paths(), {Stamps(written)}).slam;
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

TEST_F(SlamFiles, ARelocalisationStaysBesideALoopOfItsFrame) {
  SlamOutput written = Example();
  written.loops.insert(written.loops.begin(), {6, 1, 6, Pose3{}, 0.02, 0.01});
  WriteSlamFiles(folder_, written);
  EXPECT_THAT(ReadFile(folder_ + "/loops.csv"),
              AllOf(HasSubstr("\nrelocalisation,6,1,,,,,,,,,,,,0.200000,,\nloop,6,1,1,6,"),
                    Not(HasSubstr("relocalisation,8"))));
  const SlamOutput read = ReadSlamFiles(Paths(), {Stamps(written)}).slam;
  EXPECT_EQ(read.live, written.live);
  EXPECT_EQ(read.loops, written.loops);
}

TEST_F(SlamFiles, ALiveTrajectoryAloneIsEnough) {
  const SlamOutput written = Example();
  WriteSlamFiles(folder_, written);
  const SlamOutput read = ReadSlamFiles({Paths().live, "", ""}, {Stamps(written)}).slam;
  EXPECT_EQ(read.final, ReadTrajectory(Paths().live));
  EXPECT_EQ(read.live[7].slam_from_camera, written.live[7].slam_from_camera);
  EXPECT_EQ(read.live[7].epoch, 0);
  EXPECT_TRUE(read.loops.empty());
}

TEST_F(SlamFiles, RefuseWhatCannotBe) {
  EXPECT_THAT(ErrorOf("loop,8,1\n"), HasSubstr("loops.csv:1: has 3 columns, must have 14 or 17"));
  EXPECT_THAT(ErrorOf("leap,8,1,,,,,,,,,,,"),
              HasSubstr("loops.csv:1: kind is 'leap', must be loop or relocalisation"));
  EXPECT_THAT(ErrorOf(""), HasSubstr("loops.csv: is empty"));
  EXPECT_THAT(ErrorOf("kind,frame,ep"), HasSubstr("loops.csv:1: has 3 columns"));
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

// Stamps in nanoseconds: the first one is 0 in any unit.
TEST_F(SlamFiles, PosesOfHardlyAnyFrameAreSaidWithTheStamps) {
  const SlamOutput example = Example();
  Trajectory nanoseconds = example.final;
  for (StampedPose& pose : nanoseconds) pose.stamp_s *= 1e9;
  WriteTrajectory(Paths().live, nanoseconds);
  const std::string said =
      Paths().live + ": gives 1 of 12 frames a pose: images from 0.000 to 0.367 s, poses from " +
      "0.000 to 366667000.000 s; are both in seconds?";
  for (const bool interpolate : {false, true}) {
    const SlamInput input =
        ReadSlamFiles({Paths().live, "", ""}, {Stamps(example)}, {0.02, interpolate, 0.2});
    EXPECT_THAT(input.warnings, testing::Contains(said)) << interpolate;
  }
  WriteSlamFiles(folder_, example);
  EXPECT_THAT(ReadSlamFiles(Paths(), {Stamps(example)}).warnings, testing::IsEmpty());
}

// ICL-NUIM's images have their numbers for stamps.
TEST_F(SlamFiles, PosesInSecondsOfNumberedImagesAreSaid) {
  const auto said = [&](const FrameNames& frames, const Trajectory& poses) {
    WriteTrajectory(Paths().live, poses);
    std::string all;
    for (const std::string& line : ReadSlamFiles({Paths().live, "", ""}, frames).warnings) {
      all += line + "\n";
    }
    return all;
  };
  const SlamOutput example = Example();
  FrameNames frames;
  for (int i = 0; i < 12; ++i) frames.stamps_s.push_back(i);
  EXPECT_THAT(said(frames, example.final),
              HasSubstr("gives 1 of 12 frames a pose: images from 0.000 to 11.000 s, poses from "
                        "0.000 to 0.367 s; the images' stamps are their numbers, the poses' look "
                        "like seconds, 30 a second: a pose's must be its image's number\n"));
  // The other way round.
  FrameNames timed;
  for (int i = 0; i < 12; ++i) timed.stamps_s.push_back(100.0 + i / 30.0);
  Trajectory numbered = example.final;
  for (std::size_t i = 0; i < numbered.size(); ++i) numbered[i].stamp_s = static_cast<double>(i);
  WriteTrajectory(Paths().live, numbered);
  try {
    ReadSlamFiles({Paths().live, "", ""}, timed);
    ADD_FAILURE() << "numbers are no seconds";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("the poses' stamps are numbers, the images' look like seconds, 30 a "
                          "second: a pose's must be its image's stamp"));
  }
  // Whole seconds: of poses that are not one an image, of stamps that do not begin with 0.
  Trajectory dense;
  for (int i = 0; i < 40; ++i) dense.push_back({0.1 * i, example.final.front().world_from_camera});
  EXPECT_THAT(said(frames, dense),
              HasSubstr("only 4 images are between the first pose and the last\n"));
  for (double& stamp_s : frames.stamps_s) stamp_s += 1.0;
  Trajectory later = example.final;
  for (StampedPose& pose : later) pose.stamp_s += 1.0;
  EXPECT_THAT(said(frames, later),
              HasSubstr("only 1 image is between the first pose and the last\n"));
}

// Its own stamps are named: each frame of the part has a place among the poses, but no pose.
TEST_F(SlamFiles, AFileThatGivesThePartNoPoseIsRefusedWithItsStamps) {
  const SlamOutput example = Example();
  WriteTrajectory(Paths().live, {example.final.begin(), example.final.begin() + 3});
  FrameNames frames{Stamps(example)};
  frames.part.begin = 9;
  for (const bool interpolate : {false, true}) {
    EXPECT_EQ(RefusalOf([&] {
                ReadSlamFiles({Paths().live, "", ""}, frames, {0.02, interpolate, 0.2});
              }),
              Paths().live +
                  ": no pose within 0.02 s of any image: images from 0.000 to 0.367 s, "
                  "the part's from 0.300 to 0.367 s, poses from 0.000 to 0.067 s; none "
                  "are of the part");
  }
}

// A file of positions alone has the columns of a matrix's rows.
TEST_F(SlamFiles, WhatIsNoMatrixMayBeAMistakenTrajectory) {
  WriteFile(Paths().live, "0 1 2 1\n1 1.1 2 1\n2 1.2 2 1\n");
  try {
    ReadSlamFiles({Paths().live, "", ""}, {Stamps(Example())});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("slam.txt:"), HasSubstr("the matrix"),
                                    HasSubstr("a TUM trajectory has 8 columns"),
                                    HasSubstr("with decimal points")));
  }
}

TEST_F(SlamFiles, RefusePosesOfOtherFrames) {
  const SlamOutput written = Example();
  WriteSlamFiles(folder_, written);
  std::vector<double> stamps_s = Stamps(written);
  for (double& stamp_s : stamps_s) stamp_s += 100.0;
  EXPECT_THROW(ReadSlamFiles(Paths(), {stamps_s}), InputError);
}

TEST_F(SlamFiles, PosesBesideTheFramesAreCountedAndSurvived) {
  const SlamOutput written = Example();
  WriteSlamFiles(folder_, written);
  std::vector<double> stamps_s = Stamps(written);
  stamps_s.erase(stamps_s.begin() + 8);  // its image is missing
  const SlamInput read = ReadSlamFiles({Paths().live, Paths().final, ""}, {stamps_s});
  EXPECT_EQ(read.slam.live.size(), 11U);
  EXPECT_EQ(read.slam.live[8].slam_from_camera, written.live[9].slam_from_camera);
  ASSERT_EQ(read.warnings.size(), 2U);
  EXPECT_THAT(read.warnings[0], HasSubstr("slam.txt: 1 pose with the stamp of no input frame"));
}

TEST_F(SlamFiles, MatricesTakeTheFramesStampsInOrder) {
  WriteFile(folder_ + "/kitti.txt",
            "1 0 0 0.1 0 1 0 0 0 0 1 0\nnan 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0.3 0 1 0 0 0 0 1 0\n");
  const SlamInput read = ReadSlamFiles({folder_ + "/kitti.txt", "", ""}, {{5.0, 6.0, 7.0, 8.0}});
  EXPECT_EQ(read.slam.live[0].slam_from_camera->translation.x(), 0.1);
  EXPECT_FALSE(read.slam.live[1].slam_from_camera);
  EXPECT_EQ(read.slam.live[2].slam_from_camera->translation.x(), 0.3);
  EXPECT_FALSE(read.slam.live[3].slam_from_camera);
  ASSERT_EQ(read.warnings.size(), 2U);
  EXPECT_THAT(read.warnings[0], HasSubstr("1 pose with NaN"));
  EXPECT_THAT(read.warnings[1], HasSubstr("3 poses for 4 frames"));
}

TEST_F(SlamFiles, PosesOfWhichNoneCanBeUsedSayWhy) {
  const std::string path = folder_ + "/poses.txt";
  const auto error = [&](const std::string& text) {
    WriteFile(path, text);
    return RefusalOf([&] { ReadSlamFiles({path, "", ""}, {{1.0, 2.0}}); });
  };
  const std::string all_are =
      path + ": holds no pose that can be used, all 2 are left out; first: ";
  const std::string only_is =
      path + ": holds no pose that can be used, the only one is left out; first: ";
  EXPECT_EQ(error("# none\n"), path + ": holds no pose");
  EXPECT_EQ(
      error("1 1e12 0 0 0 0 0 1\n"),
      only_is + path + ":1: the position is (1e+12, 0, 0), must be finite and within 10,000 km");
  EXPECT_EQ(
      error("1 0 0 -2e7 0 1 0 0 0 0 1 0\nnan 0 0 0 0 1 0 0 0 0 1 0\n"),
      all_are + path + ":1: the position is (-2e+07, 0, 0), must be finite and within 10,000 km");
  EXPECT_EQ(error("nan 0 0 0 0 1 0 0 0 0 1 0\n"), only_is + path + ":1: the matrix must be finite");
  EXPECT_EQ(error("0 0 0 0 0 0 0 0 0 0 0 0\n"),
            only_is + path + ":1: the matrix's upper left 3x3 is zero, must be a rotation");
}

// Poses of other stamps than the frames', none of them across a correction.
TEST_F(SlamFiles, FramesTakeWhatLiesBetweenThePoses) {
  WriteFile(folder_ + "/dense.txt",
            "0.00 0 0 0 0 0 0 1\n0.01 1 0 0 0 0 0 1\n0.02 2 0 0 0 0 0 1\n0.03 3 0 0 0 0 0 1\n"
            "0.04 4 0 0 0 0 0 1\n");
  WriteFile(folder_ + "/loops.csv", "loop,2,1,0,2,0,0,0,0,0,0,1,0.1,0.1\n");
  const SlamInput read = ReadSlamFiles({folder_ + "/dense.txt", "", folder_ + "/loops.csv"},
                                       {{0.002, 0.027, 0.032}}, {0.004, true});
  ASSERT_EQ(read.slam.live.size(), 3U);
  EXPECT_NEAR(read.slam.live[0].slam_from_camera->translation.x(), 0.2, 1e-9);
  EXPECT_NEAR(read.slam.live[1].slam_from_camera->translation.x(), 2.7, 1e-9);
  EXPECT_FALSE(read.slam.live[2].slam_from_camera);  // the pose after it is of the next epoch
  EXPECT_EQ(read.slam.live[2].epoch, 1);
  EXPECT_EQ(read.slam.loops[0].second_frame, 2);
  EXPECT_TRUE(read.warnings.empty());
}

// The pose at the stamp of the frame that begins an epoch is the epoch's own.
TEST_F(SlamFiles, AnEpochBeginsWithThePoseOfItsFrame) {
  WriteFile(folder_ + "/dense.txt",
            "0.00 0 0 0 0 0 0 1\n0.01 1 0 0 0 0 0 1\n0.02 2 0 0 0 0 0 1\n0.03 3 0 0 0 0 0 1\n");
  WriteFile(folder_ + "/loops.csv", "loop,2,1,0,2,0,0,0,0,0,0,1,0.1,0.1\n");
  const SlamInput read = ReadSlamFiles({folder_ + "/dense.txt", "", folder_ + "/loops.csv"},
                                       {{0.0, 0.01, 0.02, 0.025}}, {0.004, true});
  ASSERT_TRUE(read.slam.live[3].slam_from_camera);
  EXPECT_NEAR(read.slam.live[3].slam_from_camera->translation.x(), 2.5, 1e-9);
}

TEST_F(SlamFiles, OfPosesOfOneFrameTheNearestIsTaken) {
  WriteFile(folder_ + "/dense.txt",
            "0.0 0 0 0 0 0 0 1\n0.096 1 0 0 0 0 0 1\n0.101 2 0 0 0 0 0 1\n"
            "0.108 3 0 0 0 0 0 1\n");
  const SlamInput read =
      ReadSlamFiles({folder_ + "/dense.txt", "", ""}, {{0.0, 0.1}}, {0.02, false});
  EXPECT_EQ(read.slam.live[1].slam_from_camera->translation.x(), 2.0);
  EXPECT_THAT(read.warnings, testing::Contains(HasSubstr("2 poses beside a nearer one")));
}

// Rows of loops.csv without their stamps, as before there were any.
std::string WithoutStamps(const std::string& csv) {
  std::string text;
  for (const std::string& row : Lines(csv)) {
    std::size_t end = row.size();
    for (int i = 0; i < 3; ++i) end = row.rfind(',', end - 1);
    text += row.substr(0, end) + "\n";
  }
  return text;
}

// Frames that were dropped since do not move the others, whether they are named by number or stamp.
TEST_F(SlamFiles, LoopsKeepTheirFramesWhenOthersAreDropped) {
  const SlamOutput written = Example();
  WriteSlamFiles(folder_, written);
  const std::string csv = ReadFile(Paths().loops);
  FrameNames frames{Stamps(written), {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}};
  for (const std::size_t dropped : {8U, 1U}) {
    frames.stamps_s.erase(frames.stamps_s.begin() + static_cast<std::ptrdiff_t>(dropped));
    frames.numbers.erase(frames.numbers.begin() + static_cast<std::ptrdiff_t>(dropped));
  }
  const std::vector<std::string> texts = {csv, WithoutStamps(csv), csv};
  for (std::size_t i = 0; i < texts.size(); ++i) {
    WriteFile(Paths().loops, texts[i]);
    if (i == 2) frames.numbers.clear();  // the stamps alone say it as well
    const SlamInput read = ReadSlamFiles(Paths(), frames);
    ASSERT_EQ(read.slam.loops.size(), 2U);
    EXPECT_EQ(read.slam.loops[0].second_frame, 6);       // 7
    EXPECT_EQ(read.slam.loops[0].reported_at_frame, 7);  // 8 is not there, 9 is
    EXPECT_EQ(read.slam.loops[1].first_frame, 2);        // 3
    EXPECT_EQ(read.slam.loops[1].second_frame, 7);       // 9
    EXPECT_EQ(read.slam.live[6].epoch, 1);
    EXPECT_EQ(read.slam.live[7].epoch, 2);
    EXPECT_THAT(read.warnings[0], HasSubstr("loops.csv: 1 event of frames that the recording"));
  }
}

// Every other row taken out of the recording: the loop's newer frame with them, its jump stays.
TEST_F(SlamFiles, AJumpIsKeptWhereTheLoopsFrameIsGone) {
  SlamOutput written = Example();
  written.loops = {written.loops[0]};
  WriteSlamFiles(folder_, written);
  FrameNames frames;
  for (std::size_t i = 0; i < 12; i += 2) frames.stamps_s.push_back(Stamps(written)[i]);
  WriteFile(Paths().loops, Lines(ReadFile(Paths().loops))[0] +
                               "\nloop,9,1,0,9,0,0,0,0,0,0,1,0.1,0.1," +
                               "0.300000,0.000000,0.300000\n");
  const SlamInput read = ReadSlamFiles(Paths(), frames);
  EXPECT_TRUE(read.slam.loops.empty());
  EXPECT_EQ(read.slam.live[4].epoch, 0);
  EXPECT_EQ(read.slam.live[5].epoch, 1);
}

TEST_F(SlamFiles, StampsOfAnotherRecordingLeaveItToTheNumbers) {
  const SlamOutput written = Example();
  WriteSlamFiles(folder_, written);
  FrameNames frames{Stamps(written)};
  for (double& stamp_s : frames.stamps_s) stamp_s += 1.0;
  const SlamInput read = ReadLoops(Paths().loops, frames, 0.01);
  EXPECT_EQ(read.slam.loops, written.loops);
}

// A long file with a bad row, and one that was cut.
TEST_F(SlamFiles, DamagedAndCutRowsOfLoopsAreCounted) {
  const SlamOutput written = Example();
  WriteSlamFiles(folder_, written);
  std::string csv = ReadFile(Paths().loops);
  WriteFile(Paths().loops, csv.substr(0, csv.size() - 60));
  EXPECT_THAT(ReadSlamFiles(Paths(), {Stamps(written)}).warnings,
              ElementsAre(AllOf(HasSubstr("loops.csv: 1 damaged row left out (first: "),
                                HasSubstr("loops.csv:5: has "))));
  WriteFile(Paths().loops, csv.substr(0, csv.size() - 3));
  EXPECT_THAT(ReadSlamFiles(Paths(), {Stamps(written)}).warnings,
              ElementsAre(HasSubstr("loops.csv: the last line has no line end")));
}

}  // namespace
}  // namespace depthgrid
