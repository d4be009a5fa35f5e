// `depthgrid compare` of settings that change together: they are no axes to pair by.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "eval/compare/comparison.h"
#include "eval/sweep/sweep_database.h"
#include "mapper/core/error.h"
#include "tests/eval/program.h"

namespace depthgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kComparedError = "trajectory.est.mean_euclidean_m";
const std::vector<std::string> kSettingKeys = {"mapper.method", "mapper.fusion.mode",
                                               "mapper.fusion.gain", "seed"};

// Rows of the values of kSettingKeys; the error is the row's number in centimetres.
SweepResults SettingsTable(const std::vector<std::vector<std::string>>& rows) {
  SweepResults table;
  table.folder = "sweep";
  for (const std::string& key : kSettingKeys) table.parameters.push_back({key, {}, {}});
  table.metrics = {{kComparedError, {}}};
  for (std::size_t row = 0; row < rows.size(); ++row) {
    table.runs.push_back(static_cast<int>(row));
    table.points.push_back(0);
    table.failures.emplace_back();
    table.metrics[0].values.push_back(0.01 * static_cast<double>(row));
    for (std::size_t key = 0; key < kSettingKeys.size(); ++key) {
      table.parameters[key].texts.push_back(rows[row][key]);
    }
  }
  return table;
}

const std::vector<std::vector<std::string>> kSettingVariants = {
    {"paper", "fixed", "0.7", "1"},    {"paper", "fixed", "0.7", "2"},
    {"surfel", "learned", "0.5", "1"}, {"surfel", "learned", "0.5", "2"},
    {"surfel", "kalman", "0.5", "1"},  {"surfel", "kalman", "0.5", "2"},
};

TEST(CompareSettings, ThatChangeTogetherFollowTheConditions) {
  const SweepResults sweep = SettingsTable(kSettingVariants);
  CompareOptions options;
  options.where_a = {{"mapper.method", "paper"}};
  options.where_b = {{"mapper.fusion.mode", "learned"}};
  const Comparison c = Compare(sweep, sweep, options);
  EXPECT_THAT(c.paired_by, ElementsAre("seed"));
  EXPECT_EQ(c.pairs, 2);
  ASSERT_EQ(c.different.size(), 1U);
  EXPECT_EQ(c.different[0].key, "mapper.fusion.gain");
  EXPECT_EQ(c.different[0].a, "0.7");
  EXPECT_EQ(c.different[0].b, "0.5");
  EXPECT_NEAR(c.metrics[0].paired.mean_difference, 0.02, 1e-12);
}

// Several values of one side: which of them is meant is not known.
TEST(CompareSettings, OfSeveralValuesAreChosen) {
  const SweepResults sweep = SettingsTable(kSettingVariants);
  CompareOptions options;
  options.where_a = {{"mapper.method", "paper"}};
  options.where_b = {{"mapper.method", "surfel"}};
  try {
    Compare(sweep, sweep, options);
    FAIL() << "compared two settings with one";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("(by mapper.fusion.mode, seed): choose what differs on "
                                        "purpose with --where-a KEY=VALUE and --where-b"));
  }
}

// Other seeds are other errors of SLAM, not another setting.
TEST(CompareSettings, SeedsAlwaysMakeThePair) {
  const SweepResults one = SettingsTable({{"paper", "fixed", "0.7", "1"}});
  const SweepResults two = SettingsTable({{"paper", "fixed", "0.7", "2"}});
  EXPECT_THROW(Compare(one, two, {}), InputError);
}

class ProgramCompareSettings : public ProgramTest {};

TEST_F(ProgramCompareSettings, NamesThem) {
  for (const auto& [name, gain] : {std::pair{"low", "0.2"}, {"high", "0.8"}}) {
    std::filesystem::create_directory(Path(name));
    SweepDatabase database = SweepDatabase::Create(
        Path(name), {{"title", name}, {"experiment", "scene: living_room\n"}},
        {"mapper.fusion.gain", "seed"}, {{0, 0, {gain, "1"}}, {1, 0, {gain, "2"}}});
    for (const int run : {0, 1}) {
      database.Record({run, "", {{kComparedError, std::stod(gain) + 0.01 * run}}, {}});
    }
  }
  EXPECT_THAT(Program("compare low high").out,
              HasSubstr("2 pairs, paired by seed; mapper.fusion.gain is 0.2 in A, 0.8 in B\n"));
  const auto json = nlohmann::json::parse(Program("compare low high --json").out);
  EXPECT_THAT(json["different"]["mapper.fusion.gain"], ElementsAre("0.2", "0.8"));
}

}  // namespace
}  // namespace depthgrid
