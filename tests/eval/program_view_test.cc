// The program end to end: what it says of a camera that sees nothing to map or to match.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>

#include "mapper/io/file.h"
#include "mapper/io/png.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class ProgramView : public ProgramTest {};

TEST_F(ProgramView, AnEmptyMapIsSaidWithItsCause) {
  const auto said = [&](const std::string& arguments) {
    const Outcome outcome = Program(arguments + " -o out --force");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.err;
  };
  const std::string band = " --set mapper.scan.band_low_m=5 --set mapper.scan.band_high_m=6";
  const auto names_band =
      AllOf(HasSubstr("no frame sees anything from 5 to 6 m above the floor"),
            HasSubstr("and 0.4 to 6 m away"), HasSubstr("the images, 80x60 pixels and "),
            HasSubstr("show depth from "), Not(HasSubstr("path")));
  EXPECT_THAT(said("run ./small.yaml" + band), names_band);
  EXPECT_THAT(said("run ./small.yaml --set sensor.max_range_m=0.1"),
              AllOf(HasSubstr("degrees wide, hold no measurement"), Not(HasSubstr("path"))));
  Succeed("render ./small.yaml --no-colour -o seq");
  EXPECT_THAT(said("map seq" + band), AllOf(HasSubstr("warning: seq: "), names_band));
  EXPECT_EQ(said("map seq"), "");
}

// The angle from edge to edge: 2 atan(40 / 60) about the centre, little far beside it.
TEST_F(ProgramView, TheImagesWidthIsThatOfTheirEdges) {
  const auto said = [&](const std::string& camera) {
    return Program(
               "run ./small.yaml -o out --force --set sensor.max_range_m=0.1 "
               "--set sensor.fx=60 --set sensor.fy=60" +
               camera)
        .err;
  };
  EXPECT_THAT(said(""), HasSubstr("80x60 pixels and 67.4 degrees wide"));
  EXPECT_THAT(said(" --set sensor.cx=400 --set sensor.cy=30"),
              HasSubstr("80x60 pixels and 2.08 degrees wide"));
}

TEST_F(ProgramView, AMapOfACameraAtAnotherHeightIsWarnedOf) {
  const auto said = [&](const std::string& heights) {
    Write("first/frames.csv", heights);
    return Program("map seq --map first --localise -o out --force").err;
  };
  const auto says = HasSubstr("first: made with the camera 0.70 m above the floor, which is 1.1");
  Succeed("render ./small.yaml --no-colour -o seq");
  Succeed("map seq -o first");
  EXPECT_THAT(Program("map seq --map first --localise -o out").err, Not(HasSubstr("height")));
  EXPECT_THAT(said("frame,camera_height_m\n0,0.8\n1,0.6\n2,\n3,0.7\n"), says);
  EXPECT_THAT(said("frame,camera_height_m\n0,0.95\n1,\n"), Not(HasSubstr("height")));
  EXPECT_THAT(said("frame\n0\n"), Not(HasSubstr("height")));  // of an earlier version
  EXPECT_THAT(said(""), Not(HasSubstr("frames.csv")));  // damaged, and needed for nothing else
}

// The floor of a scene need not be at 0; where up is given it is not looked for.
TEST_F(ProgramView, ARenderedFoldersFloorIsTaken) {
  Write("high.yaml", R"(
floor_z_m: 1.5
shapes:
  - {shape: box, size: [3, 4, 0.1], at: [1.5, 2, 1.4]}
  - {shape: box, size: [3, 0.1, 2.5], at: [1.5, 4, 1.5]}
  - {shape: box, size: [0.1, 4, 2.5], at: [0, 2, 1.5]}
  - {shape: box, size: [0.5, 0.5, 1.5], at: [0.4, 2.0, 1.5]}
trajectories:
  look_around:
    kind: handheld
    waypoints:
      - {at: [1.5, 1.0, 2.6], look_at: [1.5, 4.0, 2.5]}
      - {at: [1.9, 2.0, 2.6], look_at: [0.0, 3.0, 2.5]}
)");
  Succeed(
      "render ./high.yaml --no-colour -o seq --set frames=20 --set sensor.width=80 --set "
      "sensor.height=60");
  const Outcome own = Program("map seq --up z -o out");
  EXPECT_THAT(own.out, HasSubstr("the floor is at z = 1.50, as seq/render.yaml says\n"));
  EXPECT_THAT(own.err, Not(HasSubstr("the floor seen in the images")));
  // A setting counts, and so do poses whose floor is elsewhere.
  EXPECT_THAT(Program("map seq --up z -o out --force --set mapper.scan.floor_z_m=1.4").out,
              Not(HasSubstr("the floor is at")));
  std::string moved;
  std::istringstream poses(ReadFile(Path("seq/groundtruth.txt")));
  for (std::string stamp, x, y, rest; poses >> stamp;) {
    double z = 0.0;
    if (stamp != "#") {
      poses >> x >> y >> z;
      moved += stamp + " " + x + " " + y + " " + std::to_string(z - 1.5);
    }
    std::getline(poses, rest);
    if (stamp != "#") moved += rest + "\n";
  }
  Write("moved.txt", moved);
  EXPECT_THAT(Program("map seq --poses moved.txt --up z -o out --force").out,
              Not(HasSubstr("the floor is at")));
}

// A sensor that gives its farthest depth for all that is beyond it, with some wrong pixels.
TEST_F(ProgramView, ImagesThatAreCutSayNothingOfPoses) {
  Succeed("render ./small.yaml --no-colour -o seq --set frames=60");
  int pixel = 0;
  for (const auto& entry : std::filesystem::directory_iterator(Path("seq/depth"))) {
    DepthImage image(80, 60);
    std::fill(image.z_m.begin(), image.z_m.end(), 8.0F);
    image.z_m[static_cast<std::size_t>(37 * ++pixel)] = 7.0F;
    WriteDepthPng(entry.path().string(), image, 5000.0);
  }
  const Outcome outcome = Program("map seq -o out");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("show depth from 7 to 8 m"), Not(HasSubstr("do not fit the poses"))));
}

// Three rows of an image make an obstacle, but no slice of so few pixels has them.
TEST_F(ProgramView, ThatNothingCanBeMatchedIsSaidWithItsCause) {
  const std::string said =
      Program("run ./small.yaml -o out --set sensor.width=8 --set sensor.height=8").err;
  EXPECT_THAT(said, AllOf(HasSubstr("nothing could be matched, the poses are those given"),
                          HasSubstr("within 0.1 m of the camera's height"), HasSubstr("8x8 pixels"),
                          Not(HasSubstr("path"))));
}

// Of frames.csv: rows with a score of their match.
int RowsWithMatch(const std::string& file) {
  std::istringstream lines(ReadFile(file));
  std::string line;
  std::getline(lines, line);
  const auto commas_to = line.find("match_score");
  const auto column = std::count(line.begin(), line.begin() + commas_to, ',');
  int rows = 0;
  while (std::getline(lines, line)) {
    std::size_t at = 0;
    for (int k = 0; k < column; ++k) at = line.find(',', at) + 1;
    rows += line[at] != ',' ? 1 : 0;
  }
  return rows;
}

// Walls come as near as that for part of the way only.
TEST_F(ProgramView, ThatFewFramesCouldBeMatchedIsSaid) {
  const std::string said =
      Program("run ./small.yaml -o out --set frames=60 --set mapper.scan.max_range_m=2").err;
  const int matched = RowsWithMatch(Path("out/frames.csv"));
  EXPECT_GT(matched, 10);
  EXPECT_LT(matched, 50);
  EXPECT_THAT(said,
              AllOf(HasSubstr("warning: " + std::to_string(matched) +
                              " of 59 frames could be matched, the poses of the others are "
                              "those given: "),
                    HasSubstr(": in "),
                    HasSubstr(" of the others, the first is frame 1, the camera sees at its height "
                              "mostly what is beyond 2 m "
                              "(mapper.scan.max_range_m); the images"),
                    HasSubstr("80x60 pixels"), Not(HasSubstr("path"))));
}

TEST_F(ProgramView, WhereEnoughIsSeenTheMatchIsToBlame) {
  const auto said = [&](const std::string& settings) {
    return Program("run ./small.yaml -o out --force --set frames=60 " + settings).err;
  };
  const std::string match = " --set mapper.surfel.match.";
  EXPECT_THAT(said("--set sensor.noise_scale=4" + match + "gate_m=0.01" + match + "along_m=0.01" +
                   match + "max_angle_deg=1"),
              AllOf(HasSubstr("does not fit what was mapped: limits of mapper.surfel.match are"),
                    Not(HasSubstr("mapper.scan"))));
  EXPECT_THAT(said("--set mapper.method=paper --set mapper.match.min_points=1000"),
              AllOf(HasSubstr("does not fit what was mapped: limits of mapper.match are"),
                    Not(HasSubstr("mapper.scan"))));
}

// They are said by their count, and match nothing.
TEST_F(ProgramView, FramesWithoutAnImageAreNotCountedAsUnmatched) {
  Succeed("render ./small.yaml --no-colour -o seq --set frames=40");
  std::vector<std::string> images;
  for (const std::string& file : FilesIn("seq/depth")) images.push_back("seq/depth/" + file);
  for (std::size_t i = 3; i < images.size(); i += 4) Write(images[i], "cut");
  const Outcome outcome = Program("map seq -o out");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("seq: 10 depth images missing or damaged"),
                                 Not(HasSubstr("could be matched"))));
}

// A pose that turns nothing looks straight up.
TEST_F(ProgramView, APathThatSeesNothingIsSaid) {
  Write("up.txt", "0 1.5 1.5 1.2 0 0 0 1\n0.1 1.5 1.6 1.2 0 0 0 1\n");
  const Outcome outcome =
      Program("run ./small.yaml -o out --set frames=0 --set trajectory=./up.txt");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("warning: no frame sees anything from 0.1 to 1.8 m above the floor"),
                    HasSubstr("; the path's poses must be those of the camera's axes, x right, y "
                              "down, z forward\n")));
}

}  // namespace
}  // namespace depthgrid
