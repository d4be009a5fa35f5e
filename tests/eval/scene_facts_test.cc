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
    const std::string hall = ReadFile(Path("hall.yaml"));
    Write("free.yaml", hall.substr(0, hall.find("  through")));
  }
};

TEST_F(SceneFacts, SaysSizeFloorAndPathsWithWhatIsWrong) {
  const Outcome outcome = Program("scenes ./hall.yaml");
  EXPECT_EQ(outcome.exit_code, 2);  // for scripts: a path is refused
  EXPECT_EQ(outcome.err, "depthgrid: ./hall.yaml: path 'through' is refused: no run can take it\n");
  EXPECT_THAT(outcome.out,
              HasSubstr("hall: 24 triangles, x 0.00 to 6.00, y 0.00 to 4.00, z -0.10 to 1.00 m\n"
                        "floor at z = 0.00 m, no ceiling\n"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("short +planar +2\\.2 m +[0-9]+\n"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex(
                               "refused: .*hall.yaml:6: trajectory 'through': frame [0-9]+ at "
                               "\\(3.7., 2.00, 0.60\\) is 0.1.. m from geometry"));
  EXPECT_THAT(outcome.out, testing::Not(HasSubstr("'short'")));
}

// A room of 5 x 4 x 2.5 m in centimetres; a site as large, and a tower, are no such thing.
TEST_F(SceneFacts, AMeshInCentimetresIsAskedForItsUnits) {
  const auto said_of = [&](const std::string& width, const std::string& height) {
    const std::string far = "v " + width + " ";
    Write("room.obj", "v 0 0 0\n" + far + "0 0\n" + far + "400 0\nv 0 400 0\nv 0 0 " + height +
                          "\nf 1 2 3\nf 1 3 4\nf 1 2 5\n");
    return Program("scenes ./room.obj").out;
  };
  EXPECT_THAT(said_of("500", "250"),
              HasSubstr("\nwarning: scene room: is 500 x 400 x 250 m large and high: is it in "
                        "metres? A mesh in centimetres needs scale: 0.01 where"));
  EXPECT_THAT(said_of("500", "40"), testing::Not(HasSubstr("metres?")));
  Write("scaled.yaml", "shapes: [{shape: mesh, file: ./room.obj, scale: 0.01}]\n");
  said_of("500", "250");
  EXPECT_THAT(Program("scenes ./scaled.yaml").out, testing::Not(HasSubstr("metres?")));
}

// Each of its frames may be far enough from a wall that it goes through between two of them.
TEST_F(SceneFacts, PathsAndMoversGoThroughNothingBetweenFrames) {
  Write("thin.yaml",
        "shapes:\n"
        "  - {shape: box, size: [8, 8, 0.1], at: [0, 0, -0.1]}\n"
        "  - {shape: wall, from: [0.52, -4], to: [0.52, 4], thickness_m: 0.02}\n"
        "movers:\n"
        "  tent:\n"
        "    shapes: [{shape: box, size: [0.02, 3, 2.5]}]\n"
        "    speed_mps: 10\n"
        "    waypoints: [{at: [-3.45, 0]}, {at: [0.4, 0]}]\n"
        "trajectories:\n"
        "  still: {kind: planar, clearance_m: 0.01, waypoints: [{at: [-2, 0]}, {at: [-1.5, 0]}]}\n"
        "  fast: {kind: planar, clearance_m: 0, speed_mps: 9, waypoints: [{at: [-2, 0]}, {at: [3, "
        "0]}]}\n");
  EXPECT_THAT(
      Program("scenes ./thin.yaml").out,
      testing::ContainsRegex(
          "refused: .*thin.yaml:11: trajectory 'fast': frame [0-9]+ at \\(0\\.[5-8]., 0.00, "
          "0.60\\) is behind a surface as seen from the frame before: the path goes through "
          "it"));
  Write("thin_run.yaml", "{scene: ./thin.yaml, trajectory: still, movers: tent}\n");
  ExpectRefusal("run ./thin_run.yaml -o out",
                {"thin.yaml:10: trajectory 'still': frame ",
                 ": mover 'tent' has gone through the camera since the frame before"});
}

TEST_F(SceneFacts, ThePlanShowsWhatStands) {
  Succeed("scenes ./free.yaml");
  EXPECT_EQ(Program("scenes ./hall.yaml --plan plan.png").exit_code, 2);  // and drawn all the same
  const RgbImage plan = DecodeRgbPng(ReadFile(Path("plan.png")), "plan.png");
  int black = 0;
  for (int v = 0; v < plan.height_px; ++v) {
    for (int u = 0; u < plan.width_px; ++u) black += plan.At(u, v)[0] == 0 ? 1 : 0;
  }
  // 5 x 81 cells are, 7 pixels a side, less what paths and lines cover of them.
  EXPECT_GT(black, 5 * 70 * 7 * 7);
  ExpectRefusal("scenes ./free.yaml --plan plan.png", {"plan.png: is there already"});
  Succeed("scenes ./free.yaml --plan plan.png --force");
  // Neither the scene nor a mesh in it is overwritten.
  ExpectRefusal("scenes ./hall.yaml --plan hall.yaml --force", {"hall.yaml: must end in .png"});
  ExpectRefusal("scenes ./hall.yaml --plan hall.obj --force", {"hall.obj: must end in .png"});
  ExpectRefusal("scenes ./hall.yaml --plan ''", {"--plan: is empty"});
  ExpectRefusal("scenes --plan other.png", {"depthgrid: --plan: draws one scene"});
  ExpectRefusal("scenes ./nowhere.yaml", {"nowhere.yaml: no such file"});
  Write("takes_hall.yaml", "scene: ./hall.yaml\n");
  ExpectRefusal("scenes ./takes_hall.yaml", {"takes_hall.yaml: is an experiment, must be a scene"});
  Write("sweep.yaml", "experiment: ./takes_hall.yaml\naxes: {seed: [1]}\n");
  ExpectRefusal("scenes ./sweep.yaml", {"sweep.yaml: is a sweep, must be a scene or mesh file"});
}

// The sixth has the first one's colour, in dashes, be it a camera's or a mover's.
TEST_F(SceneFacts, ThePlanTellsManyPathsApart) {
  const std::string text =
      "shapes: [{shape: box, size: [6, 4, 0.1], at: [3, 2, -0.101]}]\ntrajectories:\n";
  const auto plan_of = [&](int paths, const std::string& movers = "") {
    std::string scene = text;
    for (int i = 0; i < paths; ++i) {
      scene += "  path_" + std::to_string(i) + ": {kind: planar, waypoints: [{at: [1, " +
               std::to_string(0.5 + 0.5 * i) + "]}, {at: [5, " + std::to_string(0.5 + 0.5 * i) +
               "]}]}\n";
    }
    Write("many.yaml", scene + movers);
    Succeed("scenes ./many.yaml --plan many.png --force");
    return DecodeRgbPng(ReadFile(Path("many.png")), "many.png");
  };
  const RgbImage six = plan_of(6), one = plan_of(1);
  const RgbImage five_and_mover = plan_of(
      5, "movers: {last: {shapes: [{shape: box}], waypoints: [{at: [1, 3]}, {at: [5, 3]}]}}\n");
  const auto pixels_of = [](const RgbImage& image, int from_row, int to_row) {
    int pixels = 0;
    for (int v = from_row; v < to_row; ++v) {
      for (int u = 0; u < image.width_px; ++u) {
        const std::uint8_t* p = image.At(u, v);
        pixels += p[0] == 0 && p[1] == 114 && p[2] == 178 ? 1 : 0;
      }
    }
    return pixels;
  };
  // Above the legend.
  const int whole = pixels_of(one, 0, 600);
  ASSERT_GT(whole, 0);
  for (const RgbImage* plan : {&six, &five_and_mover}) {
    EXPECT_GT(pixels_of(*plan, 0, 600), 3 * whole / 2);
    EXPECT_LT(pixels_of(*plan, 0, 600), 9 * whole / 5);
  }
}

TEST_F(SceneFacts, AFileMayIncludeThePartsOfTheShippedScenes) {
  const std::string scene =
      "include: parts/people.yaml\n" + std::string(kRoom) +
      "movers:\n  guest:\n    shapes: [{shape: use, group: person}]\n"
      "    there_and_back: true\n    waypoints: [{at: [1, 1]}, {at: [2, 1]}]\n";
  Write("guests.yaml", scene);
  EXPECT_THAT(Program("scenes ./guests.yaml").out, HasSubstr("guest"));
  // One beside the scene comes first.
  std::filesystem::create_directory(Path("parts"));
  Write("parts/people.yaml", "groups: {}\n");
  ExpectRefusal("scenes ./guests.yaml", {"group 'person' is not in 'groups'"});
}

TEST_F(SceneFacts, ForceWithoutAPictureIsSaid) {
  const std::string idle = "depthgrid: warning: --force: has no effect without --plan\n";
  EXPECT_EQ(Program("scenes --force").err, idle);
  EXPECT_EQ(Program("scenes ./free.yaml --force").err, idle);
  EXPECT_EQ(Program("scenes ./free.yaml --force --plan free.png").err, "");
}

TEST_F(SceneFacts, HowMoversGoIsSaid) {
  const std::string shapes = "shapes: [{shape: box, size: [0.2, 0.2, 1]}]";
  const std::string way = ", waypoints: [{at: [1, 3]}, {at: [3, 3]}, {at: [3, 1]}]";
  Write("busy.yaml", ReadFile(Path("hall.yaml")) + "movers:\n" +            //
                         "  one: {" + shapes + way + "}\n" +                //
                         "  two: {" + shapes + way + ", closed: true}\n" +  //
                         "  three: {" + shapes + way + ", closed: true, laps: 2.5}\n" +
                         "  four: {" + shapes + way + ", there_and_back: true, laps: 3}\n" +
                         "  five: {" + shapes + ", ahead_m: 1.5}\n");
  const std::string out = Program("scenes ./busy.yaml").out;
  EXPECT_THAT(out, testing::ContainsRegex("one +once +0 +4"));
  EXPECT_THAT(out, testing::ContainsRegex("two +round +0 "));
  EXPECT_THAT(out, testing::ContainsRegex("three +round, laps: 2\\.5 +0 "));
  EXPECT_THAT(out, testing::ContainsRegex("four +there and back, laps: 3 +0 "));
  EXPECT_THAT(out, testing::ContainsRegex("five +1\\.5 m ahead of the camera +0 +- +-"));
}

}  // namespace
}  // namespace depthgrid
