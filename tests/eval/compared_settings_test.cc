// `depthgrid compare` of settings that change together: they are no axes to pair by.
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

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

// Sweeps of two seeds, with these settings fixed.
class ProgramCompareSettings : public ProgramTest {
 protected:
  void WriteSweep(const std::string& name, const std::string& experiment,
                  std::map<std::string, std::string> environment = {},
                  const std::string& axis = "mapper.fusion.gain",
                  const std::vector<std::string>& values = {"0.2"}) const {
    std::filesystem::create_directory(Path(name));
    environment["title"] = name;
    environment["experiment"] = experiment;
    std::vector<PlannedRun> rows;
    for (const std::string& value : values) {
      for (const char* seed : {"1", "2"}) {
        rows.push_back({static_cast<int>(rows.size()), 0, {value, seed}});
      }
    }
    SweepDatabase database = SweepDatabase::Create(Path(name), environment, {axis, "seed"}, rows);
    for (const PlannedRun& row : rows) {
      database.Record({row.run, "", {{kComparedError, 0.1 + 0.01 * row.run}}, {}});
    }
  }
  nlohmann::json Different(const std::string& arguments) const {
    return nlohmann::json::parse(Program("compare " + arguments + " --json").out)["different"];
  }
};

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

// A comparison of 60 frames with 200 tells nothing, whatever its p.
TEST_F(ProgramCompareSettings, RefusesWhatSawSomethingElse) {
  WriteSweep("a", "scene: /x/room.yaml\nframes: 60\nmovers: none\nseed: 1\n");
  WriteSweep("frames", "scene: /x/room.yaml\nframes: 200\nmovers: none\nseed: 1\n");
  WriteSweep("movers", "scene: /x/room.yaml\nframes: 60\nmovers: walker\nseed: 1\n");
  WriteSweep("scene", "scene: /x/other.yaml\nframes: 60\nmovers: none\nseed: 1\n");
  ExpectRefusal("compare a frames", {"frames: frames is '200', in a '60'",
                                     "--where-a frames='60' --where-b frames='200'"});
  ExpectRefusal("compare a movers", {"movers is 'walker', in a 'none'"});
  ExpectRefusal("compare a scene", {"scene is '/x/other.yaml', in a '/x/room.yaml'"});
  const std::string on_purpose = "compare a frames --where-a frames=60 --where-b frames=200";
  EXPECT_THAT(Program(on_purpose).out, HasSubstr("2 pairs, paired by mapper.fusion.gain, seed\n"));
}

TEST_F(ProgramCompareSettings, KnowsRoomsByTheirContent) {
  const std::string unnamed = "scene: /x/room.yaml\ntrajectory: ''\n";
  const std::string named = "scene: /y/room.yaml\ntrajectory: walk\n";
  WriteSweep("a", unnamed, {{"rooms", "room.yaml: 12ab\n"}});
  WriteSweep("same", named, {{"rooms", "room.yaml, walk: 12ab\n"}});
  WriteSweep("changed", unnamed, {{"rooms", "room.yaml: 34cd\n"}});
  EXPECT_EQ(Program("compare a same").exit_code, 0);
  ExpectRefusal("compare a changed", {"movers of 'room.yaml' have other contents than those of a"});
}

// What one side fixes is a value on the axis of the other.
TEST_F(ProgramCompareSettings, PairsAFixedValueWithAnAxis) {
  WriteSweep("axis", "scene: room\nmapper: {method: surfel}\n", {}, "frames", {"60", "200"});
  WriteSweep("fixed", "scene: room\nframes: 60\nmapper: {method: surfel}\n");
  for (const char* sides : {"axis fixed", "fixed axis"}) {
    const Outcome outcome = Program(std::string("compare ") + sides);
    EXPECT_THAT(outcome.out, HasSubstr("2 pairs, paired by ")) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("left out for want of a partner: "));
  }
}

TEST_F(ProgramCompareSettings, NamesTheFixedOnes) {
  const std::string head = "scene: room\nframes: 60\n";
  WriteSweep("a", head + "slam: {profile: orb_slam2, pivot_m: 1}\nmapper: {method: surfel}\n");
  WriteSweep("b", head + "slam: {profile: planar_slam, pivot_m: 2}\nmapper: {method: paper}\n");
  WriteSweep("c", head + "slam: {profile: orb_slam2, pivot_m: 2}\nmapper: {method: surfel}\n");
  EXPECT_THAT(Program("compare a b").out,
              HasSubstr("2 pairs, paired by mapper.fusion.gain, seed; slam.profile is orb_slam2 in "
                        "A, planar_slam in B; mapper.method is surfel in A, paper in B\n"));
  const nlohmann::json different = Different("a b");
  EXPECT_EQ(different.size(), 2U);  // the pivot follows from the profile
  EXPECT_THAT(different["mapper.method"], ElementsAre("surfel", "paper"));
  EXPECT_THAT(Different("a c")["slam.pivot_m"], ElementsAre("1", "2"));
  // A condition chooses from an axis what the other side fixes.
  WriteSweep("d", head + "mapper: {fusion: {gain: 0.7}}\n", {}, "movers", {"none"});
  EXPECT_THAT(Different("a d --where-a mapper.fusion.gain=0.2")["mapper.fusion.gain"],
              ElementsAre("0.2", "0.7"));
}

TEST_F(ProgramCompareSettings, NamesThoseOfFoldersOfRuns) {
  for (const auto& [name, method, movers] :
       {std::tuple("a", "surfel", "none"), {"b", "paper", "none"}, {"c", "surfel", "walker"}}) {
    for (const int seed : {1, 2}) {
      const std::string run = std::string(name) + "/" + std::to_string(seed);
      std::filesystem::create_directories(Path(run));
      Write(run + "/run.yaml", "scene: room\nmovers: " + std::string(movers) + "\nseed: " +
                                   std::to_string(seed) + "\nmapper: {method: " + method + "}\n");
      Write(run + "/metrics.json", R"({"trajectory": {"est": {"mean_euclidean_m": 0.1}}})");
    }
  }
  EXPECT_THAT(Different("a b")["mapper.method"], ElementsAre("surfel", "paper"));
  ExpectRefusal("compare a c", {"shares no run with a (by scene, movers, seed)"});
}

}  // namespace
}  // namespace depthgrid
