#include "eval/sweep/sweep_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <unordered_map>

#include "eval/doubts/record_check.h"
#include "eval/experiment/shipped.h"
#include "eval/sweep/sweep_again.h"
#include "eval/sweep/sweep_doubts.h"
#include "eval/sweep/sweep_experiment.h"
#include "eval/sweep/sweep_metrics.h"
#include "eval/sweep/sweep_results.h"
#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// The top level of a sweep's file except `axes` and `set`.
struct SweepFileOptions {
  std::string experiment;
  SweepMode mode = SweepMode::kGrid;
  int samples = 0;
  std::uint64_t sample_seed = 1;
  StopOptions stop;

  void Visit(OptionsVisitor& v) {
    v.Text("experiment", experiment, "a shipped experiment or a file");
    v.Choice("mode", mode,
             {{SweepMode::kGrid, "grid"}, {SweepMode::kZip, "zip"}, {SweepMode::kRandom, "random"}},
             "how axes are combined");
    v.Number("samples", samples, {1, kMostSweepRuns}, "points of a random sweep");
    v.Seed("sample_seed", sample_seed, "of the draws of a random sweep");
    v.Group("stop", stop, "when a point needs no more seeds");
  }
};

// A point or a seed: the value texts of some axes, concatenated.
using Combination = std::vector<std::string>;

std::vector<Combination> Grid(const std::vector<const SweepAxis*>& axes) {
  std::vector<Combination> combinations = {{}};
  for (const SweepAxis* axis : axes) {
    std::vector<Combination> longer;
    for (const Combination& combination : combinations) {
      for (const auto& value : axis->values) {
        longer.push_back(combination);
        longer.back().insert(longer.back().end(), value.begin(), value.end());
      }
    }
    combinations = std::move(longer);
  }
  return combinations;
}

std::vector<Combination> Zip(const std::vector<const SweepAxis*>& axes) {
  std::vector<Combination> combinations(axes.empty() ? 1 : axes[0]->values.size());
  for (const SweepAxis* axis : axes) {
    if (axis->values.size() != combinations.size()) {
      throw InputError(axis->place,
                       fmt::format("has {} values, the first axis has {}: in mode zip all have the "
                                   "same number",
                                   axis->values.size(), combinations.size()));
    }
    for (std::size_t i = 0; i < combinations.size(); ++i) {
      combinations[i].insert(combinations[i].end(), axis->values[i].begin(), axis->values[i].end());
    }
  }
  return combinations;
}

std::vector<Combination> Samples(const std::vector<const SweepAxis*>& axes, int count,
                                 std::uint64_t seed) {
  std::vector<Combination> combinations;
  for (int i = 0; i < count; ++i) {
    RandomStream random(seed, RandomStage::kSweep, static_cast<std::uint32_t>(i));
    Combination combination;
    for (const SweepAxis* axis : axes) {
      if (axis->range) {
        combination.push_back(fmt::format("{}", axis->range->Drawn(random.Uniform())));
      } else {
        const auto& value = axis->values[random.Below(axis->values.size())];
        combination.insert(combination.end(), value.begin(), value.end());
      }
    }
    combinations.push_back(std::move(combination));
  }
  return combinations;
}

std::vector<Combination> Points(const std::vector<const SweepAxis*>& axes,
                                const SweepFileOptions& file, const std::string& place) {
  if (file.mode == SweepMode::kRandom) {
    if (file.samples == 0) throw InputError(place, "mode random needs 'samples'");
    return Samples(axes, file.samples, file.sample_seed);
  }
  for (const SweepAxis* axis : axes) {
    if (axis->range)
      throw InputError(axis->place, "a range needs 'count': only mode random draws without it");
  }
  return file.mode == SweepMode::kZip ? Zip(axes) : Grid(axes);
}

// Reorders the values of some `axes` into the order of all keys.
struct KeyOrder {
  std::vector<std::size_t> position;  // of each key of the axes among all keys

  KeyOrder(const std::vector<const SweepAxis*>& axes, const std::vector<std::string>& keys) {
    for (const SweepAxis* axis : axes) {
      for (const std::string& key : axis->keys) {
        position.push_back(
            static_cast<std::size_t>(std::find(keys.begin(), keys.end(), key) - keys.begin()));
      }
    }
  }
  void Put(const Combination& combination, std::vector<std::string>& values) const {
    for (std::size_t i = 0; i < position.size(); ++i) values[position[i]] = combination[i];
  }
};

void EnumerateRuns(const SweepFileOptions& file, const std::string& place, SweepPlan& plan) {
  std::vector<const SweepAxis*> point_axes;
  std::vector<const SweepAxis*> seed_axes;
  for (const SweepAxis& axis : plan.axes) {
    (axis.IsSeed() ? seed_axes : point_axes).push_back(&axis);
    plan.parameter_keys.insert(plan.parameter_keys.end(), axis.keys.begin(), axis.keys.end());
  }
  const std::vector<Combination> points = Points(point_axes, file, place);
  SweepFileOptions crossed = file;
  crossed.mode = SweepMode::kGrid;
  const std::vector<Combination> seeds = Points(seed_axes, crossed, place);
  const KeyOrder point_order(point_axes, plan.parameter_keys);
  const KeyOrder seed_order(seed_axes, plan.parameter_keys);
  plan.point_count = static_cast<int>(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (const Combination& seed : seeds) {
      PlannedRun run;
      run.run = static_cast<int>(plan.runs.size());
      run.point = static_cast<int>(p);
      run.values.resize(plan.parameter_keys.size());
      point_order.Put(points[p], run.values);
      seed_order.Put(seed, run.values);
      plan.runs.push_back(std::move(run));
    }
  }
  plan.size_text = Counted(points.size(), "point") + " x " + Counted(seeds.size(), "seed");
}

// Checked before the runs are made, from the sizes of the axes alone.
void RequireFewEnough(const SweepFileOptions& file, const std::vector<SweepAxis>& axes,
                      const std::string& place) {
  double points = file.mode == SweepMode::kRandom ? file.samples : 1.0;
  double seeds = 1.0;
  for (const SweepAxis& axis : axes) {
    const auto values = static_cast<double>(axis.values.size());
    if (axis.IsSeed()) {
      seeds *= values;
    } else if (file.mode == SweepMode::kGrid) {
      points *= values;
    } else if (file.mode == SweepMode::kZip) {
      points = std::max(points, values);
    }
  }
  if (points * seeds <= kMostSweepRuns) return;
  throw InputError(
      place, fmt::format("has {:.0f} runs, must have at most {}", points * seeds, kMostSweepRuns));
}

// Checks each value on its own, so that errors are found before the first run, with their line.
void CheckValues(const SweepPlan& plan) {
  for (const SweepAxis& axis : plan.axes) {
    std::vector<std::vector<std::string>> values = axis.values;
    if (axis.range) {
      values = {{fmt::format("{}", axis.range->from)}, {fmt::format("{}", axis.range->to)}};
    }
    for (const auto& value : values) {
      Config own;
      for (std::size_t i = 0; i < axis.keys.size(); ++i)
        own.Set(axis.keys[i], value[i], axis.place);
      ReadExperiment({&plan.base, &own}, plan.base_folder);
    }
  }
}

// Rejects settings that would silently have no effect.
void RequireEffect(const Config& config, const SweepFileOptions& file) {
  if (config.Has("stop.width") && file.stop.width <= 0.0) {
    throw InputError(config.PlaceOfKey("stop.width"),
                     fmt::format("stop.width is {}, must be above 0", file.stop.width));
  }
  if (config.Has("stop") && (!file.stop.Enabled() || file.stop.width <= 0.0)) {
    throw InputError(config.PlaceOfKey("stop"), "stop needs a 'metric' and a 'width' above 0");
  }
  for (const char* key : {"samples", "sample_seed"}) {
    if (file.mode == SweepMode::kRandom || !config.Has(key)) continue;
    throw InputError(config.PlaceOfKey(key), fmt::format("'{}' is for mode random alone", key));
  }
}

void CheckStop(const StopOptions& stop, const std::string& place) {
  if (!stop.Enabled()) return;
  const std::vector<std::string> names = SweepMetricNames();
  if (std::find(names.begin(), names.end(), stop.metric) != names.end()) return;
  throw InputError(place, fmt::format("stop.metric is '{}', must be a metric of results.csv{}",
                                      stop.metric, DidYouMeanColumn(stop.metric, names)));
}

std::string TextOf(const SweepFileOptions& file, const SweepPlan& plan) {
  std::string text = ToYaml(file) + "axes:\n";
  for (const SweepAxis& axis : plan.axes) {
    text += fmt::format("  {}:", fmt::join(axis.keys, ", "));
    if (axis.range) {
      const char* scale = axis.range->scale == RangeScale::kLog ? ", log" : "";
      text += fmt::format(" {} to {}{}", axis.range->from, axis.range->to, scale);
    }
    for (const auto& value : axis.values) text += fmt::format(" [{}]", fmt::join(value, ", "));
    text += "\n";
  }
  return text;
}

void RequireSweep(const Config& config, const std::string& path) {
  if (config.Has("axes") || config.Has("experiment")) return;
  if (config.Has("cases")) {
    throw InputError(path, "holds several experiments; only `depthgrid run` takes it");
  }
  if (config.Has("scene")) throw InputError(path, "is an experiment; `depthgrid run` takes it");
}

std::vector<std::string> KeysOfSweep() {
  std::vector<std::string> keys = Config::FromText(ToYaml(SweepFileOptions{}), "").Keys();
  keys.insert(keys.end(), {"axes", "set"});
  return keys;
}

// Keys of the experiment get their own message; other unknown keys get the nearest key of a sweep.
void RefuseExperimentsKeys(const Config& config) {
  const std::vector<std::string> own = KeysOfSweep();
  const std::vector<std::string> of_experiment =
      Config::FromText(ToYaml(ExperimentOptions{}), "").Keys();
  const auto holds = [](const std::vector<std::string>& keys, const std::string& key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  for (const ConfigEntry& entry : config.Entries()) {
    const std::string group = entry.key.substr(0, entry.key.find('.'));
    if (holds(own, entry.key) || !holds(of_experiment, group)) continue;
    const std::string example = entry.map ? entry.key + ".KEY" : entry.key;
    throw InputError(entry.place,
                     fmt::format("'{}' is a key of the experiment, in a sweep it stands in 'set': "
                                 "set: {{{}: ...}}",
                                 entry.key, example));
  }
}

// A missing required key may be present but misspelt.
void RequireKeys(const Config& config, const std::string& path) {
  const std::vector<std::string> known = KeysOfSweep();
  for (const std::string required : {"axes", "experiment"}) {
    if (config.Has(required)) continue;
    for (const ConfigEntry& entry : config.Entries()) {
      const bool is_known = std::find(known.begin(), known.end(), entry.key) != known.end();
      if (is_known || NearestWord(entry.key, known) != required) continue;
      throw InputError(entry.place,
                       fmt::format("unknown key '{}'{}", entry.key, DidYouMean(entry.key, known)));
    }
    throw InputError(path, fmt::format("key '{}' is missing", required));
  }
}

// Whether the sweep itself gives this key, on an axis or for all runs.
bool IsChosen(const std::string& key, const Config& changes, const SweepPlan& plan) {
  const auto& keys = plan.parameter_keys;
  return changes.Has(key) || std::find(keys.begin(), keys.end(), key) != keys.end();
}

// Whether runs that differ only in this key have the same scans.
bool IsOfMapperOnly(const std::string& key) {
  return key.starts_with("mapper.") && !key.starts_with("mapper.scan");
}

std::vector<std::string> DoubtsOf(const SweepPlan& plan, const std::string& experiment_name,
                                  const ExperimentFile& experiment, const SweepLayers& layers) {
  const Config changes = Changed({}, layers.fixed, layers.set);
  const ChosenAnew anew = {IsChosen("scene", changes, plan), IsChosen("trajectory", changes, plan)};
  std::vector<std::string> warnings;
  for (const auto& doubt : {DoubtOfProfiles(experiment_name, experiment.config, changes, plan.axes),
                            DoubtOfRepeats(plan), DoubtOfCameras(plan)}) {
    if (doubt) warnings.push_back(*doubt);
  }
  const ExperimentOptions base = ReadExperiment(plan.base, plan.base_folder);
  for (const auto& doubts :
       {DoubtsOfRecord(experiment.path, experiment.record, base, anew),
        DoubtsOfAxisKeys(plan, layers.fixed, layers.set), DoubtsOfLoneSeeds(plan.axes),
        DoubtsOfLayers(plan, layers, !IsFileName(experiment_name))}) {
    warnings.insert(warnings.end(), doubts.begin(), doubts.end());
  }
  return warnings;
}

}  // namespace

void StopOptions::Visit(OptionsVisitor& v) {
  constexpr double kMaxSeeds = 1e6;
  v.Text("metric", metric, "a metric of results.csv; empty never stops early");
  v.Number("width", width, {}, "of the 95 % interval of its mean; above 0");
  v.Number("min_seeds", min_seeds, {2, kMaxSeeds}, "before a point may stop");
}

ExperimentOptions SweepPlan::OptionsOf(const PlannedRun& run) const {
  Config config = base;
  for (std::size_t i = 0; i < parameter_keys.size(); ++i) {
    config.Set(parameter_keys[i], run.values[i], parameter_keys[i] + "=" + run.values[i]);
  }
  ExperimentOptions options = ReadExperiment({&config}, base_folder);
  options.trajectory_place = PlaceOfKey()("trajectory");
  return options;
}

KeyPlaces SweepPlan::PlaceOfKey() const {
  return [this](const std::string& key) {
    const auto found = places.find(key);
    return found == places.end() ? "" : found->second;
  };
}

SweepPlan ReadSweepPlan(const std::string& path, const std::vector<std::string>& set) {
  Config config = Config::FromFile(path);
  RequireSweep(config, path);
  RequireKeys(config, path);
  RefuseExperimentsKeys(config);
  SweepPlan plan;
  plan.title = fs::path(path).stem().string();
  const std::string place_of_axes = config.PlaceOfKey("axes");
  plan.axes = ReadAxes(config.Take("axes"));
  if (plan.axes.empty()) throw InputError(place_of_axes, "has no axes");
  const Config fixed = config.Take("set");
  const std::string place = config.PlaceOfKey("experiment");
  SweepFileOptions file;
  config.Read(file);
  RequireEffect(config, file);
  RequireFewEnough(file, plan.axes, path);
  const ExperimentFile experiment =
      ReadExperimentFile(file.experiment, place, fs::path(path).parent_path().string());
  plan.base_folder = experiment.folder;
  const auto base_with = [&](const std::vector<std::string>& some) {
    return Changed(Config::FromText(experiment.config.ToYaml(), path + ", set"), fixed, some);
  };
  plan.base = base_with(set);
  plan.experiment_yaml = ToYaml(ReadExperiment(plan.base, plan.base_folder));
  plan.given_text = GivenText(Config::FromText(plan.experiment_yaml, path), plan.base);
  plan.places = PlacesOf(experiment.config, Changed({}, fixed, set), plan.axes);
  CheckValues(plan);
  CheckStop(file.stop, config.PlaceOfKey("stop.metric"));
  EnumerateRuns(file, path, plan);
  plan.warnings =
      DoubtsOf(plan, file.experiment, experiment, {experiment.config, fixed, set, base_with});
  plan.stop = file.stop;
  if (const auto doubt = DoubtOfStop(plan, config.PlaceOfKey("stop"))) {
    plan.warnings.push_back(*doubt);
  }
  file.experiment.clear();  // its content matters, not its name
  plan.sweep_text = TextOf(file, plan);
  plan.again_text = SweepAgainText(plan, file.mode, file.samples, file.sample_seed);
  return plan;
}

std::vector<int> ScanGroups(const SweepPlan& plan) {
  std::vector<std::size_t> shaping;
  for (std::size_t i = 0; i < plan.parameter_keys.size(); ++i) {
    if (!IsOfMapperOnly(plan.parameter_keys[i])) shaping.push_back(i);
  }
  std::unordered_map<std::string, int> known;
  std::vector<int> groups;
  for (const PlannedRun& run : plan.runs) {
    std::string seen;
    for (const std::size_t i : shaping) seen += run.values[i] + "\n";
    groups.push_back(known.try_emplace(seen, static_cast<int>(known.size())).first->second);
  }
  return groups;
}

std::vector<PlannedRun> RunsOf(const SweepPlan& plan, const Shard& shard) {
  if (shard.count == 1) return plan.runs;
  const std::vector<int> groups = ScanGroups(plan);
  std::vector<PlannedRun> runs;
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    const int unit = plan.stop.Enabled() ? plan.runs[i].point : groups[i];
    if (unit % shard.count == shard.index - 1) runs.push_back(plan.runs[i]);
  }
  return runs;
}

}  // namespace depthgrid
