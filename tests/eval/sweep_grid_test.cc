#include "eval/compare/sweep_grid.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "eval/statistics/metric_direction.h"

namespace depthgrid {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Gains 0, 0.5, 1 (in another order) x two profiles x three seeds; one run failed.
SweepResults Table() {
  SweepResults results;
  SweepParameter gain{"mapper.fusion.gain", {}, {}};
  SweepParameter profile{"slam.profile", {}, {}};
  SweepParameter seed{"seed", {}, {}};
  SweepColumn error{"trajectory.est.mean_euclidean_m", {}};
  int point = 0;
  for (const double g : {1.0, 0.0, 0.5}) {
    for (const char* name : {"wild", "calm"}) {
      for (int s = 1; s <= 3; ++s) {
        results.runs.push_back(static_cast<int>(results.runs.size()));
        results.points.push_back(point);
        gain.texts.push_back(g == 0.5 ? "0.5" : g == 1.0 ? "1" : "0");
        gain.numbers.push_back(g);
        profile.texts.emplace_back(name);
        profile.numbers.push_back(kNone);
        seed.texts.push_back(std::to_string(s));
        seed.numbers.push_back(s);
        // Wild: 0.5 is best but for seed 3, where 1 is. Calm: 0 is always best.
        const bool wild = profile.texts.back() == "wild";
        double value = wild ? std::abs(g - 0.5) + 0.1 * s : g;
        if (wild && s == 3 && g == 1.0) value = 0.2;
        const bool failed = !wild && s == 2 && g == 1.0;
        error.values.push_back(failed ? kNone : value);
        results.failures.emplace_back(failed ? "lost" : "");
      }
      ++point;
    }
  }
  results.parameters = {gain, profile, seed};
  results.metrics = {error};
  return results;
}

struct Seeds {
  int slam = 0;
  int depth = 0;
};

// Gains 0 and 1 with four pairs of seeds each; runs err by their numbers.
SweepResults TwoGains(const std::function<Seeds(int run_of_gain)>& seeds_of) {
  SweepResults table;
  table.parameters = {
      {"mapper.fusion.gain", {}, {}}, {"slam_seed", {}, {}}, {"depth_seed", {}, {}}};
  table.metrics = {{"trajectory.est.mean_euclidean_m", {}}};
  for (int run = 0; run < 8; ++run) {
    table.runs.push_back(run);
    table.points.push_back(run / 4);
    table.failures.emplace_back();
    table.metrics[0].values.push_back(run);
    const Seeds seeds = seeds_of(run % 4);
    const std::array<int, 3> values = {run / 4, seeds.slam, seeds.depth};
    for (std::size_t i = 0; i < values.size(); ++i) {
      table.parameters[i].texts.push_back(std::to_string(values[i]));
      table.parameters[i].numbers.push_back(values[i]);
    }
  }
  return table;
}

// Nothing is random at gain 0: all seeds give the same. Seed 3 gives what seed 1 gives everywhere.
SweepResults TableOfRepeats() {
  SweepResults results;
  SweepParameter gain{"mapper.fusion.gain", {}, {}};
  SweepParameter seed{"seed", {}, {}};
  SweepColumn error{"trajectory.est.mean_euclidean_m", {}};
  SweepColumn f1{"map.observable.occupied.f1", {}};
  for (const int g : {0, 1}) {
    for (const int s : {1, 2, 3}) {
      results.runs.push_back(static_cast<int>(results.runs.size()));
      results.points.push_back(g);
      results.failures.emplace_back();
      gain.texts.push_back(std::to_string(g));
      gain.numbers.push_back(g);
      seed.texts.push_back(std::to_string(s));
      seed.numbers.push_back(s);
      error.values.push_back(g == 0 ? 0.5 : s == 2 ? 0.7 : 0.1);
      f1.values.push_back(kNone);  // the same of all: not defined
    }
  }
  results.parameters = {gain, seed};
  results.metrics = {error, f1};
  return results;
}

TEST(SweepGrid, ASeedThatRepeatsAnotherCountsOnce) {
  const SweepResults results = TableOfRepeats();
  const SweepGrid grid = GridOf(results);
  EXPECT_EQ(grid.measurement_of_row, (std::vector<std::size_t>{0, 0, 0, 3, 4, 3}));
  const auto lines = LinesAlong(grid, 0, results.metrics[0].values, Better::kLower, {});
  ASSERT_EQ(lines.size(), 1U);
  // 0.5 against the mean of 0.1 and 0.7; of three seeds it would be 0.3.
  EXPECT_EQ(lines[0].seeds, 2U);
  ASSERT_TRUE(lines[0].best);
  EXPECT_EQ(lines[0].best->setting, 1.0);
  EXPECT_NEAR(lines[0].mean_regret_of_seed[0], 0.2, 1e-12);
  EXPECT_NEAR(lines[0].mean_regret_of_seed[1], 0.1, 1e-12);
}

TEST(SweepGrid, OrdersNumbersAndKeepsTexts) {
  const SweepGrid grid = GridOf(Table());
  ASSERT_EQ(grid.axes.size(), 2U);
  EXPECT_EQ(grid.axes[0].texts, (std::vector<std::string>{"0", "0.5", "1"}));
  EXPECT_EQ(grid.axes[0].numbers, (std::vector<double>{0.0, 0.5, 1.0}));
  EXPECT_FALSE(grid.axes[1].numeric);
  EXPECT_EQ(grid.axes[1].texts, (std::vector<std::string>{"wild", "calm"}));
  ASSERT_EQ(grid.points.size(), 6U);
  EXPECT_EQ(grid.points[1].values, (std::vector<std::size_t>{2, 1}));  // gain 1, calm
  EXPECT_EQ(grid.points[1].rows, (std::vector<std::size_t>{3, 5}));    // 4 failed
  EXPECT_EQ(grid.seeds_of_row[5], "3");
}

TEST(SweepGrid, HasNoBestWhereNeitherMoreNorLessIsBetter) {
  const SweepResults results = TableOfRepeats();
  const auto lines =
      LinesAlong(GridOf(results), 0, results.metrics[0].values, Better::kNeither, {});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].points.size(), 2U);
  EXPECT_FALSE(lines[0].best);
}

// Two seeds of the one with two of the other are no four.
TEST(SweepGrid, CrossedSeedsCountAsManyAsOneOfThemHas) {
  const SweepResults table = TwoGains([](int run) -> Seeds { return {run / 2, run % 2}; });
  const SweepGrid grid = GridOf(table);
  EXPECT_EQ(grid.seed_axes, 2U);
  const auto lines = LinesAlong(grid, 0, table.metrics[0].values, Better::kLower, {});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].seeds, 2U);
  EXPECT_EQ(lines[0].best->setting, 0.0);
  EXPECT_NEAR(lines[0].best->regret_mean[1], 4.0, 1e-12);
  EXPECT_NEAR(lines[0].best->p_as_good[1], 0.5, 1e-12);  // 2 / 2^2
}

TEST(SweepGrid, FindsTheBestOfEachLineOverSharedSeeds) {
  const SweepResults table = Table();
  const SweepGrid grid = GridOf(table);
  const auto lines = LinesAlong(grid, 0, table.metrics[0].values, Better::kLower, {});
  ASSERT_EQ(lines.size(), 2U);
  const GridLine& wild = lines[0];
  EXPECT_EQ(wild.points, (std::vector<std::size_t>{2, 4, 0}));  // gain 0, 0.5, 1
  ASSERT_TRUE(wild.best);
  EXPECT_EQ(wild.best->setting, 0.5);
  EXPECT_EQ(wild.best->setting_interval.low, 0.5);
  // 0.5 gives .1 .2 .3; the best of each seed .1 .2 .2.
  EXPECT_NEAR(wild.mean_regret_of_seed[1], 0.1 / 3.0, 1e-12);
  EXPECT_NEAR(wild.mean_regret_of_seed[0], (0.5 + 0.5 + 0.6) / 3.0, 1e-12);
  // The seed that failed at gain 1 counts nowhere on the other line.
  const GridLine& calm = lines[1];
  ASSERT_TRUE(calm.best);
  EXPECT_EQ(calm.best->setting, 0.0);
  EXPECT_NEAR(calm.mean_regret_of_seed[2], 1.0, 1e-12);
}

// Gain 1 always fails on the line of the wild profile, all gains but one on the other.
TEST(SweepGrid, AValueWithoutAFigureIsLeftOutOfItsLine) {
  SweepResults table = Table();
  const auto fail = [&](std::size_t point) {
    for (std::size_t row = 3 * point; row < 3 * point + 3; ++row) {
      table.failures[row] = "a wall";
      table.metrics[0].values[row] = kNone;
    }
  };
  for (const std::size_t point : {0U, 1U, 5U}) fail(point);
  const auto lines = LinesAlong(GridOf(table), 0, table.metrics[0].values, Better::kLower, {});
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].points, (std::vector<std::size_t>{2, 4}));  // gain 0, 0.5
  EXPECT_EQ(lines[0].left_out, std::vector<std::size_t>{0});
  ASSERT_TRUE(lines[0].best);
  EXPECT_EQ(lines[0].best->setting, 0.5);
  EXPECT_EQ(lines[0].seeds, 3U);
  EXPECT_EQ(lines[1].points, std::vector<std::size_t>{3});
  EXPECT_EQ(lines[1].left_out, (std::vector<std::size_t>{5, 1}));
  EXPECT_FALSE(lines[1].best);
}

// One axis of seeds that come in families: slam_seed 0 with depth seeds 0 and 1, 1 with 2 and 3.
TEST(SweepGrid, SeedsWithinAnotherSeedCountAsThatOne) {
  const SweepResults table = TwoGains([](int run) -> Seeds { return {run / 2, run}; });
  const auto lines = LinesAlong(GridOf(table), 0, table.metrics[0].values, Better::kLower, {});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].seeds, 2U);
  EXPECT_EQ(lines[0].best->setting, 0.0);
}

TEST(SweepGrid, HasNoLineThroughPointsThatDifferOtherwise) {
  SweepResults table = Table();
  // As in a zip: each gain with a profile of its own.
  for (std::size_t row = 0; row < table.rows(); ++row) {
    table.parameters[1].texts[row] = table.parameters[0].texts[row];
    table.points[row] /= 2;
  }
  EXPECT_TRUE(LinesAlong(GridOf(table), 0, table.metrics[0].values, Better::kLower, {}).empty());
}

// Modes `fixed` with gains 0, 0.5, 1 and, at gain 0.5 alone or not at all, `oracle`; two rooms.
SweepResults TableWithOracle(bool with_oracle) {
  SweepResults results;
  SweepParameter mode{"mapper.fusion.mode", {}, {}};
  SweepParameter gain{"mapper.fusion.gain", {}, {}};
  SweepParameter room{"scene", {}, {}};
  SweepParameter seed{"seed", {}, {}};
  SweepColumn error{"trajectory.est.mean_euclidean_m", {}};
  int point = 0;
  const auto add = [&](const char* name, double g, const char* scene, double offset) {
    for (int s = 1; s <= 2; ++s) {
      results.runs.push_back(static_cast<int>(results.runs.size()));
      results.points.push_back(point);
      mode.texts.emplace_back(name);
      mode.numbers.push_back(kNone);
      gain.texts.push_back(std::to_string(g));
      gain.numbers.push_back(g);
      room.texts.emplace_back(scene);
      room.numbers.push_back(kNone);
      seed.texts.push_back(std::to_string(s));
      seed.numbers.push_back(s);
      error.values.push_back(offset + s);
      results.failures.emplace_back();
    }
    ++point;
  };
  for (const double g : {0.0, 0.5, 1.0}) {
    add("fixed", g, "hall", 10.0 + g);
    add("fixed", g, "attic", 20.0 - g);
  }
  if (with_oracle) {
    add("oracle", 0.5, "hall", 7.0);
    add("oracle", 0.5, "attic", 16.0);
  }
  results.parameters = {mode, gain, room, seed};
  results.metrics = {error};
  return results;
}

TEST(SweepGrid, RegretIsToTheOraclesRunsWhereThereAreAny) {
  SweepResults table = TableWithOracle(true);
  const auto lines_of = [](const SweepResults& t) {
    return LinesAlong(GridOf(t), 1, t.metrics[0].values, Better::kLower, {});
  };
  const auto expect = [](const GridLine& line, bool to_oracle, std::vector<double> regret) {
    EXPECT_EQ(line.to_oracle_runs, to_oracle);
    ASSERT_EQ(line.mean_regret_of_seed.size(), regret.size());
    for (std::size_t i = 0; i < regret.size(); ++i) {
      EXPECT_NEAR(line.mean_regret_of_seed[i], regret[i], 1e-12) << i;
    }
  };
  auto lines = lines_of(table);
  ASSERT_EQ(lines.size(), 2U);
  expect(lines[0], true, {3.0, 3.5, 4.0});
  expect(lines[1], true, {4.0, 3.5, 3.0});
  // The oracle of the hall lost one seed: there the best of each seed is all there is.
  table.metrics[0].values[12] = kNone;
  table.failures[12] = "lost";
  lines = lines_of(table);
  expect(lines[0], false, {0.0, 0.5, 1.0});
  expect(lines[1], true, {4.0, 3.5, 3.0});
  lines = lines_of(TableWithOracle(false));
  expect(lines[0], false, {0.0, 0.5, 1.0});
}

TEST(MetricDirection, IsThatOfTheScore) {
  EXPECT_EQ(BetterOf("map.observable.occupied.f1"), Better::kHigher);
  EXPECT_EQ(BetterOf("map.coverage"), Better::kHigher);
  EXPECT_EQ(BetterOf("map.chamfer_m"), Better::kLower);
  EXPECT_EQ(BetterOf("trajectory.est.mean_euclidean_m"), Better::kLower);
}

}  // namespace
}  // namespace depthgrid
