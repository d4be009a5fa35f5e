#include "mapper/io/tum_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "mapper/io/number_rows.h"
#include "mapper/io/pose_track.h"
#include "mapper/io/sequence.h"
#include "mapper/io/trajectory_file.h"
#include "tests/io/open_as_written.h"
#include "tests/io/temporary_folder.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class TumFolderTest : public TemporaryFolderTest {
 protected:
  std::unique_ptr<FrameSource> Open(const SlamOutput& slam,
                                    const RecordingOptions& options = {}) const {
    return OpenAsWritten(folder_, SequenceFormat::kTum, slam, options);
  }
  static CameraFile SmallCamera() { return {{4, 3, 4.0, 4.0, 1.5, 1.0, {}}, 5000.0}; }
  static DepthImage Image(int k) {
    DepthImage image(4, 3);
    for (std::size_t i = 0; i < image.z_m.size(); ++i) {
      image.z_m[i] = 0.37F * static_cast<float>(i) + 0.1F * static_cast<float>(k);
    }
    return image;
  }
  static StampedPose PoseAt(double stamp_s, double x_m) {
    return {stamp_s, {Eigen::Quaterniond::Identity(), {x_m, 0, 0}}};
  }
  // Four frames at 8 Hz with their poses.
  Trajectory WriteSequence() const {
    const TumFolderWriter writer(folder_, SmallCamera());
    Trajectory truth;
    std::vector<double> stamps_s;
    const RgbImage rgb(4, 3);
    for (int k = 0; k < 4; ++k) {
      stamps_s.push_back(0.125 * k);
      truth.push_back(PoseAt(0.125 * k, k));
      writer.WriteFrame(0.125 * k, Image(k), &rgb);
    }
    writer.Finish(stamps_s, true, truth);
    return truth;
  }
  static std::vector<Frame> All(FrameSource& source) {
    std::vector<Frame> frames;
    while (auto frame = source.Next()) frames.push_back(std::move(*frame));
    return frames;
  }
  template <typename Action>
  std::string ErrorOf(const Action& action) const {
    return Short(RefusalOf(action));
  }
  std::string OpenError(const Trajectory& poses) const {
    return ErrorOf([&] { Open(SlamOutputOf(poses)); });
  }
};

TEST_F(TumFolderTest, ReadsBackWhatWasWritten) {
  const Trajectory truth = WriteSequence();
  EXPECT_EQ(ReadTrajectory(Path("groundtruth.txt")), truth);
  const auto source = Open(SlamOutputOf(truth));
  EXPECT_EQ(source->FrameCount(), 4);
  EXPECT_EQ(source->Camera(), SmallCamera().camera);
  const std::vector<Frame> frames = All(*source);
  ASSERT_EQ(frames.size(), 4U);
  for (int k = 0; k < 4; ++k) {
    const Frame& frame = frames[static_cast<std::size_t>(k)];
    EXPECT_EQ(frame.index, k);
    EXPECT_DOUBLE_EQ(frame.stamp_s, 0.125 * k);
    EXPECT_EQ(frame.slam_from_camera->translation.x(), k);
    EXPECT_EQ(frame.depth->z_m, QuantiseDepth(Image(k)).z_m);
  }
  EXPECT_THAT(source->Warnings(), ElementsAre());
}

TEST_F(TumFolderTest, PoseBelongsToTheColourStamp) {
  WriteSequence();
  // Colour 15 ms after depth; poses on either side of its stamp.
  Write("rgb.txt", "0.015 rgb/a.png\n0.140 rgb/b.png\n0.265 rgb/c.png\n0.390 rgb/d.png\n");
  RecordingOptions options;
  options.max_stamp_difference_s = 0.016;
  const Trajectory poses = {PoseAt(0.127, 1), PoseAt(0.155, 2)};
  auto frames = All(*Open(SlamOutputOf(poses), options));
  EXPECT_DOUBLE_EQ(frames[1].stamp_s, 0.140);
  EXPECT_EQ(frames[1].slam_from_camera->translation.x(), 1);
  options.pose_stamp = PoseStamp::kDepth;
  options.time_offset_s = 0.03;
  frames = All(*Open(SlamOutputOf(poses), options));
  EXPECT_DOUBLE_EQ(frames[1].stamp_s, 0.125);
  EXPECT_EQ(frames[1].slam_from_camera->translation.x(), 2);
}

TEST_F(TumFolderTest, InterpolatesPosesWhenAsked) {
  WriteSequence();
  RecordingOptions options;
  options.interpolate_poses = true;
  const Trajectory poses = {PoseAt(0.1, 0), PoseAt(0.15, 10), PoseAt(0.40, 20)};
  const auto source = Open(SlamOutputOf(poses), options);
  const auto frames = All(*source);
  EXPECT_FALSE(frames[0].slam_from_camera);
  EXPECT_NEAR(frames[1].slam_from_camera->translation.x(), 5.0, 1e-9);
  EXPECT_FALSE(frames[2].slam_from_camera);  // the gap is too long
  EXPECT_THAT(source->Warnings(), ElementsAre(HasSubstr("3 of 4 frames have no pose")));
}

TEST_F(TumFolderTest, LoopsAndEpochsFollowTheirFrames) {
  SlamOutput slam = SlamOutputOf(WriteSequence());
  slam.live.erase(slam.live.begin());  // entries are now one behind frames
  slam.live[2].epoch = 1;
  slam.live[1].slam_from_camera.reset();
  LoopClosure loop;
  loop.first_frame = 0;
  loop.second_frame = 2;
  loop.reported_at_frame = 2;
  slam.loops.push_back(loop);
  const auto frames = All(*Open(slam));
  EXPECT_FALSE(frames[0].slam_from_camera);
  EXPECT_FALSE(frames[2].slam_from_camera);
  EXPECT_EQ(frames[3].slam_epoch, 1);
  ASSERT_EQ(frames[3].loops.size(), 1U);
  EXPECT_EQ(frames[3].loops[0].first_frame, 1);
  EXPECT_EQ(frames[3].loops[0].second_frame, 3);
}

// SLAM reports the loop with a frame of its own of which there is no image.
TEST_F(TumFolderTest, ALoopOfAFrameWithoutAnImageComesWithTheNext) {
  SlamOutput slam = SlamOutputOf(WriteSequence());
  slam.live.insert(slam.live.begin() + 2, {0.1875, PoseAt(0, 1.5).world_from_camera, 0});
  LoopClosure loop;
  loop.first_frame = 0;
  loop.second_frame = 1;
  loop.reported_at_frame = 2;
  slam.loops = {loop};
  loop.second_frame = 2;  // has no image itself
  slam.loops.push_back(loop);
  const auto source = Open(slam);
  EXPECT_THAT(
      source->Warnings(),
      ElementsAre(HasSubstr("loop closures left out, as they join frames that have no image: 1")));
  const auto frames = All(*source);
  EXPECT_TRUE(frames[1].loops.empty());
  ASSERT_EQ(frames[2].loops.size(), 1U);
  EXPECT_EQ(frames[2].loops[0].second_frame, 1);
}

TEST_F(TumFolderTest, ADepthImageWithoutAColourImageKeepsItsStamp) {
  const Trajectory truth = WriteSequence();
  Write("rgb.txt", "0.005 a.png\n0.13 b.png\n0.38 d.png\n");
  const auto source = Open(SlamOutputOf(truth));
  EXPECT_THAT(source->Warnings(),
              ElementsAre(HasSubstr("1 depth image without a colour image within 0.02 s")));
  const auto frames = All(*source);
  EXPECT_EQ(frames[1].stamp_s, 0.13);
  EXPECT_EQ(frames[2].stamp_s, 0.25);
}

TEST_F(TumFolderTest, FramesComeWithoutTheCamerasDistortion) {
  const Trajectory truth = WriteSequence();
  CameraFile camera = SmallCamera();
  camera.camera.distortion[0] = 2.0;  // moves the corners by more than a pixel
  WriteCameraFile(Path("camera.yaml"), camera);
  const auto source = Open(SlamOutputOf(truth));
  EXPECT_EQ(source->Camera(), SmallCamera().camera);
  const auto frames = All(*source);
  EXPECT_NE(frames[0].depth->z_m, QuantiseDepth(Image(0)).z_m);
}

TEST_F(TumFolderTest, DamagedFramesAreCountedAndSurvived) {
  const Trajectory truth = WriteSequence();
  std::filesystem::remove(Path("depth/0.125000.png"));
  Write("depth/0.250000.png", "no image");
  WriteDepthPng(Path("depth/0.375000.png"), DepthImage(5, 3));
  const auto source = Open(SlamOutputOf(truth));
  const auto frames = All(*source);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_TRUE(frames[0].depth);
  for (int k = 1; k < 4; ++k) EXPECT_FALSE(frames[static_cast<std::size_t>(k)].depth);
  std::vector<std::string> warnings;
  for (const auto& warning : source->Warnings()) warnings.push_back(Short(warning));
  EXPECT_THAT(warnings,
              ElementsAre("~: 2 depth images missing or damaged (first: ~/depth/0.125000.png: no "
                          "such file)",
                          "~: 1 depth image of another size than the camera (first: "
                          "~/depth/0.375000.png: is 5x3 pixels, must be 4x3 as the camera's)"));
}

TEST_F(TumFolderTest, UnsortedAndRepeatedRowsAreCounted) {
  const StampedFileList list =
      ParseFileList("# c\n2 depth/b.png\n1 depth/a.png\n2 depth/c.png\n", "depth.txt");
  ASSERT_EQ(list.files.size(), 2U);
  EXPECT_EQ(list.files[1].path, "depth/b.png");
  EXPECT_THAT(list.warnings, ElementsAre("depth.txt: 1 row earlier than the row before, sorted",
                                         "depth.txt: 1 row with a stamp already given, ignored"));
}

TEST_F(TumFolderTest, NamesMayHaveSpaces) {
  const StampedFileList list =
      ParseFileList("1 depth images/a 1.png \r\n2,depth images/b,2.png\n", "depth.txt");
  ASSERT_EQ(list.files.size(), 2U);
  EXPECT_EQ(list.files[0].path, "depth images/a 1.png");
  EXPECT_EQ(list.files[1].path, "depth images/b,2.png");
  EXPECT_TRUE(list.warnings.empty());
}

// What comes out names a frame by its stamp with six decimals: two of one would be read as one.
TEST_F(TumFolderTest, StampsAreOneToTheMicrosecond) {
  const StampedFileList list = ParseFileList(
      "1 depth/a.png\n1.0000003 depth/b.png\n1.0000014 depth/c.png\n1.000002 depth/d.png\n",
      "depth.txt");
  ASSERT_EQ(list.files.size(), 3U);
  EXPECT_EQ(list.files[1].path, "depth/c.png");
  EXPECT_EQ(list.files[2].path, "depth/d.png");
  EXPECT_THAT(list.warnings, ElementsAre("depth.txt: 1 row with a stamp already given, ignored"));
}

// Damaged rows and images beside a nearer one keep their numbers, doubled rows have none.
TEST_F(TumFolderTest, FramesKeepTheirNumbers) {
  const StampedFileList list = ParseFileList(
      "1 depth/a.png\n1 depth/a.png\n2\n4 depth/d.png\n3 depth/c.png\n5 depth/e.pn", "depth.txt");
  ASSERT_EQ(list.files.size(), 4U);
  EXPECT_EQ(list.files[1].number, 2);
  EXPECT_EQ(list.files[3].number, 4);
  EXPECT_THAT(list.warnings,
              ElementsAre("depth.txt: 1 damaged row left out (first: depth.txt:3: must be a stamp "
                          "and a file name)",
                          "depth.txt: the last line has no line end; it is used, but may be cut",
                          "depth.txt: 1 row earlier than the row before, sorted",
                          "depth.txt: 1 row with a stamp already given, ignored"));
  WriteSequence();
  Write("rgb.txt", "0.005 rgb/a.png\n0.26 rgb/c.png\n0.38 rgb/d.png\n");
  Write("depth.txt", "0 depth/a.png\n0.01 depth/b.png\n0.25 depth/c.png\n0.375 depth/d.png\n");
  const Recording recording = ListTumFolder(folder_);
  ASSERT_EQ(recording.images.size(), 3U);
  EXPECT_EQ(recording.images[1].number, 2);
}

// "depth_scale: 5000" that lost its last digits is another camera.
TEST_F(TumFolderTest, ACutCameraFileIsSaid) {
  WriteSequence();
  const std::string camera = "width: 4\nheight: 3\nfx: 4\nfy: 4\ncx: 1.5\ncy: 1\ndepth_scale: 50";
  std::vector<std::string> warnings;
  Write("camera.yaml", camera + "00\n");
  EXPECT_EQ(TumFolderCamera(folder_, warnings).file.depth_scale_per_m, 5000.0);
  EXPECT_THAT(warnings, IsEmpty());
  Write("camera.yaml", camera);
  EXPECT_EQ(TumFolderCamera(folder_, warnings).file.depth_scale_per_m, 50.0);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("camera.yaml: the last line has no line end")));
}

// Millimetres read as TUM's units give a room of a fifth of its size.
TEST_F(TumFolderTest, AScaleThatIsTakenForGrantedIsSaid) {
  WriteSequence();
  Write("camera.yaml", "width: 4\nheight: 3\nfx: 4\nfy: 4\ncx: 1.5\ncy: 1\n");
  const Sequence sequence = OpenSequence(folder_);
  EXPECT_THAT(sequence.source->Warnings(),
              Contains(HasSubstr("camera.yaml: states no depth_scale; 5000 units per metre are")));
}

// As of --camera.
TEST_F(TumFolderTest, ItsOwnCameraMayHaveYUp) {
  WriteSequence();
  std::vector<std::string> warnings;
  EXPECT_FALSE(TumFolderCamera(folder_, warnings).y_up);
  Write("camera.yaml", "width: 4\nheight: 3\nfx: 4\nfy: -4\ncx: 1.5\ncy: 1\ndepth_scale: 1000\n");
  const CameraDescription camera = TumFolderCamera(folder_, warnings);
  EXPECT_TRUE(camera.y_up);
  EXPECT_EQ(camera.file.camera.fy_px, 4.0);
  EXPECT_THAT(warnings, IsEmpty());
}

// Of two frames in four that is nothing to wonder at.
TEST_F(TumFolderTest, ThatMostFramesLackAPoseIsSaidWithTheStamps) {
  WriteSequence();
  const auto warnings_with = [&](const Trajectory& poses) {
    return Open(SlamOutputOf(poses))->Warnings();
  };
  EXPECT_THAT(warnings_with({PoseAt(0.0, 0.0), PoseAt(125e6, 1.0), PoseAt(375e6, 2.0)}),
              ElementsAre(folder_ + ": 3 of 4 frames have no pose: images from 0.000 to 0.375 s, "
                                    "poses from 0.000 to 375000000.000 s; are both in seconds?"));
  EXPECT_THAT(warnings_with({PoseAt(0.0, 0.0), PoseAt(0.3, 1.0)}),
              ElementsAre(folder_ + ": 3 of 4 frames have no pose: images from 0.000 to 0.375 s, "
                                    "poses from 0.000 to 0.300 s; --set "
                                    "sequence.recording.interpolate_poses=true --set "
                                    "sequence.recording.max_interpolation_gap_s=0.30 interpolates "
                                    "poses up to that apart, for a camera that moves smoothly "
                                    "between them"));
  RecordingOptions interpolate;
  interpolate.interpolate_poses = true;
  const Trajectory sparse = {PoseAt(0.0, 0.0), PoseAt(0.3, 1.0)};
  EXPECT_THAT(Open(SlamOutputOf(sparse), interpolate)->Warnings(),
              ElementsAre(folder_ + ": 3 of 4 frames have no pose: images from 0.000 to 0.375 s, "
                                    "poses from 0.000 to 0.300 s; poses more than 0.2 s apart "
                                    "are not interpolated, --set "
                                    "sequence.recording.max_interpolation_gap_s=0.30 "
                                    "interpolates most of them"));
  EXPECT_THAT(warnings_with({PoseAt(0.0, 0.0), PoseAt(0.125, 1.0)}),
              ElementsAre(folder_ + ": 2 of 4 frames have no pose"));
}

TEST_F(TumFolderTest, UnitsOfDepthAreChecked) {
  const Trajectory truth = WriteSequence();
  RecordingOptions options;
  options.invalid_units = {65535, 1.5};
  EXPECT_EQ(ErrorOf([&] { Open(SlamOutputOf(truth), options); }),
            "sequence.recording.invalid_units: holds 1.5, must be whole numbers");
  options.invalid_units = {};
  options.depth_scale_per_m = 0.001;
  EXPECT_THAT(ErrorOf([&] { Open(SlamOutputOf(truth), options); }),
              testing::StartsWith("sequence.recording.depth_scale: is 0.001, must be 0 "));
}

// Its own stamp, 0.130, lies before the colour image's of the one before, 0.140.
TEST_F(TumFolderTest, AnImageEarlierThanTheOneBeforeIsLeftOutAndCounted) {
  const Trajectory truth = WriteSequence();
  Write("depth.txt",
        "0.000 depth/0.000000.png\n0.125 depth/0.125000.png\n"
        "0.130 depth/0.250000.png\n0.375 depth/0.375000.png\n");
  Write("rgb.txt", "0.000 rgb/0.000000.png\n0.140 rgb/0.125000.png\n0.375 rgb/0.375000.png\n");
  RecordingOptions options;
  options.max_stamp_difference_s = 0.016;
  const auto source = Open(SlamOutputOf(truth), options);
  std::vector<double> stamps_s;
  for (const Frame& frame : All(*source)) stamps_s.push_back(frame.stamp_s);
  EXPECT_THAT(stamps_s, ElementsAre(0.0, 0.14, 0.375));
}

TEST_F(TumFolderTest, WhatIsAddedToTheStampsIsSaidWhereTheyAre) {
  WriteSequence();
  RecordingOptions options;
  options.time_offset_s = 2.5;
  EXPECT_EQ(ErrorOf([&] {
              Open(SlamOutputOf({PoseAt(0.0, 0.0), PoseAt(0.375, 1.0)}), options);
            }),
            "~: no pose within 0.02 s of any image: images from 2.500 to 2.875 s (2.5 s added), "
            "poses from 0.000 to 0.375 s; --set sequence.recording.time_offset_s=0.000 makes the "
            "first of both coincide");
}

// time_offset_s would refuse the difference.
TEST_F(TumFolderTest, NoOffsetIsOfferedThatIsRefused) {
  WriteSequence();
  const Trajectory far = {PoseAt(0.5 * kLatestStampS, 0.0), PoseAt(0.5 * kLatestStampS + 1.0, 1.0)};
  EXPECT_THAT(OpenError(far), testing::EndsWith("s; are both in seconds?"));
}

TEST_F(TumFolderTest, StampsOfOtherUnitsAreRefusedWithTheirUnit) {
  WriteSequence();
  const auto said = [&](const std::string& stamp) {
    Write("depth.txt", stamp + " depth/0.000000.png\n");
    return OpenError({PoseAt(0.0, 0.0)});
  };
  EXPECT_THAT(said("1700000000000000000"),
              testing::EndsWith("nanoseconds: divide all stamps of the file "
                                "by 1e9"));
  EXPECT_THAT(said("1700000000000000"),
              testing::EndsWith(": divide all stamps of the file by 1e6"));
  EXPECT_THAT(said("1700000000000"),
              testing::EndsWith(": divide all stamps of the file by 1e3, or by 1e9 "
                                "if they do not count from 1970"));
}

TEST_F(TumFolderTest, OneClearLineForEachFault) {
  EXPECT_EQ(OpenError({PoseAt(0, 0)}), "~/depth.txt: no such file");
  const Trajectory truth = WriteSequence();
  EXPECT_EQ(OpenError({PoseAt(7, 0)}),
            "~: no pose within 0.02 s of any image: images from 0.000 to 0.375 s, poses from 7.000 "
            "to 7.000 s; --set sequence.recording.time_offset_s=7.000 makes the first of both "
            "coincide");
  EXPECT_EQ(OpenError({}), "~: the trajectory for it holds no pose");
  WriteCameraFile(Path("camera.yaml"), {{8, 3, 4.0, 4.0, 1.5, 1.0, {}}, 5000.0});
  EXPECT_EQ(OpenError(truth), "~/depth/0.000000.png: is 4x3 pixels, must be 8x3 as the camera's");
  std::filesystem::remove(Path("camera.yaml"));
  EXPECT_EQ(OpenError(truth),
            "~/camera.yaml: no such file; it states the camera's intrinsics (--camera FILE names "
            "another)");
  WriteCameraFile(Path("camera.yaml"), SmallCamera());
  std::filesystem::remove_all(Path("depth"));
  EXPECT_EQ(OpenError(truth), "~/depth/0.000000.png: no such file");
  Write("depth.txt", "0.1\n");
  EXPECT_EQ(OpenError(truth), "~/depth.txt:1: must be a stamp and a file name");
  Write("depth.txt", "# nothing\n");
  EXPECT_EQ(OpenError(truth), "~/depth.txt: lists no depth image");
}

}  // namespace
}  // namespace depthgrid
