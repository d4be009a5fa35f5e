#include "mapper/io/camera_mount.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "mapper/io/camera_formats.h"
#include "mapper/io/lost_markers.h"
#include "mapper/io/slam_files.h"
#include "tests/io/temporary_folder.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

// The camera looks along the body's x axis and is 0.1 m ahead of it, 0.2 m to its left, 0.3 m up.
constexpr const char* kRows = "[[0, 0, 1, 0.1], [-1, 0, 0, 0.2], [0, -1, 0, 0.3], [0, 0, 0, 1]]";
constexpr const char* kList = "[0, 0, 1, 0.1, -1, 0, 0, 0.2, 0, -1, 0, 0.3, 0, 0, 0, 1]";
constexpr const char* kInverse =
    "[[0, -1, 0, 0.2], [0, 0, -1, 0.3], [1, 0, 0, -0.1], [0, 0, 0, 1]]";

std::string MountRefused(const std::string& text) {
  return RefusalOf([&] { ParseCameraMount(text, "m"); });
}

TEST(CameraMount, OfEachProgramIsTheSame) {
  const std::string list = kList, rows = kRows, inverse = kInverse;
  const std::pair<std::string, std::string> files[] = {
      {"sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: " + list + "\n", "m (T_BS)"},
      {"cam0:\n  T_cam_imu: " + inverse + "\ncam1:\n  T_cam_imu: " + rows + "\n",
       "m (cam0.T_cam_imu)"},
      {"T_imu_cam: " + rows + "\n", "m (T_imu_cam)"},
      {"%YAML:1.0\n---\nbody_T_cam0: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: d\n   data: " +
           list + "\n",
       "m (body_T_cam0)"},
      {"%YAML:1.0\nCamera.fx: 5\nIMU.T_b_c1: !!opencv-matrix\n   data: " + list + "\n",
       "m (IMU.T_b_c1)"},
      {"Tbc: !!opencv-matrix\n   data: " + list + "\n", "m (Tbc)"},
      {"0 0 1 0.1\n-1 0 0 0.2\n0 -1 0 0.3\n0 0 0 1\n", "m"},
      {"# on one line\n0 0 1 0.1 -1 0 0 0.2 0 -1 0 0.3\n", "m"}};
  int read = 0;
  for (const auto& [text, stated_as] : files) {
    SCOPED_TRACE(text);
    const CameraMount mount = ParseCameraMount(text, "m");
    EXPECT_EQ(mount.stated_as, stated_as);
    EXPECT_LT((mount.body_from_camera.translation - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-12);
    const Eigen::Vector3d ahead = mount.body_from_camera.rotation * Eigen::Vector3d::UnitZ();
    EXPECT_LT((ahead - Eigen::Vector3d::UnitX()).norm(), 1e-12);
    ++read;
  }
  EXPECT_EQ(read, 8);
}

TEST(CameraMount, OneClearLineForEachFault) {
  EXPECT_EQ(MountRefused(std::string("\nsensor_type: imu\nT_BS: ") + kRows + "\n"),
            "m:2: sensor_type is imu, must be camera");
  EXPECT_EQ(MountRefused("cam0:\n  intrinsics: [1, 2, 3, 4]\n"),
            "m: does not say where the camera is on the body, must hold a 4x4 matrix: alone or as "
            "T_BS, T_cam_imu, T_imu_cam, body_T_cam0, IMU.T_b_c1 or Tbc");
  EXPECT_EQ(MountRefused("a: 1\nT_BS: [1, 0, 0]\n"),
            "m:2: 'T_BS' has 3 numbers, must have the 16 of a 4x4 matrix");
  EXPECT_EQ(MountRefused("T_BS:\n  data: [1, 0, zero]\n"),
            "m:1: 'T_BS' holds zero, must be a list of numbers");
  EXPECT_EQ(MountRefused("T_BS:\n  rows: 4\n"), "m:1: key 'T_BS.data' is missing");
  EXPECT_EQ(MountRefused("T_imu_cam: [1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n"),
            "m:1: the matrix's upper left 3x3 must be a rotation");
  EXPECT_EQ(MountRefused("T_imu_cam: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2]\n"),
            "m:1: the matrix's last row must be 0 0 0 1");
  EXPECT_EQ(MountRefused("T_imu_cam: [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]\n"),
            "m:1: the matrix's upper left 3x3 is zero, must be a rotation");
  EXPECT_EQ(MountRefused("T_BS: [1, 0, 0, 65, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n"),
            "m:1: the camera is 65 m from the body, must be at most 10: positions are in metres");
  EXPECT_EQ(MountRefused("1 0 0 0\n0 1 0 0\n0 0 1 nan\n0 0 0 1\n"),
            "m: the matrix must be finite and a rigid motion");
  EXPECT_EQ(MountRefused("1 0 0 0\n0 1 0 0\n0 0 1\n0 0 0 1\n"), "m:3: has 3 columns, must have 4");
}

TEST(CameraMount, OfACameraFileIsNamed) {
  const std::string rest = "intrinsics: [5, 5, 2, 2]\nresolution: [4, 4]\n";
  EXPECT_EQ(ParseCameraDescription(rest, "c").mount_key, "");
  EXPECT_EQ(ParseCameraDescription(rest + "T_BS: " + kRows + "\n", "c").mount_key, "T_BS");
  EXPECT_EQ(ParseCameraDescription("cam0:\n  T_cam_imu: 1\n  intrinsics: [5, 5, 2, 2]\n  "
                                   "resolution: [4, 4]\n",
                                   "c")
                .mount_key,
            "cam0.T_cam_imu");
}

// Of a body's files: the poses, the loops between them, and the identity of a tracker that is lost.
class CameraMountOfFiles : public TemporaryFolderTest {
 protected:
  SlamInput Read(const std::string& loops) const {
    SlamReading reading;
    reading.mount = ParseCameraMount(std::string("T_BS: ") + kRows + "\n", "m");
    return ReadSlamFiles({Path("body.txt"), "", loops.empty() ? "" : Path(loops)},
                         {{1.0, 2.0, 3.0, 4.0}}, reading);
  }
  static Eigen::Vector3d At(const SlamPose& pose) { return pose.slam_from_camera->translation; }
};

TEST_F(CameraMountOfFiles, PosesAndLoopsBecomeTheCameras) {
  // The body turns to the left about z by a quarter.
  Write("body.txt", "1 5 0 0 0 0 0 1\n2 5 0 0 0 0 0 1\n3 5 0 0 0 0 0.70710678 0.70710678\n");
  Write("stamped.txt", "1 3 0 0 0 0 0 0.70710678 0.70710678\n");
  const SlamInput stamped = Read("stamped.txt");
  EXPECT_LT((At(stamped.slam.live[0]) - Eigen::Vector3d(5.1, 0.2, 0.3)).norm(), 1e-12);
  EXPECT_LT((At(stamped.slam.live[2]) - Eigen::Vector3d(4.8, 0.1, 0.3)).norm(), 1e-7);
  ASSERT_EQ(stamped.slam.loops.size(), 1U);
  const Pose3 shown =
      Between(*stamped.slam.live[0].slam_from_camera, *stamped.slam.live[2].slam_from_camera);
  EXPECT_LT((stamped.slam.loops[0].first_from_second.translation - shown.translation).norm(), 1e-7);
  EXPECT_LT(stamped.slam.loops[0].first_from_second.rotation.angularDistance(shown.rotation), 1e-7);
  // ORB-SLAM's loops join cameras.
  Write("orb.txt", "LOOP 2 3.0 0 1.0 Tcm 1 0 0 -0.5 0 1 0 0 0 0 1 0\n");
  const SlamInput orb = Read("orb.txt");
  ASSERT_EQ(orb.slam.loops.size(), 1U);
  EXPECT_EQ(orb.slam.loops[0].first_from_second.translation.cwiseAbs(), Eigen::Vector3d(0.5, 0, 0));
}

TEST_F(CameraMountOfFiles, TheIdentityOfALostTrackerIsStillKnown) {
  const CameraMount mount = ParseCameraMount(std::string("T_BS: ") + kRows + "\n", "m");
  std::vector<SlamPose> live;
  for (int i = 0; i < 8; ++i) {
    const bool is_lost = i == 4 || i == 5;
    live.push_back({0.1 * i, is_lost ? Pose3{} : Pose3{{}, {5.0 + 0.01 * i, 0.0, 0.0}}, 0});
    live.back().slam_from_camera->rotation.setIdentity();
  }
  const std::vector<int> lost = {4, 5};
  EXPECT_EQ(FindLostMarkers(live), lost);
  const auto mounted = OnBody({live, {}, {}}, mount).live;
  EXPECT_EQ(FindLostMarkers(mounted), std::vector<int>{});
  EXPECT_EQ(FindLostMarkers(mounted, OnBody(Pose3{}, mount)), lost);
}

}  // namespace
}  // namespace depthgrid
