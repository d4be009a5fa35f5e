#include "eval/compare/sweep_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

#include "eval/compare/sweep_grid.h"
#include "eval/experiment/changed_settings.h"
#include "eval/experiment/shipped.h"
#include "eval/files/json_text_impl.h"
#include "eval/files/metric_columns.h"
#include "eval/files/shell_word.h"
#include "eval/metrics/statistics.h"
#include "eval/report/report_json_impl.h"
#include "eval/report/web_assets.h"
#include "eval/statistics/metric_direction.h"
#include "eval/statistics/score_names.h"
#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;
using Json = ReportJson;

// With more runs than this the page lists only grid points.
constexpr std::size_t kMostRunsListed = 20'000;
constexpr int kSignificantDigits = 6;
// Integers below this are counts and are not rounded.
constexpr double kMostCounted = 1e15;

// The metric's rank among the main scores, from 1; 0 for others.
int MainRank(const std::string& metric) {
  const auto main = ScoresOfASweepsPage();
  const auto found = std::find(main.begin(), main.end(), metric);
  return found == main.end() ? 0 : static_cast<int>(found - main.begin()) + 1;
}

Json Short(double value) {
  if (!std::isfinite(value)) return nullptr;
  if (value == std::round(value) && std::abs(value) < kMostCounted) return value;
  // Not stod, which throws for a p-value below 1e-308.
  return std::strtod(fmt::format("{:.{}g}", value, kSignificantDigits).c_str(), nullptr);
}

// With 10,000 resamples the intervals' ends vary by about 1 % of the width. Minor metrics, of which
// there are dozens, and large sweeps get fewer, so that the page does not take minutes.
BootstrapOptions BootstrapFor(const SweepResults& results, bool main_metric) {
  constexpr double kMostDraws = 2e7;  // some seconds
  constexpr double kFewest = 1000.0;
  constexpr double kMostOfOthers = 2000.0;
  BootstrapOptions options;
  const double most = main_metric ? options.resamples : kMostOfOthers;
  options.resamples =
      static_cast<int>(std::clamp(kMostDraws / static_cast<double>(results.rows()), kFewest, most));
  return options;
}

// A value for the command of a run, which is started in the sweep's folder.
std::string SetText(const SweepResults& results, const std::string& key, const std::string& text) {
  const std::string folder = results.EnvironmentText("files_from");
  const bool is_file = IsFileKey(key) && IsFileName(text);
  if (!is_file || folder.empty()) return text;
  return (fs::path(folder) / text).lexically_normal().string();
}

// The scenes' own names, by the values of their key (SceneNamesText).
std::map<std::string, std::string> SceneNames(const SweepResults& results) {
  std::map<std::string, std::string> names;
  std::istringstream lines(results.EnvironmentText("scene_names"));
  for (std::string line; std::getline(lines, line);) {
    const auto equals = line.find(" = ");
    if (equals != std::string::npos) names[line.substr(0, equals)] = line.substr(equals + 3);
  }
  return names;
}

Json AxesJson(const SweepResults& results, const SweepGrid& grid) {
  Json json = Json::array();
  const std::map<std::string, std::string> scenes = SceneNames(results);
  for (const GridAxis& axis : grid.axes) {
    Json one = {{"key", axis.key}, {"numeric", axis.numeric}, {"texts", axis.texts}};
    for (const std::string& text : axis.texts) {
      one["set"].push_back(ShellWord(SetText(results, axis.key, text)));
    }
    if (axis.numeric) one["numbers"] = axis.numbers;
    for (const std::string& text : axis.texts) {
      const auto name = scenes.find(text);
      if (axis.key == "scene") one["names"].push_back(name != scenes.end() ? name->second : "");
    }
    json.push_back(one);
  }
  return json;
}

Json PointsJson(const SweepGrid& grid) {
  Json json = Json::array();
  for (const GridPoint& point : grid.points) {
    const auto counts = std::count_if(point.rows.begin(), point.rows.end(), [&](std::size_t row) {
      return grid.measurement_of_row[row] == row;
    });
    json.push_back({{"values", point.values}, {"runs", point.rows.size()}, {"counting", counts}});
  }
  return json;
}

// A score in the form in which the page shows it.
struct ShownMetric {
  std::string name;
  std::string score;  // the score's name, which differs from the metric's for a distance
  Better better = Better::kLower;
  std::vector<double> values;
};

// A score with a target appears twice: unchanged, without a better direction, and as its distance
// from the target, for which lower is better.
std::vector<ShownMetric> ShownMetrics(const SweepResults& results) {
  std::vector<ShownMetric> shown;
  for (const auto& [name, values] : results.metrics) {
    const bool any =
        std::any_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    if (!any) continue;
    const auto target = TargetOf(name);
    shown.push_back({name, name, target ? Better::kNeither : BetterOf(name), values});
    if (!target) continue;
    shown.push_back({DistanceName(name, *target), name, Better::kLower, values});
    for (double& value : shown.back().values) value = DistanceFrom(*target, value);
  }
  return shown;
}

Json LinesJson(const SweepGrid& grid, std::size_t axis, const ShownMetric& metric,
               const BootstrapOptions& bootstrap) {
  Json json = Json::array();
  for (const GridLine& line : LinesAlong(grid, axis, metric.values, metric.better, bootstrap)) {
    Json one = {{"points", line.points}, {"left_out", line.left_out}};
    if (!line.best) {
      json.push_back(one);
      continue;
    }
    const BestSetting& best = *line.best;
    one["best"] = best.index;
    if (best.is_alike) one["alike"] = true;
    one["seeds"] = line.seeds;
    one["low"] = best.setting_interval.low;
    one["high"] = best.setting_interval.high;
    if (line.to_oracle_runs) one["to_oracle"] = true;
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      one["share_best"].push_back(Rounded(best.share_best[i], 3));
      one["p"].push_back(Short(best.p_as_good[i]));
      one["regret"].push_back(Short(best.regret_mean[i]));
      one["regret_of_seed"].push_back(Short(line.mean_regret_of_seed[i]));
    }
    json.push_back(one);
  }
  return json;
}

// Adds the statistics of one grid point over its seeds.
void AddPoint(const SweepGrid& grid, const GridPoint& point, const std::vector<double>& values,
              std::map<std::size_t, Resamples>& resamples, const BootstrapOptions& bootstrap,
              Json& json) {
  std::vector<double> sample;
  std::vector<std::string> seeds;
  for (const std::size_t row : point.rows) {
    if (!std::isfinite(values[row]) || grid.measurement_of_row[row] != row) continue;
    sample.push_back(values[row]);
    seeds.push_back(grid.seeds_of_row[row]);
  }
  Json mean, median, low, high;
  if (!sample.empty()) {
    mean = Short(std::accumulate(sample.begin(), sample.end(), 0.0) /
                 static_cast<double>(sample.size()));
    median = Short(Percentile(sample, 0.5));
    if (grid.seed_axes > 1) {
      const SeedUnits units = UnitsOf(seeds);
      if (units.count() < sample.size()) sample = units.Figures(sample);
    }
    const auto table = resamples.try_emplace(sample.size(), sample.size(), bootstrap).first;
    if (const auto interval = MeanInterval(sample, table->second)) {
      low = Short(interval->low);
      high = Short(interval->high);
    }
  }
  json["mean"].push_back(mean);
  json["median"].push_back(median);
  json["low"].push_back(low);
  json["high"].push_back(high);
}

Json MetricsJson(const SweepResults& results, const SweepGrid& grid) {
  std::map<std::size_t, Resamples> main_resamples;  // by number of seeds
  std::map<std::size_t, Resamples> other_resamples;
  Json json = Json::array();
  for (const ShownMetric& metric : ShownMetrics(results)) {
    const bool is_main = MainRank(metric.name) > 0;
    const BootstrapOptions bootstrap = BootstrapFor(results, is_main);
    auto& resamples = is_main ? main_resamples : other_resamples;
    Json one = {{"name", metric.name},
                {"score", metric.score},
                {"resamples", bootstrap.resamples},
                {"better", NameOf(metric.better)},
                {"main", MainRank(metric.name)}};
    for (const GridPoint& point : grid.points) {
      AddPoint(grid, point, metric.values, resamples, bootstrap, one);
    }
    if (is_main) {
      for (std::size_t axis = 0; axis < grid.axes.size(); ++axis) {
        if (grid.axes[axis].numeric) {
          one["lines"][grid.axes[axis].key] = LinesJson(grid, axis, metric, bootstrap);
        }
      }
    }
    json.push_back(one);
  }
  return json;
}

Json RunsJson(const SweepResults& results, const SweepGrid& grid) {
  Json json = {{"run", results.runs}, {"seeds", grid.seeds_of_row}};
  std::vector<std::size_t> point_of_row(results.rows(), 0);
  std::map<int, std::size_t> index_of;
  for (std::size_t row = 0; row < results.rows(); ++row) {
    point_of_row[row] = index_of.try_emplace(results.points[row], index_of.size()).first->second;
  }
  json["point"] = point_of_row;
  Json folders = Json::object();  // of runs that have a page
  Json failures = Json::object();
  for (std::size_t row = 0; row < results.rows(); ++row) {
    const std::string folder = fmt::format("runs/{}", results.runs[row]);
    if (fs::exists(results.folder + "/" + folder + "/report.html")) {
      folders[std::to_string(row)] = folder;
    }
    if (!results.failures[row].empty()) failures[std::to_string(row)] = results.failures[row];
  }
  json["folder"] = folders;
  json["failures"] = failures;
  for (const SweepColumn& metric : results.metrics) {
    if (MainRank(metric.name) == 0) continue;
    Json values = Json::array();
    for (const double value : metric.values) values.push_back(Short(value));
    json["metrics"][metric.name] = values;
  }
  return json;
}

Json SweepJson(const SweepResults& results, const SweepGrid& grid) {
  Json json;
  json["planned"] = results.planned_runs;
  json["finished"] = results.rows();
  json["failed"] = std::count_if(results.failures.begin(), results.failures.end(),
                                 [](const std::string& reason) { return !reason.empty(); });
  json["environment"] = results.environment;
  json["environment"].erase("jobs");  // the page must not depend on the number of parallel jobs
  json["seed_keys"] = Json::array();
  for (const SweepParameter& parameter : results.parameters) {
    if (parameter.IsSeed()) json["seed_keys"].push_back(parameter.key);
  }
  if (grid.seed_axes > 1) {
    std::vector<std::string> seeds;
    for (std::size_t row = 0; row < results.rows(); ++row) {
      if (grid.measurement_of_row[row] == row) seeds.push_back(grid.seeds_of_row[row]);
    }
    const SeedUnits units = UnitsOf(seeds);
    if (!units.crossed().empty()) json["crossed_seeds"] = units.count();
  }
  json["axes"] = AxesJson(results, grid);
  json["points"] = PointsJson(grid);
  json["metrics"] = MetricsJson(results, grid);
  json["runs"] = results.rows() <= kMostRunsListed ? RunsJson(results, grid) : Json(nullptr);
  return json;
}

// The main settings common to all runs, for the page's head.
std::string MeasuredBy(const SweepResults& results) {
  std::set<std::string> varied;
  for (const SweepParameter& parameter : results.parameters) varied.insert(parameter.key);
  const std::string experiment = results.EnvironmentText("experiment");
  if (experiment.empty()) return "";
  const std::map<std::string, std::string> scenes = SceneNames(results);
  return MeasuredSettings(Config::FromText(experiment, results.folder), varied,
                          scenes.size() == 1 ? scenes.begin()->second : "");
}

// The experiment common to all runs: only the given keys, so that an axis over a preset
// (slam.profile) sets the same keys as in the sweep. Sweeps of earlier versions have only all
// effective keys.
std::string ExperimentYaml(const SweepResults& results) {
  const std::string given = results.EnvironmentText("given");
  if (given.empty()) return results.EnvironmentText("experiment");
  Config experiment;
  for (const ConfigEntry& entry : Config::FromText(given, results.folder).Entries()) {
    experiment.Set(entry.key, entry.text);
  }
  return experiment.ToYaml();
}

}  // namespace

void WriteSweepReport(const std::string& folder, const ReportPlace& place) {
  const SweepResults results = ReadSweep(folder);
  if (results.rows() == 0) throw InputError(folder, "no run of this sweep is finished yet");
  const std::string experiment = ExperimentYaml(results);
  if (!experiment.empty()) WriteFile(place.into + "/experiment.yaml", experiment);
  const std::string again = results.EnvironmentText("again");
  if (!again.empty()) WriteFile(place.into + "/sweep_again.yaml", again);
  const std::string title = results.EnvironmentText("title");
  Json json = SweepJson(results, GridOf(results));
  json["back"] = place.back;
  json["of"] = MeasuredBy(results);
  WriteFile(place.into + "/report.html",
            FillPage("sweep.html", title.empty() ? "Sweep" : title, JsonText(json)));
}

}  // namespace depthgrid
