// `depthgrid map` given the poses of a body and where the camera is on it.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "mapper/io/camera_mount.h"
#include "mapper/io/trajectory_file.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kSensor =
    "sensor_type: camera\nT_BS:\n  rows: 4\n  cols: 4\n  data: [0, 0, 1, 0.1, -1, 0, 0, 0.2, 0, "
    "-1, "
    "0, 0.3, 0, 0, 0, 1]\n";

class ProgramCameraMount : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Succeed("render ./small.yaml --no-colour --set sensor.noise=none -o seq");
    Write("sensor.yaml", kSensor);
    const CameraMount mount = ReadCameraMount(Path("sensor.yaml"));
    truth_ = ReadTrajectory(Path("seq/groundtruth.txt"));
    for (const StampedPose& pose : truth_) {
      body_.push_back({pose.stamp_s, pose.world_from_camera * Inverse(mount.body_from_camera)});
    }
    WriteTrajectory(Path("body.txt"), body_);
  }
  std::string EurocText() const {
    std::string text =
        "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x "
        "[],q_RS_y [],q_RS_z []\n";
    for (const auto& [stamp_s, pose] : body_) {
      const auto& t = pose.translation;
      const auto& q = pose.rotation;
      text += fmt::format("{:.0f},{},{},{},{},{},{},{}\n", 1e9 * stamp_s, t.x(), t.y(), t.z(),
                          q.w(), q.x(), q.y(), q.z());
    }
    return text;
  }
  double ErrorM() const {
    const Trajectory estimate = ReadTrajectory(Path("out/trajectory_est.txt"));
    EXPECT_EQ(estimate.size(), truth_.size());
    double worst_m = 0.0;
    for (std::size_t i = 0; i < std::min(truth_.size(), estimate.size()); ++i) {
      worst_m = std::max(worst_m, (truth_[i].world_from_camera.translation -
                                   estimate[i].world_from_camera.translation)
                                      .norm());
    }
    return worst_m;
  }
  static constexpr const char* kTrust =
      " --up z --set mapper.fusion.mode=fixed --set mapper.fusion.gain=0 -o out --force";
  Trajectory truth_, body_;
};

TEST_F(ProgramCameraMount, GivenPosesAndTheFoldersOwnBecomeTheCameras) {
  const std::string mounted = " --set sequence.camera_mount=sensor.yaml";
  Write("euroc.csv", EurocText());
  int mapped = 0;
  for (const char* poses : {"body.txt", "euroc.csv"}) {
    const Outcome outcome = Program(std::string("map seq --poses ") + poses + mounted + kTrust);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("the camera is at (0.100, 0.200, 0.300) m in its axes"));
    EXPECT_THAT(outcome.out, HasSubstr("as sensor.yaml (T_BS) says"));
    EXPECT_THAT(outcome.err, Not(HasSubstr("IMU")));
    EXPECT_LT(ErrorM(), 1e-6) << poses;
    ++mapped;
  }
  EXPECT_EQ(mapped, 2);
  WriteTrajectory(Path("seq/groundtruth.txt"), body_);
  const Outcome own = Program("map seq" + mounted + kTrust);
  EXPECT_THAT(own.out, HasSubstr("as sensor.yaml (T_BS) says"));
  EXPECT_LT(ErrorM(), 1e-6);
  // The run is made again from any folder.
  Succeed("map out/run.yaml -o again");
  EXPECT_EQ(ReadFile(Path("again/trajectory_est.txt")), ReadFile(Path("out/trajectory_est.txt")));
}

TEST_F(ProgramCameraMount, PosesOfAnImuAreNotTakenForTheCamerasUnsaid) {
  Write("euroc.csv", EurocText());
  const Outcome outcome = Program(std::string("map seq --poses euroc.csv") + kTrust);
  EXPECT_THAT(outcome.err,
              HasSubstr("warning: euroc.csv: EuRoC's and VINS's poses are those of the "
                        "IMU, these are taken for the camera's"));
  EXPECT_GT(ErrorM(), 0.1);
  // A camera file that says where the camera is, where nothing tells whose the poses are.
  Write("camera.yaml", std::string(kSensor) +
                           "intrinsics: [70, 70, 39.5, 29.5]\n"
                           "resolution: [80, 60]\n");
  const std::string with_camera = "map seq --poses body.txt --camera camera.yaml";
  const std::string note =
      "--set sequence.camera_mount=camera.yaml takes the camera's place on it "
      "from T_BS\n";
  EXPECT_THAT(Program(with_camera + kTrust).out, HasSubstr(note));
  EXPECT_THAT(Program(with_camera + " --set sequence.camera_mount=camera.yaml" + kTrust).out,
              Not(HasSubstr(note)));
}

TEST_F(ProgramCameraMount, WhatCannotBeIsRefused) {
  const std::string map = "map seq --poses body.txt -o out --set sequence.camera_mount=";
  Write("imu.yaml", "sensor_type: imu\nT_BS: [1]\n");
  Write("short.yaml", "T_BS: [1, 0]\n");
  Write("mm.yaml", "T_BS: [1, 0, 0, 65, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n");
  Write("other.yaml", "cam0:\n  T_cn_cnm1: [1]\n");
  ExpectRefusal(map + "none.yaml", {"none.yaml: no such file"});
  ExpectRefusal(map + "imu.yaml", {"imu.yaml:1: sensor_type is imu, must be camera"});
  ExpectRefusal(map + "short.yaml", {"short.yaml:1: 'T_BS' has 2 numbers"});
  ExpectRefusal(map + "mm.yaml", {"mm.yaml:1: the camera is 65 m from the body"});
  ExpectRefusal(map + "other.yaml", {"other.yaml: does not say where the camera is"});
  Write("up.txt", "70 -70 39.5 29.5 80 60\n");
  ExpectRefusal(map + "sensor.yaml --camera up.txt",
                {"--set sequence.camera_mount=sensor.yaml: sequence.camera_mount is sensor.yaml, "
                 "must be empty where fy is negative"});
}

}  // namespace
}  // namespace depthgrid
