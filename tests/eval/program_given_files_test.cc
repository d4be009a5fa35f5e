// Files of other programs' poses and cameras, and old laser logs, through the program: the result
// is that of depthgrid's own files.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "mapper/io/camera_formats.h"
#include "mapper/io/matrix_poses.h"
#include "mapper/io/trajectory_file.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;

class ProgramGivenFiles : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Succeed("render ./small.yaml --no-colour --set sensor.noise=none -o seq");
    truth_ = ReadTrajectory(Path("seq/groundtruth.txt"));
  }
  // The estimate and what is said on the way.
  std::pair<std::string, std::string> Mapped(const std::string& arguments) const {
    const Outcome outcome = Program("map " + arguments + " -o out --force");
    EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
    return {ReadFile(Path("out/trajectory_est.txt")), outcome.err};
  }
  // Rows of nanoseconds with w first, `rest` behind each.
  std::string WFirstRows(const std::string& rest) const {
    std::string text;
    for (const auto& [stamp_s, pose] : truth_) {
      const auto& t = pose.translation;
      const auto& q = pose.rotation;
      text += fmt::format("{:.0f},{},{},{},{},{},{},{}{}\n", stamp_s * 1e9, t.x(), t.y(), t.z(),
                          q.w(), q.x(), q.y(), q.z(), rest);
    }
    return text;
  }

  Trajectory truth_;
};

TEST_F(ProgramGivenFiles, PosesOfOtherPrograms) {
  const std::string own = Mapped("seq --poses seq/groundtruth.txt").first;
  Write("euroc.csv",
        "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],"
        "q_RS_z [],v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1]\n" +
            WFirstRows(",0,0,0"));
  Write("vins.csv", WFirstRows(",0,0,0,"));
  std::string ids = "#timestamp x y z qx qy qz qw id\n";
  int id = 0;
  for (const StampedPose& pose : truth_) {
    const std::string row = TrajectoryText({pose});
    ids += fmt::format("{} {}\n", row.substr(0, row.size() - 1), ++id);
  }
  Write("rtabmap.txt", ids);
  EXPECT_EQ(Mapped("seq --poses rtabmap.txt"), std::pair(own, std::string()));
  const auto [euroc, of_imu] = Mapped("seq --poses euroc.csv");
  EXPECT_EQ(euroc, own);
  EXPECT_EQ(std::count(of_imu.begin(), of_imu.end(), '\n'), 1) << of_imu;
  EXPECT_THAT(of_imu, HasSubstr("euroc.csv: EuRoC's and VINS's poses are those of the IMU"));
  const auto [vins, said] = Mapped("seq --poses vins.csv --final-poses euroc.csv");
  EXPECT_EQ(vins, own);
  EXPECT_THAT(said, HasSubstr("vins.csv: no header names its columns"));
  Succeed("eval trajectory seq/groundtruth.txt rtabmap.txt");
  Write("bare.txt", ids.substr(ids.find('\n') + 1));
  const Outcome refused = Program("map seq -o out2 --poses bare.txt");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("bare.txt:1: has 9 columns, must have 8"));
}

TEST_F(ProgramGivenFiles, CamerasOfOtherPrograms) {
  const std::string own = Mapped("seq").first;
  const PinholeCamera c = ReadCameraDescription(Path("seq/camera.yaml")).file.camera;
  Write("open3d.json",
        fmt::format("{{\n\t\"width\" : {},\n\t\"height\" : {},\n\t\"intrinsic_matrix\" : \n\t[\n"
                    "\t\t{},\n\t\t0,\n\t\t0,\n\t\t0,\n\t\t{},\n\t\t0,\n\t\t{},\n\t\t{},\n\t\t1\n"
                    "\t]\n}}",
                    c.width_px, c.height_px, c.fx_px, c.fy_px, c.cx_px, c.cy_px));
  Write("realsense.json",
        fmt::format("{{\"width\": {}, \"height\": {}, \"fx\": {}, \"fy\": {}, \"ppx\": {}, "
                    "\"ppy\": {}, \"model\": \"distortion.brown_conrady\", \"coeffs\": [0.0, 0.0, "
                    "0.0, 0.0, 0.0]}}",
                    c.width_px, c.height_px, c.fx_px, c.fy_px, c.cx_px, c.cy_px));
  Write("kalibr.yaml",
        fmt::format("cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0, 0, 0, 0]\n  "
                    "distortion_model: radtan\n  intrinsics: [{}, {}, {}, {}]\n  resolution: [{}, "
                    "{}]\n",
                    c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.width_px, c.height_px));
  Write("numbers.txt", fmt::format("{} {} {} {}\n", c.fx_px, c.fy_px, c.cx_px, c.cy_px));
  Write("sized.txt", fmt::format("{} {} {} {} {} {}\n", c.fx_px, c.fy_px, c.cx_px, c.cy_px,
                                 c.width_px, c.height_px));
  Write("matrix.txt", fmt::format("{} 0 {} 0\n0 {} {} 0\n0 0 1 0\n0 0 0 1\n", c.fx_px, c.cx_px,
                                  c.fy_px, c.cy_px));
  std::string listing = "Intrinsic Parameters:\n\n";
  for (const int times : {2, 1}) {
    listing += fmt::format(
        " Intrinsic of \"Depth\" / {0}x{1} / {{Z16}}\n  Width: \t{0}\n  Height: \t{1}\n  PPX: "
        "\t{2}\n  PPY: \t{3}\n  Fx: \t{4}\n  Fy: \t{5}\n  Distortion: \tBrown Conrady\n  "
        "Coeffs: \t0  \t0  \t0  \t0  \t0  \n  FOV (deg): \t67 x 53\n\n",
        times * c.width_px, times * c.height_px, c.cx_px, c.cy_px, c.fx_px, c.fy_px);
  }
  Write("listing.txt", listing);
  for (const char* file : {"open3d.json", "realsense.json", "kalibr.yaml", "numbers.txt",
                           "sized.txt", "matrix.txt", "listing.txt"}) {
    EXPECT_EQ(Mapped(std::string("seq --camera ") + file).first, own) << file;
  }
}

// One line each tells how many frames have no pose, and what was assumed.
TEST_F(ProgramGivenFiles, FewPosesAreToldOnce) {
  const auto lines_about_poses = [&](const std::string& arguments) {
    const std::string said = Mapped(arguments).second;
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < said.size(); at = said.find('\n', at) + 1) {
      const std::string line = said.substr(at, said.find('\n', at) - at);
      if (line.find("frames") != std::string::npos) lines.push_back(line);
    }
    return lines;
  };
  WriteTrajectory(Path("few.txt"), Trajectory(truth_.begin(), truth_.begin() + 4));
  EXPECT_THAT(lines_about_poses("seq --poses few.txt"),
              ::testing::ElementsAre(HasSubstr("few.txt: gives 4 of 12 frames a pose: ")));
  // Of more than half of the frames as well.
  for (const int count : {4, 8}) {
    Write("kitti.txt", MatrixPosesText({truth_.begin(), truth_.begin() + count}));
    EXPECT_THAT(lines_about_poses("seq --poses kitti.txt"),
                ::testing::ElementsAre(HasSubstr(fmt::format(
                    "kitti.txt: {0} poses for 12 frames, without stamps: taken for the first {0} "
                    "frames, so {1} frames have no pose; if they",
                    count, 12 - count))));
  }
  // One for each frame, of which one says that there is none.
  std::string matrices = MatrixPosesText({truth_.begin() + 1, truth_.begin() + 12});
  Write("kitti.txt", "nan 0 0 0 0 1 0 0 0 0 1 0\n" + matrices);
  EXPECT_THAT(lines_about_poses("seq --poses kitti.txt"),
              ::testing::ElementsAre(HasSubstr("seq: 1 of 12 frames has no pose")));
}

TEST_F(ProgramGivenFiles, ScansWithoutPosesAreThoseOfTheOdometry) {
  std::string robot, raw;
  for (int i = 0; i < 40; ++i) {
    const double x_m = 1.0 + 0.03 * i, stamp_s = 0.1 * i;
    std::string readings;
    for (int k = 0; k < 181; ++k) {  // of a corridor 2 m wide that ends at 5 m
      const double bearing_rad = (k - 90) * 3.14159265358979 / 180.0;
      const double ahead_m = (5.0 - x_m) / std::max(1e-9, std::cos(bearing_rad));
      const double aside_m = 1.0 / std::max(1e-9, std::abs(std::sin(bearing_rad)));
      readings += fmt::format(" {:.4f}", std::min({ahead_m, aside_m, 80.0}));
    }
    const std::string head = " 0 -1.570796 3.141593 0.017453 80 0.01 0 181" + readings + " 0";
    robot += fmt::format("ROBOTLASER1{} {} 0 0 {} 0 0 0 0 0 0 0 {:.6f} h {:.6f}\n", head, x_m, x_m,
                         stamp_s, stamp_s);
    raw += fmt::format("ODOM {} 0 0 0 0 0 {:.6f} h {:.6f}\n", x_m, stamp_s, stamp_s);
    raw += fmt::format("RAWLASER1{} {:.6f} h {:.6f}\n", head, stamp_s, stamp_s);
  }
  Write("robot.log", robot);
  Write("raw.log", raw);
  const std::string own = Mapped("robot.log").first;
  const auto [of_raw, said] = Mapped("raw.log");
  EXPECT_EQ(of_raw, own);
  EXPECT_THAT(said, HasSubstr("raw.log: scans are RAWLASER1 lines"));
}

}  // namespace
}  // namespace depthgrid
