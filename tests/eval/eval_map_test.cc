// `eval map` from its command line, on maps whose cells are of two sizes.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class EvalMap : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    // 0 is occupied, 254 free, 205 unknown; rows from the top down.
    WriteCells("coarse", 0.1, "P2 3 2 255\n0 254 205\n254 254 205\n");
    WriteCells("fine", 0.05,
               "P2 6 4 255\n"
               "0 254 205 254 205 205\n"
               "205 254 205 205 205 205\n"
               "254 205 205 254 205 205\n"
               "254 254 254 254 205 205\n");
    WriteCells("other", 0.03, "P2 1 1 255\n0\n");
  }
  void WriteCells(const std::string& name, double cell_m, const std::string& pgm) const {
    Write(name + ".pgm", pgm);
    Write(name + ".yaml", "image: " + name + ".pgm\nresolution: " + std::to_string(cell_m) +
                              "\norigin: [0.2, -0.2, 0]\nnegate: 0\noccupied_thresh: 0.65\n" +
                              "free_thresh: 0.196\n");
  }
  // A map of room.pgm, at an origin "x, y, yaw".
  void WriteAt(const std::string& name, const std::string& origin) const {
    Write(name, "image: room.pgm\nresolution: 0.05\norigin: [" + origin + "]\nnegate: 0\n" +
                    "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  }
  nlohmann::json Scores(const std::string& arguments) const {
    return nlohmann::json::parse(Program("eval map " + arguments + " --json").out)["map"];
  }
};

TEST_F(EvalMap, SmallerCellsCountAsTheLargerOnesTheyMakeUp) {
  const nlohmann::json same = Scores("coarse.yaml coarse.yaml");
  EXPECT_EQ(same["all"]["confusion"]["truth_free"]["estimate_free"], 3);
  EXPECT_FALSE(same.contains("compared_cell_m"));
  for (const char* maps : {"coarse.yaml fine.yaml", "fine.yaml coarse.yaml"}) {
    nlohmann::json scores = Scores(maps);
    EXPECT_EQ(scores["compared_cell_m"], 0.1) << maps;
    scores.erase("compared_cell_m");
    EXPECT_EQ(scores, same) << maps;
    EXPECT_THAT(Program(std::string("eval map ") + maps).out,
                HasSubstr("fine.yaml: 2 x 2 of its cells of 0.05 m count as one of 0.1 m, as "
                          "coarse.yaml has them: occupied if any is, else free if any is\n"));
  }
  EXPECT_THAT(Program("eval map fine.yaml fine.yaml").out, Not(HasSubstr("count as one")));
}

TEST_F(EvalMap, WhatCouldBeSeenIsReducedAsWell) {
  EXPECT_EQ(Scores("coarse.yaml fine.yaml --observable fine.yaml")["observable"]["scored_cells"],
            4);
  EXPECT_EQ(Scores("fine.yaml coarse.yaml --observable coarse.yaml")["observable"]["scored_cells"],
            3);
  ExpectRefusal("eval map fine.yaml fine.yaml --observable coarse.yaml",
                {"coarse.yaml: resolution is 0.1, must be the 0.05 of fine.yaml or a whole part"});
}

// A wall of 20 cells in the first of seven columns, and in one of the others.
TEST_F(EvalMap, WallsThatLieElsewhereAreSaid) {
  const auto write_wall = [&](const std::string& name, int column) {
    std::string pgm = "P2 7 20 255\n";
    for (int row = 0; row < 20; ++row) {
      for (int i = 0; i < 7; ++i) pgm += i == column ? "0 " : "254 ";
      pgm += "\n";
    }
    WriteCells(name, 0.05, pgm);
  };
  write_wall("truth", 0);
  write_wall("near", 2);
  write_wall("far", 3);
  EXPECT_EQ(Program("eval map truth.yaml near.yaml").err, "");
  EXPECT_EQ(Program("eval map truth.yaml far.yaml").err,
            "depthgrid: warning: far.yaml: 0 % of its walls lie within 2 cells of walls of "
            "truth.yaml: in another frame (a map lies in that of its poses), of another place, or "
            "wrong\n");
}

TEST_F(EvalMap, ThatNothingCouldBeSeenIsSaid) {
  WriteCells("nothing", 0.1, "P2 3 2 255\n205 205 205\n205 205 205\n");
  EXPECT_EQ(Program("eval map coarse.yaml coarse.yaml --observable nothing.yaml").err,
            "depthgrid: warning: nothing.yaml: has no free cell; free cells are those that could "
            "be seen\n");
}

TEST_F(EvalMap, AMapWithoutWallsIsSaid) {
  WriteCells("bare", 0.1, "P2 3 2 255\n254 254 254\n254 254 254\n");
  const std::string said =
      "bare.yaml: has no occupied cell: scores of walls need some in both maps\n";
  EXPECT_EQ(Program("eval map coarse.yaml bare.yaml").err, "depthgrid: warning: " + said);
  EXPECT_THAT(Program("eval map bare.yaml coarse.yaml").err, HasSubstr(said));
}

// A room's walls in cells of 0.05 m, 60 x 20, with a wall across.
std::string RoomPgm() {
  std::string pgm = "P2 60 20 255\n";
  for (int row = 0; row < 20; ++row) {
    for (int x = 0; x < 60; ++x) {
      const bool wall = row == 0 || row == 19 || x == 0 || x == 59 || (x == 20 && row < 12);
      pgm += wall ? "0 " : "254 ";
    }
    pgm += "\n";
  }
  return pgm;
}

// Of one image at two origins: all that differs is where it lies.
TEST_F(EvalMap, AShiftIsFoundHoweverTheCellsLie) {
  Write("room.pgm", RoomPgm());
  for (const char* yaw : {"0", "0.4"}) {
    WriteAt("truth.yaml", std::string("0.0249, -3.2, ") + yaw);
    for (const auto& [x_m, y_m] :
         {std::pair(0.0, 0.0), std::pair(0.0002, 0.0), std::pair(0.025, 0.0), std::pair(0.05, 0.0),
          std::pair(0.074, -0.1), std::pair(-0.12, 0.13)}) {
      WriteAt("est.yaml",
              std::to_string(0.0249 + x_m) + ", " + std::to_string(-3.2 + y_m) + ", " + yaw);
      const nlohmann::json scores = Scores("truth.yaml est.yaml");
      EXPECT_NEAR(scores["registered"]["x_m"], -x_m, 1e-6) << x_m << yaw;
      EXPECT_NEAR(scores["registered"]["y_m"], -y_m, 1e-6) << y_m << yaw;
      EXPECT_NEAR(scores["registered"]["chamfer_m"], 0.0, 1e-6) << x_m << yaw;
      EXPECT_NEAR(scores["registered"]["yaw_rad"], 0.0, 0.001);
      if (std::abs(x_m) < 0.001) {
        EXPECT_EQ(scores["all"]["occupied"]["tolerance_0"]["f1"], 1.0) << x_m << yaw;
      }
    }
  }
  EXPECT_THAT(Program("eval map truth.yaml est.yaml").out,
              HasSubstr("est.yaml: its cells lie off those of truth.yaml (by x"));
  EXPECT_THAT(Program("eval map truth.yaml truth.yaml").out, Not(HasSubstr("lie off")));
}

TEST_F(EvalMap, AMapThatIsTurnedIsSaid) {
  Write("room.pgm", RoomPgm());
  WriteAt("truth.yaml", "0, 0, 0");
  WriteAt("turned.yaml", "2, -1, 1.5707963267948966");
  EXPECT_THAT(Program("eval map truth.yaml turned.yaml").err,
              HasSubstr("turned.yaml: turned by -90 degrees, it would lie over truth.yaml"));
}

// A room of 10 x 10 cells with walls around.
TEST_F(EvalMap, LikelyMistakesInAMapsYamlAreAskedAbout) {
  std::string pgm = "P2 14 14 255\n";
  for (int i = 0; i < 14 * 14; ++i) {
    const auto lies_in = [&](int margin) {
      const int u = i % 14, v = i / 14;
      return std::min(u, v) >= margin && std::max(u, v) < 14 - margin;
    };
    pgm += lies_in(2) ? "254 " : lies_in(1) ? "0 " : "205 ";
  }
  Write("room.pgm", pgm);
  const auto map = [&](const std::string& name, const char* resolution, const char* yaw,
                       const char* negate) {
    Write(name + ".yaml", std::string("image: room.pgm\nresolution: ") + resolution +
                              "\norigin: [1, 2, " + yaw + "]\nnegate: " + negate +
                              "\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  };
  map("right", "0.05", "0", "0");
  map("turned", "0.05", "1.57", "0");
  map("cm", "5", "0", "0");
  map("mm", "50", "0", "0");
  map("deg", "0.05", "90", "0");
  map("negated", "0.05", "0", "1");
  EXPECT_EQ(Program("eval map right.yaml right.yaml").err, "");
  EXPECT_EQ(Program("eval map turned.yaml turned.yaml").err, "");
  EXPECT_EQ(Program("eval map negated.yaml negated.yaml").err, "");
  EXPECT_THAT(Program("eval map cm.yaml cm.yaml").err,
              HasSubstr("warning: cm.yaml: resolution is 5, cells of so many metres: is it in "
                        "millimetres (0.005) or centimetres (0.05)?\n"));
  EXPECT_THAT(Program("eval map mm.yaml right.yaml").err, HasSubstr("millimetres (0.05)"));
  EXPECT_THAT(Program("eval map right.yaml deg.yaml").err,
              HasSubstr("warning: deg.yaml: origin has a yaw of 90 rad, more than a turn: is it in "
                        "degrees (1.571 rad)?\n"));
  EXPECT_THAT(Program("eval map right.yaml negated.yaml").err,
              HasSubstr("warning: negated.yaml: of the cells known to both maps 100 % are free in "
                        "one and occupied in the other: is negate, 1 here and 0 in right.yaml, "
                        "right in both?\n"));
  EXPECT_THAT(Program("eval map negated.yaml right.yaml").err,
              HasSubstr("negate, 0 here and 1 in negated.yaml"));
}

TEST_F(EvalMap, CellsThatDoNotFitTogetherAreRefused) {
  ExpectRefusal("eval map fine.yaml other.yaml",
                {"other.yaml: resolution is 0.03, must be the 0.05 of fine.yaml, a whole multiple "
                 "or a whole part of it\n"});
}

// A map of states alone is certain of each, which nobody meant by it.
TEST_F(EvalMap, OnlyProbabilitiesAreCalibrated) {
  EXPECT_EQ(Scores("coarse.yaml coarse.yaml")["calibration"], nullptr);
  EXPECT_THAT(Program("eval map coarse.yaml coarse.yaml").out, Not(HasSubstr("Brier")));
  Write("unsure.pgm", "P2 3 2 255\n51 204 205\n204 254 205\n");
  Write("unsure.yaml",
        "image: unsure.pgm\nresolution: 0.1\norigin: [0.2, -0.2, 0]\nnegate: 0\nmode: scale\n"
        "occupied_thresh: 1\nfree_thresh: 0\n");
  // 0.8 of a wall and twice 0.2 of a free cell; the last one's 1 / 255 is hardly anything.
  const nlohmann::json calibration = Scores("coarse.yaml unsure.yaml")["calibration"];
  EXPECT_EQ(calibration["cells"], 4);
  EXPECT_NEAR(calibration["brier"].get<double>(), 3 * 0.04 / 4, 1e-4);
  EXPECT_THAT(Program("eval map coarse.yaml unsure.yaml").out,
              testing::ContainsRegex("Brier score +0\\.0300"));
}

}  // namespace
}  // namespace depthgrid
