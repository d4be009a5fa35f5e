// `eval trajectory` from its command line, on trajectories whose errors are known by hand.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// 12 s along x at 1 m/s; the estimate goes 2 % too far and, from 6 s on, 0.3 m to the side.
class EvalTrajectory : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::string truth;
    std::string estimate;
    for (int i = 0; i <= 12; ++i) {
      truth += fmt::format("{} {} 0 0 0 0 0 1\n", i, i);
      estimate += fmt::format("{} {} {} 0 0 0 0 1\n", i, 1.02 * i, i >= 6 ? 0.3 : 0.0);
    }
    Write("truth.txt", truth);
    Write("estimate.txt", estimate);
  }
};

TEST_F(EvalTrajectory, JsonHasDriftAMetreAndASecond) {
  const auto json =
      nlohmann::json::parse(Program("eval trajectory truth.txt estimate.txt --json").out);
  const auto& est = json["trajectory"]["est"];
  // 11 of 12 motions of a metre err by 0.02, the one to the side by sqrt(0.02^2 + 0.3^2).
  const double metre = (11 * 0.02 + std::hypot(0.02, 0.3)) / 12.0;
  EXPECT_NEAR(est["drift_m_per_m"].get<double>(), metre, 1e-9);
  // All three motions of 10 s contain the step.
  EXPECT_NEAR(est["drift_m_per_s"].get<double>(), std::hypot(0.2, 0.3) / 10.0, 1e-9);
  EXPECT_EQ(est["drift"]["over_time"].back()["s"], 10.0);
  EXPECT_EQ(est["drift"]["over_path"].size(), 4U);
}

TEST_F(EvalTrajectory, WritesTheErrorsOverTime) {
  Succeed("eval trajectory truth.txt estimate.txt --errors errors.csv");
  const std::string csv = ReadFile(Path("errors.csv"));
  EXPECT_THAT(csv,
              StartsWith("stamp_s,error_xy_m,error_xyz_m,error_rotation_rad,error_heading_rad\n"
                         "0.000000,0,0,0,0\n"));
  EXPECT_THAT(csv, HasSubstr("\n5.000000,0.09999999999999964,0.09999999999999964,0,0\n"));
}

TEST_F(EvalTrajectory, AFileOfErrorsIsCheckedBeforeTheWork) {
  Write("errors.csv", "mine");
  const auto refusal = [&](const std::string& file) {
    const Outcome outcome = Program("eval trajectory truth.txt estimate.txt --errors " + file);
    EXPECT_EQ(outcome.exit_code, 2) << file;
    EXPECT_EQ(outcome.out, "") << file;
    return outcome.err;
  };
  EXPECT_EQ(refusal("errors.csv"),
            "depthgrid: errors.csv: is there already; choose another name, or --force to replace "
            "it\n");
  EXPECT_EQ(ReadFile(Path("errors.csv")), "mine");
  EXPECT_THAT(refusal("nowhere/x.csv"), HasSubstr("nowhere/x.csv: its folder does not exist"));
  EXPECT_THAT(refusal("."), HasSubstr(".: is a folder"));
  Succeed("eval trajectory truth.txt estimate.txt --errors errors.csv --force");
  EXPECT_THAT(ReadFile(Path("errors.csv")), StartsWith("stamp_s,"));
}

TEST_F(EvalTrajectory, SaysWhenItsErrorsAreOfFewPosesOrInOtherUnits) {
  EXPECT_EQ(Program("eval trajectory truth.txt estimate.txt").err, "");
  Write("one.txt", "3 3 0 0 0 0 0 1\n500 3 0 0 0 0 0 1\n501 3 0 0 0 0 0 1\n");
  const Outcome one = Program("eval trajectory truth.txt one.txt");
  EXPECT_EQ(one.exit_code, 0);
  EXPECT_THAT(
      one.err,
      HasSubstr("one.txt: only 1 of its 3 poses has a stamp in common with truth.txt's 13"));
  std::string nanoseconds;
  for (int i = 0; i <= 12; ++i) nanoseconds += fmt::format("{}000000000 {} 0 0 0 0 0 1\n", i, i);
  Write("ns.txt", nanoseconds);
  EXPECT_THAT(Program("eval trajectory truth.txt ns.txt").err,
              HasSubstr("ns.txt: only 1 of its 13 poses has a stamp in common with truth.txt's 13; "
                        "the errors are of those alone; it spans 1.2e+10 s and the other 12 s: are "
                        "both in seconds?\n"));
  EXPECT_THAT(one.err, testing::Not(HasSubstr("are both in seconds?")));
  std::string metres;
  std::string millimetres;
  for (int i = 0; i <= 12; ++i) {
    metres += fmt::format("{} {} {} 0 0 0 0 1\n", i, i, i % 3);
    millimetres += fmt::format("{} {} {} 0 0 0 0 1\n", i, 1000 * i, 1000 * (i % 3));
  }
  Write("m.txt", metres);
  Write("mm.txt", millimetres);
  EXPECT_EQ(Program("eval trajectory m.txt m.txt").err, "");
  EXPECT_THAT(Program("eval trajectory m.txt mm.txt").err,
              HasSubstr("mm.txt: fits m.txt best if made 0.001 times as large"));
  Write("single.txt", "3 3 0 0 0 0 0 1\n");
  EXPECT_THAT(Program("eval trajectory truth.txt single.txt").err,
              HasSubstr("single.txt: one pose is matched, aligned and relative errors need more"));
}

// The axes of a camera that looks along the truth's x: z forward, y down.
TEST_F(EvalTrajectory, SaysThatOneWorldIsTilted) {
  std::string level;
  std::string tilted;
  for (int i = 0; i <= 12; ++i) {
    const auto [x, y, z] = std::tuple(i, i * i % 5, 0.1 * (i % 2));
    level += fmt::format("{} {} {} {} 0 0 0 1\n", i, x, y, z);
    tilted += fmt::format("{} {} {} {} 0 0 0 1\n", i, -y, -z, x);
  }
  Write("level.txt", level);
  Write("tilted.txt", tilted);
  const Outcome outcome = Program("eval trajectory level.txt tilted.txt");
  EXPECT_THAT(outcome.err, HasSubstr("tilted.txt: fits level.txt to 0.000 m in space"));
  EXPECT_THAT(outcome.err, HasSubstr("their worlds are tilted against each other"));
  EXPECT_EQ(Program("eval trajectory level.txt level.txt").err, "");
}

// A mirrored level path is the true one upside down, which no level world is tilted to.
TEST_F(EvalTrajectory, SaysThatALevelPathIsMirrored) {
  std::string level;
  std::string mirrored;
  for (int i = 0; i <= 12; ++i) {
    level += fmt::format("{} {} {} 1 0 0 0 1\n", i, i, i * i % 5);
    mirrored += fmt::format("{} {} {} 1 0 0 0 1\n", i, i, -(i * i % 5));
  }
  Write("level.txt", level);
  Write("mirrored.txt", mirrored);
  const Outcome outcome = Program("eval trajectory level.txt mirrored.txt");
  EXPECT_THAT(outcome.err, HasSubstr("it is upside down or mirrored"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("tilted")));
}

// evo takes the nearest stamp within 0.01 s, TUM's scripts within 0.02 s.
TEST_F(EvalTrajectory, ConventionsDifferInTheStampsTheyMatch) {
  std::string late;
  for (int i = 0; i <= 12; ++i) late += fmt::format("{} {} 0 0 0 0 0 1\n", i + 0.015, i);
  Write("late.txt", late);
  const Outcome evo = Program("eval trajectory truth.txt late.txt");
  EXPECT_EQ(evo.exit_code, 2);
  EXPECT_THAT(evo.err, HasSubstr("shares no stamp"));
  EXPECT_THAT(Program("eval trajectory truth.txt late.txt --convention tum").out,
              HasSubstr("13 of 13 reference and 13 estimated poses matched"));
  // Of those that have no partner both count as well.
  Write("more.txt", late + "13.015 13 0 0 0 0 0 1\n");
  Write("fewer.txt", "3 3 0 0 0 0 0 1\n4 4 0 0 0 0 0 1\n5 5 0 0 0 0 0 1\n");
  EXPECT_THAT(Program("eval trajectory truth.txt more.txt --convention tum").out,
              HasSubstr("13 of 13 reference and 14 estimated poses matched"));
  EXPECT_THAT(Program("eval trajectory truth.txt fewer.txt --convention tum").out,
              HasSubstr("3 of 13 reference and 3 estimated poses matched"));
}

// What is said to bring both together is all that is to be given, with what was given already.
TEST_F(EvalTrajectory, TheOffsetThatIsAdvisedIsAllOfIt) {
  std::string late;
  for (int i = 0; i <= 12; ++i) late += fmt::format("{} {} 0 0 0 0 0 1\n", i + 1000, i);
  Write("late.txt", late);
  const Outcome outcome = Program("eval trajectory truth.txt late.txt --time-offset -400");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--time-offset -1000.000 makes the first of both coincide"));
  Succeed("eval trajectory truth.txt late.txt --time-offset -1000");
}

TEST_F(EvalTrajectory, StampsOfOtherUnitsAreNoOffset) {
  std::string milliseconds;
  for (int i = 0; i <= 12; ++i) {
    milliseconds += fmt::format("{} {} 0 0 0 0 0 1\n", 1000 * i + 500000, i);
  }
  Write("ms.txt", milliseconds);
  const Outcome outcome = Program("eval trajectory truth.txt ms.txt");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("; are both in seconds?\n"));
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("--time-offset")));
}

// Row by row, as a run's own trajectory_est_kitti.txt is of its trajectory_est.txt.
TEST_F(EvalTrajectory, MatricesPairRowByRow) {
  std::string truth;
  std::string estimate;
  for (int i = 0; i <= 12; ++i) {
    truth += fmt::format("1 0 0 {} 0 1 0 0 0 0 1 0\n", i);
    estimate += fmt::format("1 0 0 {} 0 1 0 {} 0 0 1 0\n", 1.02 * i, i >= 6 ? 0.3 : 0.0);
  }
  Write("truth_kitti.txt", truth);
  Write("estimate_kitti.txt", estimate);
  using Json = nlohmann::json;
  const auto scores = [&](const std::string& files) {
    return Json::parse(Program("eval trajectory " + files + " --json").out)["trajectory"]["est"];
  };
  const Json stamped = scores("truth.txt estimate.txt");
  int cases = 0;
  for (const char* files : {"truth_kitti.txt estimate.txt", "truth.txt estimate_kitti.txt",
                            "truth_kitti.txt estimate_kitti.txt"}) {
    SCOPED_TRACE(files);
    Json est = scores(files);
    EXPECT_EQ(est["paired_by"], "row");
    est.erase("paired_by");
    if (++cases == 3) {  // a row is no second
      EXPECT_EQ(est["drift_m_per_s"], nullptr);
      EXPECT_TRUE(est["drift"]["over_time"].empty());
      for (const char* key : {"drift_m_per_s", "drift"}) est[key] = stamped[key];
    }
    EXPECT_EQ(est, stamped);
    EXPECT_THAT(Program(std::string("eval trajectory ") + files).out,
                HasSubstr("13 of 13 reference and 13 estimated poses matched, row by row"));
  }
  Succeed("eval trajectory truth_kitti.txt estimate_kitti.txt --errors errors.csv");
  EXPECT_THAT(ReadFile(Path("errors.csv")),
              StartsWith("row,error_xy_m,error_xyz_m,error_rotation_rad,error_heading_rad\n"
                         "0,0,0,0,0\n1,0.02"));
}

TEST_F(EvalTrajectory, MatricesThatDoNotPairAreRefused) {
  const std::string row = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  Write("three.txt", row + row + row);
  Write("gap.txt", row + "nan nan nan nan nan nan nan nan nan nan nan nan\n" + row);
  ExpectRefusal("eval trajectory truth.txt three.txt",
                {"three.txt: holds 3 poses, must hold the 13 of truth.txt: it has no stamps"});
  ExpectRefusal("eval trajectory three.txt truth.txt",
                {"truth.txt: holds 13 poses, must hold the 3 of three.txt: that one has no"});
  Write("mended.txt", "1 0 0 0 0 0 0 1\n3 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
  ExpectRefusal("eval trajectory mended.txt three.txt",
                {"mended.txt: 1 row is no pose or not later than the row before"});
  const Outcome gap = Program("eval trajectory three.txt gap.txt --max-difference 0.1");
  EXPECT_THAT(
      gap.err,
      HasSubstr("gap.txt: 1 pose with NaN, a zero rotation or beyond 10,000 km ignored (first: "));
  EXPECT_THAT(gap.err, HasSubstr("gap.txt:2: the matrix must be finite)"));
  EXPECT_THAT(gap.err, HasSubstr("--max-difference: has no effect because rows pair in order"));
  EXPECT_THAT(gap.out, HasSubstr("2 of 3 reference and 2 estimated poses matched"));
}

}  // namespace
}  // namespace depthgrid
