#include "mapper/io/frame_folder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "mapper/io/pose_track.h"
#include "mapper/io/sequence.h"
#include "tests/io/open_as_written.h"
#include "tests/io/temporary_folder.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string MatrixAt(double x_m) {
  return fmt::format("1 0 0 {}\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", x_m);
}

class FrameFolderTest : public TemporaryFolderTest {
 protected:
  std::unique_ptr<FrameSource> Open(const std::optional<SlamOutput>& slam = {}) const {
    return OpenAsWritten(folder_, SequenceFormat::kFrames, slam);
  }
  void WriteDepth(const std::string& name, int millimetres) const {
    std::filesystem::create_directories(std::filesystem::path(Path(name)).parent_path());
    DepthImage image(4, 3);
    std::fill(image.z_m.begin(), image.z_m.end(), static_cast<float>(millimetres) / 1000.0F);
    WriteDepthPng(Path(name), image, 1000.0);
  }
  // Frames 0, 1 and 4 as 7-Scenes and 3DMatch name them.
  void WriteSevenScenes(const std::string& folder) const {
    for (const int number : {0, 1, 4}) {
      const std::string stem = fmt::format("{}frame-{:06}", folder, number);
      WriteDepth(stem + ".depth.png", 1000 + number);
      Write(stem + ".pose.txt", MatrixAt(number));
      Write(stem + ".color.png", "not looked at");
    }
    Write("camera-intrinsics.txt", "500 0 1.5\n0 500 1\n0 0 1\n");
  }
  static std::vector<Frame> All(FrameSource& source) {
    std::vector<Frame> frames;
    while (auto frame = source.Next()) frames.push_back(std::move(*frame));
    return frames;
  }
  std::string OpenError() const {
    return Short(RefusalOf([&] { Open(); }));
  }
  std::vector<std::string> WarningsOf(const FrameSource& source) const {
    std::vector<std::string> warnings;
    for (const std::string& warning : source.Warnings()) warnings.push_back(Short(warning));
    return warnings;
  }
};

TEST_F(FrameFolderTest, PoseFilesBesideTheImages) {
  for (const std::string& inside : {std::string(), std::string("seq-01/")}) {
    SetUp();
    WriteSevenScenes(inside);
    EXPECT_TRUE(IsFrameFolder(folder_));
    const auto source = Open();
    EXPECT_EQ(source->Camera(), (PinholeCamera{4, 3, 500, 500, 1.5, 1, {}}));
    const auto frames = All(*source);
    ASSERT_EQ(frames.size(), 3U);
    EXPECT_DOUBLE_EQ(frames[2].stamp_s, 4.0 / 30.0);  // gaps of the numbers stay gaps
    EXPECT_EQ(frames[2].slam_from_camera->translation.x(), 4.0);
    EXPECT_FLOAT_EQ(frames[2].depth->At(1, 1), 1.004F);  // millimetres unless a file says otherwise
    EXPECT_THAT(source->Warnings(), ElementsAre());
  }
}

TEST_F(FrameFolderTest, ScanNetsFolders) {
  for (const int number : {0, 2, 10}) {
    WriteDepth(fmt::format("depth/{}.png", number), 2000);
    Write(fmt::format("pose/{}.txt", number),
          number == 2 ? "-inf -inf -inf -inf\n0 0 0 0\n0 0 0 0\n0 0 0 1\n" : MatrixAt(number));
  }
  Write("intrinsic/intrinsic_depth.txt", "577 0 1.5 0\n0 578 1 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_TRUE(IsFrameFolder(folder_));
  const auto source = Open();
  const auto frames = All(*source);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_FALSE(frames[1].slam_from_camera);                      // lost
  EXPECT_EQ(frames[2].slam_from_camera->translation.x(), 10.0);  // by number, not by name
  EXPECT_THAT(WarningsOf(*source), ElementsAre("~: 1 of 3 frames has no pose"));
}

// The driver gave frame 2 five times over while the camera went ahead by 10 cm a frame.
TEST_F(FrameFolderTest, ImagesThatComeAgainWhileTheCameraMovesAreLeftOut) {
  for (int number = 0; number < 10; ++number) {
    WriteDepth(fmt::format("depth/{}.png", number), 3000 - (number < 2 || number > 6 ? number : 2));
    Write(fmt::format("pose/{}.txt", number),
          fmt::format("1 0 0 0\n0 1 0 0\n0 0 1 {}\n0 0 0 1\n", 0.1 * number));
  }
  Write("intrinsic/intrinsic_depth.txt", "577 0 1.5 0\n0 578 1 0\n0 0 1 0\n0 0 0 1\n");
  const auto source = Open();
  std::vector<int> without;
  for (const Frame& frame : All(*source)) {
    EXPECT_TRUE(frame.slam_from_camera) << frame.index;
    if (!frame.depth) without.push_back(frame.index);
  }
  EXPECT_THAT(without, ElementsAre(3, 4, 5, 6));
  EXPECT_THAT(WarningsOf(*source),
              ElementsAre("~: 4 depth images the same as before while the camera moved, and left "
                          "out (first: ~/depth/3.png)"));
}

TEST_F(FrameFolderTest, OneFileOfPoses) {
  for (int number = 0; number < 3; ++number) {
    WriteDepth(fmt::format("frame-{:06}.depth.png", number), 1000);
  }
  Write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1\n");
  Write("intrinsics.txt", "500 0 1.5\n0 500 1\n0 0 1\n");
  const auto source = Open();
  const auto frames = All(*source);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[1].slam_from_camera->translation.x(), 1.0);
  EXPECT_FALSE(frames[2].slam_from_camera);
  EXPECT_THAT(
      WarningsOf(*source),
      ElementsAre("~/poses.txt: 2 poses for 3 frames, without stamps: taken for the first 2 "
                  "frames, so 1 frame has no pose; if they are of others, give a row with a stamp "
                  "for each (t x y z qx qy qz qw), or a row for each frame (NaN where there is no "
                  "pose)"));
}

// An image that was taken away since leaves its pose behind.
// A list that is no list of matrices, such as SLAM's trajectory, counts only where it is needed.
TEST_F(FrameFolderTest, ItsOwnListIsNotNeededWhereOthersAreGiven) {
  for (const int number : {0, 1}) WriteDepth(fmt::format("depth/{}.png", number), 1000);
  Write("camera-intrinsics.txt", "500 0 1.5\n0 500 1\n0 0 1\n");
  Write("traj.txt", "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n");
  EXPECT_THAT(OpenError(), HasSubstr("~/traj.txt:1: has 8 columns, must be a row of a matrix"));
  const SlamOutput slam = SlamOutputOf({{0.0, Pose3{}}, {1.0 / 30.0, Pose3{}}});
  EXPECT_EQ(All(*Open(slam)).size(), 2U);
}

TEST_F(FrameFolderTest, PosesOfOneFilePairByNumberWhenImagesAreMissing) {
  for (const int number : {0, 2}) {
    WriteDepth(fmt::format("frame-{:06}.depth.png", number), 1000);
  }
  Write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n1 0 0 2 0 1 0 0 0 0 1 0\n");
  Write("intrinsics.txt", "500 0 1.5\n0 500 1\n0 0 1\n");
  const auto source = Open();
  EXPECT_EQ(All(*source)[1].slam_from_camera->translation.x(), 2.0);
  EXPECT_THAT(WarningsOf(*source),
              ElementsAre("~/poses.txt: 3 poses for 2 frames, paired by the frames' numbers"));
}

TEST_F(FrameFolderTest, AnUpwardYAxisTurnsThePoses) {
  WriteSevenScenes("");
  Write("frame-000001.pose.txt", "1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n");
  Write("camera-intrinsics.txt", "500 0 1.5\n0 -500 1\n0 0 1\n");
  const auto source = Open();
  EXPECT_EQ(source->Camera()->fy_px, 500.0);
  EXPECT_EQ(All(*source)[1].slam_from_camera->translation, Eigen::Vector3d(1, -2, 3));
}

TEST_F(FrameFolderTest, DamageIsCountedAndSurvived) {
  WriteSevenScenes("");
  Write("frame-000001.pose.txt", "1 2 3\n");
  Write("frame-000004.depth.png", "no image");
  const auto source = Open();
  const auto frames = All(*source);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_FALSE(frames[1].slam_from_camera);
  EXPECT_FALSE(frames[2].depth);
  EXPECT_THAT(WarningsOf(*source),
              ElementsAre(HasSubstr("~: 1 pose file damaged (first: ~/frame-000001.pose.txt:1: has "
                                    "3 columns"),
                          "~: 1 of 3 frames has no pose",
                          HasSubstr("~: 1 depth image missing or damaged")));
}

TEST_F(FrameFolderTest, ImagesAloneTakeThePosesThatAreGiven) {
  WriteSevenScenes("");
  for (const int number : {0, 1, 4}) {
    std::filesystem::remove(Path(fmt::format("frame-{:06}.pose.txt", number)));
  }
  EXPECT_EQ(DetectFormat(folder_), SequenceFormat::kFrames);
  const auto source = Open(SlamOutputOf({{0.0, Pose3{}}, {1.0 / 30.0, Pose3{}}}));
  EXPECT_TRUE(source->Next()->slam_from_camera);
}

// As ROS and EuRoC name them.
TEST_F(FrameFolderTest, NamesOfMilliMicroAndNanosecondsAreStamps) {
  for (const std::string zeros : {"", "000", "000000"}) {
    SetUp();
    for (const int milliseconds : {0, 50}) {
      WriteDepth(fmt::format("depth/14036365797{:02}{}.png", 10 + milliseconds, zeros), 1000);
    }
    Write("camera-intrinsics.txt", "500 0 1.5\n0 500 1\n0 0 1\n");
    const auto source = Open(SlamOutputOf({{1403636579.71, Pose3{}}, {1403636579.76, Pose3{}}}));
    const auto frames = All(*source);
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_NEAR(frames[0].stamp_s, 1403636579.71, 1e-6);
    EXPECT_NEAR(frames[1].stamp_s, 1403636579.76, 1e-6);
    EXPECT_TRUE(frames[1].slam_from_camera);
  }
}

// A TUM folder's images without its depth.txt. By their last digits the third would come first.
TEST_F(FrameFolderTest, NamesOfSecondsWithAFractionAreStamps) {
  for (const std::string& before : {std::string("depth/"), std::string("depth/left-")}) {
    SetUp();
    for (const char* stamp : {"1305031102.960407", "1305031103.000000", "1305031103.040407"}) {
      WriteDepth(before + stamp + ".png", 1000);
    }
    Write("camera-intrinsics.txt", "500 0 1.5\n0 500 1\n0 0 1\n");
    const FrameFolder listed = ListFrameFolder(folder_, {});
    ASSERT_EQ(listed.recording.images.size(), 3U);
    EXPECT_EQ(listed.recording.images[0].stamp_s, 1305031102.960407);
    EXPECT_EQ(listed.recording.images[1].stamp_s, 1305031103.0);
    EXPECT_EQ(listed.recording.images[2].stamp_s, 1305031103.040407);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(listed.recording.images[i].number, i);
  }
  // The ninth and the tenth image of a camera.
  SetUp();
  for (const char* name : {"depth/1.9.png", "depth/1.10.png"}) WriteDepth(name, 1000);
  const FrameFolder listed = ListFrameFolder(folder_, {});
  EXPECT_EQ(listed.recording.images[0].number, 9);
  EXPECT_DOUBLE_EQ(listed.recording.images[1].stamp_s, 10.0 / 30.0);
}

// As the RealSense viewer exports them.
TEST_F(FrameFolderTest, NamesOfMillisecondsWithAFractionAreStamps) {
  for (const char* stamp : {"1700001000000.00000000000", "1700001000033.33300781250"}) {
    WriteDepth(std::string("depth/_Depth_") + stamp + ".png", 1000);
  }
  const FrameFolder listed = ListFrameFolder(folder_, {});
  ASSERT_EQ(listed.recording.images.size(), 2U);
  EXPECT_NEAR(listed.recording.images[0].stamp_s, 1700001000.0, 1e-6);
  EXPECT_NEAR(listed.recording.images[1].stamp_s, 1700001000.033333, 1e-6);
}

// The map's files hold stamps of seconds: it would be refused when it is written.
TEST_F(FrameFolderTest, ANumberThatIsNoStampIsRefusedFirst) {
  WriteSevenScenes("");
  WriteDepth("frame-500000000000000.depth.png", 1000);
  EXPECT_THAT(OpenError(), HasSubstr("~/frame-500000000000000.depth.png: the stamp is 5e+11, "
                                     "must be in seconds"));
}

TEST_F(FrameFolderTest, OneClearLineForEachFault) {
  EXPECT_FALSE(IsFrameFolder(folder_));
  EXPECT_EQ(OpenError(), "~: holds no numbered depth images (frame-000000.depth.png, depth/0.png)");
  WriteSevenScenes("");
  std::filesystem::remove(Path("camera-intrinsics.txt"));
  EXPECT_EQ(OpenError(),
            "~: has no camera file (camera.yaml, camera-intrinsics.txt, ... or --camera FILE)");
  Write("camera-intrinsics.txt", "500 0\n");
  EXPECT_THAT(OpenError(),
              HasSubstr("~/camera-intrinsics.txt:1: has 2 numbers, must have 4 (fx fy cx cy)"));
  Write("camera-intrinsics.txt", "500 0 1.5\n0 500 1\n0 0 1\n");
  Write("frame-000000.pose.txt", "-inf 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  Write("frame-000001.pose.txt", "1 2 3\n");
  Write("frame-000004.pose.txt", "nan 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_EQ(OpenError(),
            "~: none of 3 pose files holds a pose that can be used; first: "
            "~/frame-000000.pose.txt:4: the matrix must be finite");
  for (const int number : {0, 1, 4}) {
    std::filesystem::remove(Path(fmt::format("frame-{:06}.pose.txt", number)));
  }
  EXPECT_EQ(OpenError(),
            "~: holds no poses (frame-000000.pose.txt, poses.txt, ...); --poses FILE gives them");
  std::filesystem::create_directories(Path("a"));
  SetUp();
  WriteSevenScenes("seq-01/");
  WriteSevenScenes("seq-02/");
  EXPECT_EQ(OpenError(), "~: holds 2 sequences, name one of them such as seq-01");
}

TEST_F(FrameFolderTest, RecordingsOfOtherSystemsAreNamed) {
  const char* from_bag = "; docs/examples/from_bag.py makes either of it";
  for (const auto& [name, what, way] : {std::tuple("drive.bag", "a ROS bag", from_bag),
                                        std::tuple("drive.db3", "a ROS 2 bag", from_bag),
                                        std::tuple("drive.mcap", "an MCAP recording", from_bag),
                                        std::tuple("drive.rawlog", "an MRPT rawlog", "")}) {
    Write(name, "#ROSBAG V2.0");
    EXPECT_EQ(Short(RefusalOf([&] { DetectFormat(Path(name)); })),
              fmt::format("~/{}: is {} by its name, which is not read: must be a folder of depth "
                          "images or a CARMEN laser log (docs/formats.md){}",
                          name, what, way));
  }
  std::filesystem::create_directories(Path("drive"));
  Write("drive/metadata.yaml", "");
  Write("drive/drive_0.mcap", "");
  EXPECT_EQ(Short(RefusalOf([&] { DetectFormat(Path("drive")); })),
            "~/drive: is a ROS 2 bag, which is not read: must be a folder of depth images or a "
            "CARMEN laser log (docs/formats.md); docs/examples/from_bag.py makes either of it");
}

TEST_F(FrameFolderTest, ReadsTheSharedKinectFrames) {
  const char* data = std::getenv("DEPTHGRID_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "DEPTHGRID_TEST_DATA is not set";
  const auto source =
      OpenAsWritten(std::string(data) + "/depth_frames/nvblox_3dmatch", SequenceFormat::kFrames);
  EXPECT_NEAR(source->Camera()->fx_px, 570.342205, 1e-6);
  const auto frames = All(*source);
  ASSERT_EQ(frames.size(), 5U);
  for (const Frame& frame : frames) {
    ASSERT_TRUE(frame.depth);
    ASSERT_TRUE(frame.slam_from_camera);
  }
  EXPECT_NEAR(frames.back().stamp_s, 422.0 / 30.0, 1e-9);
}

}  // namespace
}  // namespace depthgrid
