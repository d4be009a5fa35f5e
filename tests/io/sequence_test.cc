#include "mapper/io/sequence.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "mapper/io/pose_track.h"
#include "mapper/io/trajectory_file.h"
#include "mapper/io/tum_folder.h"
#include "tests/io/temporary_folder.h"
#include "tests/mapper/analytic_room.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kCameraHeightM = 1.2;

class SequenceTest : public TemporaryFolderTest {
 protected:
  static CameraFile Camera() { return {{80, 60, 60.2, 60.0, 39.5, 29.5, {}}, 5000.0}; }

  // Frames in a room, twelve a round; returns the true poses.
  Trajectory WriteRoom(int frames = 12) const {
    AnalyticRoom room;
    room.boxes = {{{1.2, -1.0, 0.0}, {2.4, 0.6, 0.45}}};
    const TumFolderWriter writer(folder_, Camera());
    Trajectory truth;
    std::vector<double> stamps_s;
    for (int i = 0; i < frames; ++i) {
      const double stamp_s = 0.125 * i;
      const Pose3 pose =
          TiltedCamera({0.3 * std::cos(i), 0.0, kPi * i / 6.0}, kCameraHeightM, 0.35, 0.1);
      writer.WriteFrame(stamp_s, room.Render(Camera().camera, pose), nullptr);
      stamps_s.push_back(stamp_s);
      truth.push_back({stamp_s, pose});
    }
    writer.Finish(stamps_s, false, truth);
    return truth;
  }
  static Trajectory Turned(const Trajectory& poses, const Pose3& by) {
    Trajectory turned = poses;
    for (StampedPose& pose : turned) pose.world_from_camera = by * pose.world_from_camera;
    return turned;
  }
  template <typename Action>
  std::string ErrorOf(const Action& action) const {
    return Short(RefusalOf(action));
  }
};

TEST_F(SequenceTest, ALevelWorldStaysBitForBit) {
  const Trajectory truth = WriteRoom();
  const Sequence sequence = OpenSequence(folder_);
  EXPECT_EQ(sequence.kind, "TUM RGB-D folder");
  EXPECT_EQ(sequence.floor_z_m, 0.0);
  EXPECT_THAT(sequence.notes, Contains("poses: groundtruth.txt of the folder"));
  EXPECT_THAT(sequence.notes, Contains("up is z, removed 0.0 degrees"));
  EXPECT_THAT(sequence.notes, Contains(HasSubstr("camera is 1.20 m above the floor")));
  for (const StampedPose& pose : truth) {
    EXPECT_EQ(sequence.source->Next()->slam_from_camera, pose.world_from_camera);
  }
}

TEST_F(SequenceTest, TiltedAndCameraAxisWorldsBecomeLevel) {
  const Trajectory truth = WriteRoom();
  const Pose3 tilted{Eigen::Quaterniond(Eigen::AngleAxisd(RadFromDeg(26.0),
                                                          Eigen::Vector3d(1, 2, 0).normalized())),
                     {1, 2, 3}};
  // As a SLAM system says it: the first camera is the world.
  const Pose3 first = Inverse(truth.front().world_from_camera);
  for (const Pose3& by : {tilted, first}) {
    const Trajectory given = Turned(truth, by);
    const Sequence sequence = OpenSequence(folder_, {}, SlamOutputOf(given));
    ASSERT_TRUE(sequence.floor_z_m);
    ASSERT_EQ(sequence.final_poses.size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const Pose3 pose = *sequence.source->Next()->slam_from_camera;
      EXPECT_NEAR(pose.translation.z() - *sequence.floor_z_m, kCameraHeightM, 0.03);
      // The camera leans by as much as it truly does.
      const auto down = [](const Pose3& p) { return (p.rotation * Eigen::Vector3d::UnitZ()).z(); };
      EXPECT_NEAR(down(pose), down(truth[i].world_from_camera), 0.01);
      EXPECT_EQ(sequence.final_poses[i].world_from_camera, pose);
    }
  }
}

// SLAM saw every second image alone, and none of those that would be looked at first.
TEST_F(SequenceTest, UpIsFoundFromTheImagesThatHavePoses) {
  const Trajectory truth = WriteRoom(48);
  Trajectory odd;
  for (std::size_t i = 1; i < truth.size(); i += 2) odd.push_back(truth[i]);
  const Pose3 first = Inverse(odd.front().world_from_camera);
  const Sequence sequence = OpenSequence(folder_, {}, SlamOutputOf(Turned(odd, first)));
  ASSERT_TRUE(sequence.floor_z_m);
  EXPECT_THAT(sequence.notes, Contains(HasSubstr("camera is 1.20 m above the floor")));
}

TEST_F(SequenceTest, WhereNoFloorIsSeenTheAxisTakenIsWarnedOf) {
  const TumFolderWriter writer(folder_, Camera());
  Trajectory poses;
  const std::vector<double> stamps_s = {0.0, 0.1, 0.2};
  for (const double stamp_s : stamps_s) {
    DepthImage wall(Camera().camera.width_px, Camera().camera.height_px);
    std::fill(wall.z_m.begin(), wall.z_m.end(), 2.0F);
    writer.WriteFrame(stamp_s, wall, nullptr);
    poses.push_back({stamp_s, CameraOf({}, kCameraHeightM)});
  }
  writer.Finish(stamps_s, false, poses);
  const Sequence sequence = OpenSequence(folder_);
  while (sequence.source->Next()) continue;
  EXPECT_THAT(sequence.source->Warnings(),
              Contains(HasSubstr("no floor seen in the images, z is taken as up")));
}

TEST_F(SequenceTest, AJumpOfTheFoldersOwnPosesIsNoMotion) {
  Trajectory poses = WriteRoom();
  for (std::size_t i = 6; i < poses.size(); ++i) {
    poses[i].world_from_camera.translation.x() += 5.0;
  }
  WriteTrajectory(folder_ + "/groundtruth.txt", poses);
  const Sequence sequence = OpenSequence(folder_);
  EXPECT_THAT(sequence.notes, Contains(HasSubstr("the poses jump at ")));
  std::vector<int> epochs;
  while (const auto frame = sequence.source->Next()) epochs.push_back(frame->slam_epoch);
  ASSERT_EQ(epochs.size(), 12U);
  EXPECT_LT(epochs[5], epochs[6]);
}

TEST_F(SequenceTest, AFixedAxisIsTakenAsSaid) {
  const Trajectory truth = WriteRoom();
  SequenceOptions options;
  options.world_up = WorldUp::kMinusY;
  const Sequence sequence = OpenSequence(folder_, options, SlamOutputOf(truth));
  const Eigen::Vector3d before = truth.front().world_from_camera.translation;
  EXPECT_TRUE(sequence.source->Next()->slam_from_camera->translation.isApprox(
      Eigen::Vector3d(before.x(), before.z(), -before.y()), 1e-12));
  EXPECT_FALSE(sequence.floor_z_m);
}

TEST_F(SequenceTest, AnAxisThatTheFloorSpeaksAgainstIsDoubted) {
  const Trajectory truth = WriteRoom();
  const auto doubt = [&](WorldUp up, const Trajectory& poses) {
    SequenceOptions options;
    options.world_up = up;
    const Sequence sequence = OpenSequence(folder_, options, SlamOutputOf(poses));
    const UpDoubt said = sequence.up_doubt.value_or(UpDoubt{"none"});
    return said.up + (said.opposite ? ", opposite" : "");
  };
  EXPECT_EQ(doubt(WorldUp::kZ, truth), "none");
  EXPECT_EQ(doubt(WorldUp::kAuto, truth), "none");
  for (const WorldUp wrong : {WorldUp::kX, WorldUp::kMinusY}) EXPECT_EQ(doubt(wrong, truth), "z");
  EXPECT_EQ(doubt(WorldUp::kMinusZ, truth), "z, opposite");
  const Pose3 tilted{Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX())),
                     Eigen::Vector3d::Zero()};
  EXPECT_EQ(doubt(WorldUp::kZ, Turned(truth, tilted)), "none");
  EXPECT_THAT(doubt(WorldUp::kX, Turned(truth, tilted)), ::testing::StartsWith("(0.0"));
}

// A camera mounted upside down, or a world whose z points down: the images show the same.
TEST_F(SequenceTest, UpOppositeToZIsWarnedOf) {
  const Trajectory truth = WriteRoom();
  const auto warnings_of = [&](const Eigen::Vector3d& axis, WorldUp up, double turn_rad = kPi) {
    const Pose3 turned{Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, axis)),
                       Eigen::Vector3d::Zero()};
    SequenceOptions options;
    options.world_up = up;
    const SlamOutput poses = SlamOutputOf(Turned(truth, turned));
    std::vector<std::string> warnings = OpenSequence(folder_, options, poses).source->Warnings();
    for (std::string& warning : warnings) warning = Short(warning);
    return warnings;
  };
  const auto says = Contains(HasSubstr("~: up is -z, right if z of the poses' world points down"));
  EXPECT_THAT(warnings_of(Eigen::Vector3d::UnitX(), WorldUp::kAuto), says);
  EXPECT_THAT(warnings_of(Eigen::Vector3d::UnitX(), WorldUp::kMinusZ), testing::Not(says));
  EXPECT_THAT(warnings_of(Eigen::Vector3d::UnitZ(), WorldUp::kAuto), testing::Not(says));
  // As what poses of a left-handed world make of the floor.
  EXPECT_THAT(warnings_of(Eigen::Vector3d::UnitX(), WorldUp::kAuto, kPi - 0.3),
              Contains(testing::AllOf(HasSubstr(": up is ("), HasSubstr("left-handed world"))));
  const Pose3 first = Inverse(truth.front().world_from_camera);  // y down, z forward
  const Sequence camera_axes = OpenSequence(folder_, {}, SlamOutputOf(Turned(truth, first)));
  EXPECT_THAT(camera_axes.source->Warnings(), testing::IsEmpty());
}

// A camera that begins by looking down steeply in its own world, whose z then points down; nothing
// is wrong.
TEST_F(SequenceTest, AFirstCameraThatLooksDownIsNotDoubted) {
  const TumFolderWriter writer(folder_, Camera());
  Trajectory poses;
  std::vector<double> stamps_s;
  const auto pose_of = [](int i) {
    return TiltedCamera({0.3, 0.0, kPi * i / 6.0}, kCameraHeightM, i == 0 ? 1.3 : 0.35, 0.0);
  };
  const Pose3 first = Inverse(pose_of(0));
  for (int i = 0; i < 12; ++i) {
    stamps_s.push_back(0.125 * i);
    writer.WriteFrame(stamps_s.back(), AnalyticRoom{}.Render(Camera().camera, pose_of(i)), nullptr);
    poses.push_back({stamps_s.back(), first * pose_of(i)});
  }
  writer.Finish(stamps_s, false, poses);
  const Sequence sequence = OpenSequence(folder_);
  EXPECT_THAT(sequence.notes, Contains(HasSubstr("camera is 1.20 m above the floor")));
  EXPECT_THAT(sequence.source->Warnings(), testing::IsEmpty());
}

// Left on its back for three quarters of the recording, the camera sees the ceiling and a wall.
TEST_F(SequenceTest, WhatAStandingCameraSeesCountsOnce) {
  for (const bool at_first : {false, true}) {
    const TumFolderWriter writer(folder_, Camera());
    Trajectory poses;
    std::vector<double> stamps_s;
    for (int i = 0; i < 96; ++i) {
      const int walked = at_first ? i - 72 : i;
      const bool stands = walked < 0 || walked >= 24;
      const Pose3 pose = TiltedCamera({0.3, 0.0, stands ? 0.0 : kPi * walked / 6.0}, kCameraHeightM,
                                      stands ? -1.4 : 0.35, 0.0);
      stamps_s.push_back(0.125 * i);
      writer.WriteFrame(stamps_s.back(), AnalyticRoom{}.Render(Camera().camera, pose), nullptr);
      poses.push_back({stamps_s.back(), pose});
    }
    writer.Finish(stamps_s, false, poses);
    EXPECT_THAT(OpenSequence(folder_).notes, Contains("up is z, removed 0.0 degrees")) << at_first;
  }
}

// The remedy is named, and works.
TEST_F(SequenceTest, UpsideDownCamerasNeedAnOption) {
  const TumFolderWriter writer(folder_, Camera());
  Trajectory poses;
  std::vector<double> stamps_s;
  const auto pose_of = [](int i) {
    return TiltedCamera({0.3, 0.0, kPi * i / 6.0}, kCameraHeightM, 0.35, kPi);
  };
  const Pose3 first = Inverse(pose_of(0));
  for (int i = 0; i < 12; ++i) {
    stamps_s.push_back(0.125 * i);
    writer.WriteFrame(stamps_s.back(), AnalyticRoom{}.Render(Camera().camera, pose_of(i)), nullptr);
    poses.push_back({stamps_s.back(), first * pose_of(i)});
  }
  writer.Finish(stamps_s, false, poses);
  EXPECT_THAT(OpenSequence(folder_).source->Warnings(),
              Contains(HasSubstr("one is seen if the camera is mounted upside down (--set "
                                 "sequence.recording.upside_down=true)")));
  SequenceOptions options;
  options.recording.upside_down = true;
  const Sequence sequence = OpenSequence(folder_, options);
  EXPECT_THAT(sequence.source->Warnings(), testing::IsEmpty());
  EXPECT_THAT(sequence.notes, Contains(HasSubstr("camera is 1.20 m above the floor")));
}

// Each remedy is of the mount that is not set.
TEST_F(SequenceTest, UpsideDownOfAnUprightCameraIsWarnedOf) {
  WriteRoom();
  SequenceOptions options;
  options.recording.upside_down = true;
  const std::string upright =
      "if the camera is mounted upright (--set sequence.recording.upside_down=false)";
  EXPECT_THAT(OpenSequence(folder_, options).source->Warnings(), Contains(HasSubstr(upright)));
  EXPECT_EQ(UpDoubtText({"-z", true}, options.recording),
            "the floor seen in the images says -z, if they are upside down; " + upright +
                ", that is the ceiling");
}

TEST_F(SequenceTest, TheFloorOfAGivenAxisIsSeen) {
  const Trajectory truth = WriteRoom();
  const Pose3 higher{Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.6}};
  SequenceOptions options;
  options.world_up = WorldUp::kZ;
  const Sequence sequence = OpenSequence(folder_, options, SlamOutputOf(Turned(truth, higher)));
  EXPECT_FALSE(sequence.floor_z_m);  // what is given is not changed
  ASSERT_TRUE(sequence.seen_floor_z_m);
  EXPECT_NEAR(*sequence.seen_floor_z_m, 0.6, 0.02);
  EXPECT_FALSE(sequence.up_doubt);
}

TEST_F(SequenceTest, KindsAreDetected) {
  WriteRoom();
  EXPECT_EQ(DetectFormat(folder_), SequenceFormat::kTum);
  EXPECT_EQ(SequenceFrames(folder_).stamps_s.size(), 12U);
  std::filesystem::create_directories(Path("a/depth"));
  const std::string png = Path("depth/0.000000.png");
  std::filesystem::copy_file(png, Path("a/depth/1.png"));
  Write("a/room.gt.freiburg", "1 0 0 -2.25 0 0 0 1\n");
  EXPECT_EQ(DetectFormat(Path("a")), SequenceFormat::kIcl);
  EXPECT_EQ(SequenceFrames(Path("a")).stamps_s, std::vector<double>{1.0});
  std::filesystem::create_directories(Path("b"));
  std::filesystem::copy_file(png, Path("b/frame-000003.depth.png"));
  Write("b/frame-000003.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_EQ(DetectFormat(Path("b")), SequenceFormat::kFrames);
  EXPECT_EQ(SequenceFrames(Path("b")).stamps_s, std::vector<double>{0.1});
  Write("log.txt", "FLASER 3 1.0 2.0 3.0 0 0 0 0 0 0 1.5 host 1.5\n");
  EXPECT_EQ(DetectFormat(Path("log.txt")), SequenceFormat::kCarmen);
  EXPECT_EQ(OpenSequence(Path("log.txt")).kind, "CARMEN laser log");
}

// As the folder's own camera.yaml is: millimetres read as TUM's units give a fifth of the room.
TEST_F(SequenceTest, AGivenCameraWithoutDepthScaleIsWarnedOf) {
  WriteRoom();
  const std::string own = "width: 80\nheight: 60\nfx: 60.2\nfy: 60\ncx: 39.5\ncy: 29.5\n";
  Write("own.yaml", own);
  Write("matrix.txt", "60.2 0 39.5\n0 60 29.5\n0 0 1\n");
  Write("whole.yaml", own + "depth_scale: 5000\n");
  const auto warnings_with = [&](const std::string& camera) {
    SequenceOptions options;
    options.camera = Path(camera);
    return OpenSequence(folder_, options).source->Warnings();
  };
  for (const char* camera : {"own.yaml", "matrix.txt"}) {
    EXPECT_THAT(warnings_with(camera),
                Contains(HasSubstr(std::string(camera) + ": states no depth_scale; 5000 units")));
  }
  EXPECT_THAT(warnings_with("whole.yaml"),
              testing::Not(Contains(HasSubstr("states no depth_scale"))));
}

TEST_F(SequenceTest, OneClearLineForEachFault) {
  EXPECT_EQ(ErrorOf([&] { OpenSequence(Path("nothing")); }), "~/nothing: no such file or folder");
  EXPECT_THAT(ErrorOf([&] { OpenSequence(folder_); }),
              HasSubstr("~: is no kind of sequence that is known"));
  WriteRoom();
  for (const char* images : {"depth", "depth/"}) {
    EXPECT_THAT(ErrorOf([&] { DetectFormat(Path(images)); }),
                testing::AllOf(HasSubstr("depth"),
                               HasSubstr(": is no sequence, must be the folder above it"),
                               testing::EndsWith(", which holds depth.txt")));
  }
  SequenceOptions tum;
  tum.format = SequenceFormat::kTum;
  EXPECT_EQ(ErrorOf([&] { OpenSequence(Path("camera.yaml"), tum); }),
            "~/camera.yaml: is a file, must be a TUM RGB-D folder (sequence.format)");
  std::filesystem::remove(Path("groundtruth.txt"));
  EXPECT_EQ(ErrorOf([&] { OpenSequence(folder_); }),
            "~: a TUM folder needs poses: a TUM trajectory (--poses FILE), or groundtruth.txt in "
            "it");
  SequenceOptions options;
  EXPECT_THROW(Config::FromText("world_up: w", "x").Read(options), InputError);
}

TEST_F(SequenceTest, SharedKinectFramesFindTheirFloor) {
  const char* data = std::getenv("DEPTHGRID_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "DEPTHGRID_TEST_DATA is not set";
  const Sequence sequence = OpenSequence(std::string(data) + "/depth_frames/nvblox_3dmatch");
  EXPECT_EQ(sequence.kind, "folder of frames");
  EXPECT_EQ(sequence.source->FrameCount(), 5);
  // The recording's world has y up; the Kinect was carried at about a person's chest.
  EXPECT_THAT(sequence.notes, Contains(HasSubstr("up is (-0.0")));
  EXPECT_THAT(sequence.notes, Contains(HasSubstr("the camera is 1.4")));
}

}  // namespace
}  // namespace depthgrid
