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
  nlohmann::json Scores(const std::string& arguments) const {
    return nlohmann::json::parse(Program("eval map " + arguments + " --json").out)["map"];
  }
};

TEST_F(EvalMap, SmallerCellsCountAsTheLargerOnesTheyMakeUp) {
  const nlohmann::json same = Scores("coarse.yaml coarse.yaml");
  EXPECT_EQ(same["all"]["confusion"]["truth_free"]["estimate_free"], 3);
  EXPECT_FALSE(same.contains("compared_cell_m"));
  int cases = 0;
  for (const char* maps : {"coarse.yaml fine.yaml", "fine.yaml coarse.yaml"}) {
    nlohmann::json scores = Scores(maps);
    EXPECT_EQ(scores["compared_cell_m"], 0.1) << maps;
    scores.erase("compared_cell_m");
    EXPECT_EQ(scores, same) << maps;
    EXPECT_THAT(Program(std::string("eval map ") + maps).out,
                HasSubstr("fine.yaml: 2 x 2 of its cells of 0.05 m count as one of 0.1 m, those of "
                          "coarse.yaml: occupied if any is, else free if any is\n"));
    ++cases;
  }
  EXPECT_EQ(cases, 2);
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
            "depthgrid: warning: nothing.yaml: has no free cell, which are those that could be "
            "seen\n");
}

TEST_F(EvalMap, CellsThatDoNotFitTogetherAreRefused) {
  ExpectRefusal("eval map fine.yaml other.yaml",
                {"other.yaml: resolution is 0.03, must be the 0.05 of fine.yaml, a whole multiple "
                 "or a whole part of it\n"});
}

}  // namespace
}  // namespace depthgrid
