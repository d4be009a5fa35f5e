// Files of other programs' poses through the program: the result
// is that of depthgrid's own files.
#include <fmt/format.h>
#include <gmock/gmock.h>

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
  for (const char* file : {"euroc.csv", "rtabmap.txt"}) {
    EXPECT_EQ(Mapped(std::string("seq --poses ") + file), std::pair(own, std::string())) << file;
  }
  const auto [vins, said] = Mapped("seq --poses vins.csv --final-poses euroc.csv");
  EXPECT_EQ(vins, own);
  EXPECT_THAT(said, HasSubstr("vins.csv: no header names its columns"));
  Succeed("eval trajectory seq/groundtruth.txt rtabmap.txt");
  Write("bare.txt", ids.substr(ids.find('\n') + 1));
  const Outcome refused = Program("map seq -o out2 --poses bare.txt");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("bare.txt:1: has 9 columns, must have 8"));
}

}  // namespace
}  // namespace depthgrid
