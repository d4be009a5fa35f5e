#include "eval/compare/sweep_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <utility>

namespace depthgrid {
namespace {

GridAxis AxisOf(const SweepParameter& parameter) {
  GridAxis axis{parameter.key, parameter.IsNumeric(), {}, {}};
  std::map<std::string, double> number_of;
  for (std::size_t row = 0; row < parameter.texts.size(); ++row) {
    if (number_of.try_emplace(parameter.texts[row], parameter.numbers[row]).second) {
      axis.texts.push_back(parameter.texts[row]);
    }
  }
  if (!axis.numeric) return axis;
  std::stable_sort(
      axis.texts.begin(), axis.texts.end(),
      [&](const std::string& a, const std::string& b) { return number_of[a] < number_of[b]; });
  for (const std::string& text : axis.texts) axis.numbers.push_back(number_of[text]);
  return axis;
}

std::vector<std::string> SeedTexts(const SweepResults& results) {
  std::vector<std::string> seeds(results.rows());
  for (const SweepParameter& parameter : results.parameters) {
    if (!parameter.IsSeed()) continue;
    for (std::size_t row = 0; row < results.rows(); ++row) {
      if (!seeds[row].empty()) seeds[row] += " ";
      seeds[row] += parameter.texts[row];
    }
  }
  return seeds;
}

std::vector<std::size_t> Measurements(const SweepResults& results, const SweepGrid& grid) {
  std::vector<std::size_t> measurement_of_row(results.rows());
  std::iota(measurement_of_row.begin(), measurement_of_row.end(), std::size_t{0});
  for (const GridPoint& point : grid.points) {
    std::map<std::vector<std::uint64_t>, std::size_t> row_of_scores;
    for (const std::size_t row : point.rows) {
      measurement_of_row[row] =
          row_of_scores.try_emplace(results.ScoreBits(row), row).first->second;
    }
  }
  return measurement_of_row;
}

using SeedRows = std::map<std::string, std::size_t>;

SeedRows RowsBySeed(const SweepGrid& grid, const GridPoint& point,
                    const std::vector<double>& metric) {
  SeedRows rows;
  for (const std::size_t row : point.rows) {
    if (std::isfinite(metric[row])) rows[grid.seeds_of_row[row]] = row;
  }
  return rows;
}

// The seeds that every point of a line has, in the order of the first point's runs, without those
// that gave the same as an earlier one at all points.
std::vector<std::string> SharedSeeds(const SweepGrid& grid, const GridPoint& first,
                                     const std::vector<SeedRows>& by_point) {
  std::vector<std::string> shared;
  std::set<std::vector<std::size_t>> known;
  for (const std::size_t row : first.rows) {
    const std::string& seed = grid.seeds_of_row[row];
    const bool everywhere = std::all_of(by_point.begin(), by_point.end(),
                                        [&](const SeedRows& rows) { return rows.contains(seed); });
    if (!everywhere) continue;
    std::vector<std::size_t> measurements;
    for (const SeedRows& rows : by_point) {
      measurements.push_back(grid.measurement_of_row[rows.at(seed)]);
    }
    if (known.insert(std::move(measurements)).second) shared.push_back(seed);
  }
  return shared;
}

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Finds the point with the oracle's runs for another point's settings.
class OraclePoints {
 public:
  explicit OraclePoints(const SweepGrid& grid) {
    for (std::size_t a = 0; a < grid.axes.size(); ++a) {
      if (grid.axes[a].key == "mapper.fusion.mode") mode_ = a;
      if (grid.axes[a].key == "mapper.fusion.gain") gain_ = a;
    }
    if (!mode_) return;
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
      const std::vector<std::size_t>& values = grid.points[i].values;
      if (grid.axes[*mode_].texts[values[*mode_]] == "oracle") {
        point_of_.try_emplace(Others(values), i);
      }
    }
  }

  std::optional<std::size_t> Of(const GridPoint& point) const {
    if (!mode_) return std::nullopt;
    const auto found = point_of_.find(Others(point.values));
    return found == point_of_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  // The oracle sets the gain itself, so its runs with one gain apply to all gains.
  std::vector<std::size_t> Others(std::vector<std::size_t> values) const {
    values[*mode_] = 0;
    if (gain_) values[*gain_] = 0;
    return values;
  }

  std::optional<std::size_t> mode_;  // axes
  std::optional<std::size_t> gain_;
  std::map<std::vector<std::size_t>, std::size_t> point_of_;
};

// By point of a line, the oracle's values for these seeds; empty if one is missing.
std::vector<std::vector<double>> OracleFigures(const SweepGrid& grid, const OraclePoints& oracles,
                                               const std::vector<double>& metric,
                                               const std::vector<std::size_t>& points,
                                               const std::vector<std::string>& seeds) {
  std::vector<std::vector<double>> figures;
  for (const std::size_t point : points) {
    const auto oracle = oracles.Of(grid.points[point]);
    if (!oracle) return {};
    const SeedRows rows = RowsBySeed(grid, grid.points[*oracle], metric);
    figures.emplace_back();
    for (const std::string& seed : seeds) {
      const auto row = rows.find(seed);
      if (row == rows.end()) return {};
      figures.back().push_back(metric[row->second]);
    }
  }
  return figures;
}

// The lines along one axis, judged by one score.
class Lines {
 public:
  Lines(const SweepGrid& grid, std::size_t axis, const std::vector<double>& metric, Better better,
        const BootstrapOptions& bootstrap)
      : grid_(grid),
        axis_(axis),
        metric_(metric),
        better_(better),
        bootstrap_(bootstrap),
        oracles_(grid) {}

  // The line through these points, by ascending value of the axis.
  GridLine Through(const std::vector<std::size_t>& points) const {
    GridLine line;
    std::vector<SeedRows> by_point;
    for (const std::size_t point : points) {
      SeedRows rows = RowsBySeed(grid_, grid_.points[point], metric_);
      // With a point whose runs all failed, the points would share no seed and there would be no
      // best value.
      (rows.empty() ? line.left_out : line.points).push_back(point);
      if (!rows.empty()) by_point.push_back(std::move(rows));
    }
    if (line.points.size() < 2 || better_ == Better::kNeither) return line;
    const std::vector<std::string> seeds =
        SharedSeeds(grid_, grid_.points[line.points.front()], by_point);
    if (seeds.empty()) return line;
    std::vector<SettingRuns> settings = SettingsOf(line.points, by_point, seeds);
    const auto oracle_runs = OracleFigures(grid_, oracles_, metric_, line.points, seeds);
    line.to_oracle_runs = !oracle_runs.empty();
    const std::vector<double> best_of_seed = BestOfEachSeed(settings, better_);
    for (std::size_t i = 0; i < settings.size(); ++i) {
      const std::vector<double>& oracle = line.to_oracle_runs ? oracle_runs[i] : best_of_seed;
      line.mean_regret_of_seed.push_back(Mean(Regret(settings[i].by_seed, oracle, better_)));
    }
    const SeedUnits units = UnitsOf(seeds);
    line.seeds = units.count();
    if (units.count() < seeds.size()) {
      for (SettingRuns& setting : settings) setting.by_seed = units.Figures(setting.by_seed);
    }
    line.best = FindBestSetting(settings, better_, Resamples(line.seeds, bootstrap_));
    return line;
  }

 private:
  std::vector<SettingRuns> SettingsOf(const std::vector<std::size_t>& points,
                                      const std::vector<SeedRows>& by_point,
                                      const std::vector<std::string>& seeds) const {
    std::vector<SettingRuns> settings;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t value = grid_.points[points[i]].values[axis_];
      settings.push_back({grid_.axes[axis_].numbers[value], {}});
      for (const std::string& seed : seeds) {
        settings.back().by_seed.push_back(metric_[by_point[i].at(seed)]);
      }
    }
    return settings;
  }

  const SweepGrid& grid_;
  std::size_t axis_;
  const std::vector<double>& metric_;
  Better better_;
  const BootstrapOptions& bootstrap_;
  OraclePoints oracles_;
};

}  // namespace

SeedUnits UnitsOf(const std::vector<std::string>& seeds) {
  std::vector<std::vector<std::string>> values;
  for (const std::string& texts : seeds) {
    values.emplace_back();
    std::istringstream fields(texts);
    for (std::string field; fields >> field;) values.back().push_back(field);
  }
  return SeedUnits(values);
}

SweepGrid GridOf(const SweepResults& results) {
  SweepGrid grid;
  std::vector<const SweepParameter*> varied;
  for (const SweepParameter& parameter : results.parameters) {
    if (parameter.IsSeed()) {
      ++grid.seed_axes;
      continue;
    }
    varied.push_back(&parameter);
    grid.axes.push_back(AxisOf(parameter));
  }
  grid.seeds_of_row = SeedTexts(results);
  std::map<int, std::size_t> index_of;
  for (std::size_t row = 0; row < results.rows(); ++row) {
    const auto [entry, is_new] = index_of.try_emplace(results.points[row], grid.points.size());
    if (is_new) {
      GridPoint point;
      for (std::size_t a = 0; a < varied.size(); ++a) {
        const std::vector<std::string>& texts = grid.axes[a].texts;
        const auto found = std::find(texts.begin(), texts.end(), varied[a]->texts[row]);
        point.values.push_back(static_cast<std::size_t>(found - texts.begin()));
      }
      grid.points.push_back(std::move(point));
    }
    if (results.failures[row].empty()) grid.points[entry->second].rows.push_back(row);
  }
  grid.measurement_of_row = Measurements(results, grid);
  return grid;
}

std::vector<GridLine> LinesAlong(const SweepGrid& grid, std::size_t axis,
                                 const std::vector<double>& metric, Better better,
                                 const BootstrapOptions& bootstrap) {
  std::map<std::vector<std::size_t>, std::vector<std::size_t>> points_of;  // by the other axes
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    std::vector<std::size_t> held = grid.points[i].values;
    held[axis] = 0;
    points_of[held].push_back(i);
  }
  const Lines along(grid, axis, metric, better, bootstrap);
  std::vector<GridLine> lines;
  for (auto& [held, points] : points_of) {
    const auto value = [&](std::size_t point) { return grid.points[point].values[axis]; };
    std::stable_sort(points.begin(), points.end(),
                     [&](std::size_t a, std::size_t b) { return value(a) < value(b); });
    std::set<std::size_t> distinct;
    for (const std::size_t point : points) distinct.insert(value(point));
    if (distinct.size() < 2 || distinct.size() != points.size()) continue;
    lines.push_back(along.Through(points));
  }
  return lines;
}

}  // namespace depthgrid
