// What goes into a sweep's database comes out of it, in a fixed order.
#include "eval/sweep/sweep_database.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "tests/io/temporary_folder.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class SweepDatabaseTest : public TemporaryFolderTest {};

SweepDatabase SmallPlan(const std::string& folder) {
  return SweepDatabase::Create(folder, {{"title", "test"}},
                               {"mapper.fusion.gain", "slam.profile", "seed"},
                               {{0, 0, {"0.1", "orb_slam2", "1"}},
                                {1, 0, {"0.1", "orb_slam2", "18446744073709551615"}},
                                {2, 1, {"[0.5, 1, 0]", "a,\"b\"", "3"}}});
}

TEST_F(SweepDatabaseTest, GivesBackWhatWasRecorded) {
  {
    SweepDatabase database = SmallPlan(folder_);
    EXPECT_TRUE(database.FinishedRuns().empty());
    database.Record({2, "", {{"b", 2.5}, {"a", kNan}}, {{"time_s", 1.0}}});
    database.Record({0, "no room", {}, {{"time_s", 2.0}}});
  }
  const SweepResults results = ReadSweep(folder_);
  EXPECT_EQ(results.environment.at("title"), "test");
  EXPECT_EQ(results.planned_runs, 3);
  EXPECT_EQ(results.runs, (std::vector<int>{0, 2}));
  EXPECT_EQ(results.points, (std::vector<int>{0, 1}));
  EXPECT_EQ(results.failures, (std::vector<std::string>{"no room", ""}));
  ASSERT_EQ(results.parameters.size(), 3U);
  EXPECT_EQ(results.Parameter("mapper.fusion.gain").texts,
            (std::vector<std::string>{"0.1", "[0.5, 1, 0]"}));
  EXPECT_EQ(results.Parameter("mapper.fusion.gain").numbers[0], 0.1);
  EXPECT_FALSE(results.Parameter("mapper.fusion.gain").IsNumeric());
  EXPECT_TRUE(results.Parameter("seed").IsNumeric());
  EXPECT_TRUE(results.Parameter("seed").IsSeed());
  EXPECT_FALSE(results.Parameter("slam.profile").IsSeed());
  ASSERT_EQ(results.metrics.size(), 2U);
  EXPECT_EQ(results.metrics[0].name, "a");  // sorted, whatever came first
  EXPECT_TRUE(std::isnan(results.Metric("b")[0]));
  EXPECT_EQ(results.Metric("b")[1], 2.5);
  EXPECT_EQ(ResultsCsv(results),
            "run,point,mapper.fusion.gain,slam.profile,seed,failed,a,b,time_s\n"
            "0,0,0.1,orb_slam2,1,1,,,2\n"
            "2,1,\"[0.5, 1, 0]\",\"a,\"\"b\"\"\",3,0,,2.5,1\n");
}

// Wherever the damage is, and whenever that page is read.
TEST_F(SweepDatabaseTest, DamageIsSaidToBeTheFilesOwn) {
  SmallPlan(folder_).Record({0, "", {{"a", 1.5}}, {{"time_s", 2.0}}});
  const std::string path = Path(kSweepDatabaseName);
  const std::string sound = ReadFile(path);
  constexpr std::size_t kPageBytes = 4096;
  int refused = 0;
  for (std::size_t page = kPageBytes; page < sound.size(); page += kPageBytes) {
    std::string damaged = sound;
    damaged[page] = 'U';
    WriteFile(path, damaged);
    const std::string refusal = RefusalOf([&] { ReadSweep(folder_); });
    if (refusal == "no error") continue;  // of an index that no question needs
    EXPECT_THAT(refusal, testing::HasSubstr("results.sqlite: cannot be read: "));
    ++refused;
  }
  EXPECT_GE(refused, 4);
}

TEST_F(SweepDatabaseTest, PlansFailedRunsAgain) {
  SweepDatabase database = SmallPlan(folder_);
  database.Record({0, "no room", {}, {{"time_s", 2.0}}});
  database.Record({1, "", {{"a", 1.0}}, {{"time_s", 3.0}}});
  EXPECT_EQ(database.PlanFailedAgain(), 1);
  EXPECT_EQ(database.UnfinishedRuns(), (std::vector<int>{0, 2}));
  database.Record({0, "", {{"a", 4.0}}, {{"time_s", 5.0}}});
  EXPECT_EQ(database.PlanFailedAgain(), 0);
  EXPECT_EQ(database.Results().failures, (std::vector<std::string>{"", ""}));
  EXPECT_EQ(database.Results().Metric("a"), (std::vector<double>{4.0, 1.0}));
}

TEST_F(SweepDatabaseTest, KeepsSeedsThatNoDoubleHolds) {
  SmallPlan(folder_).Record({1, "", {{"a", 1.0}}, {}});
  EXPECT_EQ(ReadSweep(folder_).Parameter("seed").texts[0], "18446744073709551615");
}

TEST_F(SweepDatabaseTest, NamesTheNearestMetricAndAxis) {
  SweepDatabase database = SmallPlan(folder_);
  database.Record({0, "", {{"map.chamfer_m", 1.0}}, {}});
  const auto message = [&](const auto& ask) -> std::string {
    try {
      ask(database.Results());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message([](const SweepResults& r) {
              r.Metric("map.chamfer");
            }).find("did you mean 'map.chamfer_m'?"),
            std::string::npos);
  EXPECT_NE(message([](const SweepResults& r) { r.Parameter("seeds"); }).find("'seed'"),
            std::string::npos);
}

TEST_F(SweepDatabaseTest, RefusesWhatIsNone) {
  EXPECT_THROW(ReadSweep(folder_), InputError);
  WriteFile(folder_ + "/" + kSweepDatabaseName, "not a database, but long enough to be one");
  EXPECT_THROW(ReadSweep(folder_), InputError);
}

TEST_F(SweepDatabaseTest, AnOutcomeIsWholeOrNotThere) {
  SweepDatabase database = SmallPlan(folder_);
  EXPECT_ANY_THROW(database.Record({{0, "", {{"a", 1.0}}, {}}, {7, "", {{"a", 1.0}}, {}}}));
  EXPECT_TRUE(database.FinishedRuns().empty());
  EXPECT_ANY_THROW(database.Record({{0, "", {{"a", 1.0}}, {}}, {0, "", {{"a", 1.0}}, {}}}));
  EXPECT_EQ(database.Results().rows(), 0U);
}

}  // namespace
}  // namespace depthgrid
