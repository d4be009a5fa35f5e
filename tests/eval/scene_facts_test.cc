// `depthgrid scenes SCENE`: a scene and its paths before an experiment takes them.
#include "mapper/io/png.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using testing::HasSubstr;

class SceneFacts : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Write("hall.yaml",
          "shapes:\n"
          "  - {shape: box, size: [6, 4, 0.1], at: [3, 2, -0.101]}\n"
          "  - {shape: box, size: [0.2, 4, 1], at: [4, 2, 0]}\n"
          "trajectories:\n"
          "  short: {kind: planar, waypoints: [{at: [1, 1]}, {at: [2, 3]}]}\n"
          "  through: {kind: planar, waypoints: [{at: [1, 2]}, {at: [5, 2]}]}\n");
  }
};

TEST_F(SceneFacts, SaysSizeFloorAndPathsWithWhatIsWrong) {
  const Outcome outcome = Program("scenes ./hall.yaml");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("hall: 24 triangles, x 0.00 to 6.00, y 0.00 to 4.00, z -0.10 to 1.00 m\n"
                        "floor at z = 0.00 m, no ceiling\n"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("short +planar +2\\.2 m +[0-9]+\n"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex(
                               "refused: .*hall.yaml:6: trajectory 'through': frame [0-9]+ at "
                               "\\(3.7., 2.00, 0.60\\) is 0.1.. m from geometry"));
  EXPECT_THAT(outcome.out, testing::Not(HasSubstr("'short'")));
}

TEST_F(SceneFacts, ThePlanShowsWhatStands) {
  Succeed("scenes ./hall.yaml --plan plan.png");
  const RgbImage plan = DecodeRgbPng(ReadFile(Path("plan.png")), "plan.png");
  int black = 0;
  for (int v = 0; v < plan.height_px; ++v) {
    for (int u = 0; u < plan.width_px; ++u) black += plan.At(u, v)[0] == 0 ? 1 : 0;
  }
  // 5 x 81 cells are, 7 pixels a side, less what paths and lines cover of them.
  EXPECT_GT(black, 5 * 70 * 7 * 7);
  ExpectRefusal("scenes ./hall.yaml --plan plan.png", {"plan.png: is there already"});
  Succeed("scenes ./hall.yaml --plan plan.png --force");
  // Neither the scene nor a mesh in it is overwritten.
  ExpectRefusal("scenes ./hall.yaml --plan hall.yaml --force", {"hall.yaml: must end in .png"});
  ExpectRefusal("scenes ./hall.yaml --plan hall.obj --force", {"hall.obj: must end in .png"});
  ExpectRefusal("scenes ./hall.yaml --plan ''", {"--plan: is empty"});
  ExpectRefusal("scenes --plan other.png", {"depthgrid: --plan: draws one scene"});
  ExpectRefusal("scenes ./nowhere.yaml", {"nowhere.yaml: no such file"});
  Write("takes_hall.yaml", "scene: ./hall.yaml\n");
  ExpectRefusal("scenes ./takes_hall.yaml", {"takes_hall.yaml: is an experiment, must be a scene"});
}

}  // namespace
}  // namespace depthgrid
