#include "eval/sweep/sweep_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>
#include <utility>

#include "eval/doubts/truth_check.h"
#include "eval/experiment/camera_doubts.h"
#include "eval/experiment/idle_settings.h"
#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

// Reading the settings of a run takes 0.1 ms.
constexpr std::size_t kMostRuns = 5000;

IdleSettingList IdleInEveryRun(const SweepPlan& plan) {
  IdleSettingList idle;
  for (std::size_t i = 0; i < std::min(kMostRuns, plan.runs.size()); ++i) {
    const IdleSettingList here = IdleSettings(plan.OptionsOf(plan.runs[i]));
    idle = i == 0 ? here : InBoth(idle, here);
    if (idle.empty()) break;
  }
  return idle;
}

// Warns of a profile or scenario under `set` whose settings the experiment already gives
// explicitly, as a run.yaml does.
std::vector<std::string> DoubtsOfFixedPresets(const SweepPlan& plan, const SweepLayers& layers,
                                              const std::string& with) {
  std::vector<std::string> doubts;
  for (const ConfigEntry& fixed : layers.fixed.Entries()) {
    if (!IsPreset(fixed.key)) continue;
    Config others = layers.experiment;
    for (const ConfigEntry& entry : layers.fixed.Entries()) {
      if (entry.key != fixed.key) others.Set(entry.key, entry.text);
    }
    const std::string without = ToYaml(ReadExperiment(others, plan.base_folder));
    const std::string reason = WhyPresetIsIdle(fixed.key, with, without);
    if (reason.empty()) continue;
    doubts.push_back(
        fmt::format("{}: {} has no effect because {}", fixed.place, fixed.key, reason));
  }
  return doubts;
}

}  // namespace

std::vector<std::string> DoubtsOfLayers(const SweepPlan& plan, const SweepLayers& layers,
                                        bool is_shipped) {
  IdleSettingList idle = IdleInEveryRun(plan);
  // For axes without effect DoubtOfRepeats() names the repeated runs.
  std::erase_if(idle, [&](const IdleSetting& setting) {
    const auto& axes = plan.parameter_keys;
    return std::find(axes.begin(), axes.end(), setting.key) != axes.end();
  });
  const auto options_with = [&](const std::vector<std::string>& set) {
    return ReadExperiment(layers.base_with(set), plan.base_folder);
  };
  std::vector<std::string> doubts = DoubtsOfOverrides(
      layers.set, idle,
      [&](const std::vector<std::string>& set) { return ToYaml(options_with(set)); });
  const auto add = [&](const std::vector<std::string>& more) {
    doubts.insert(doubts.end(), more.begin(), more.end());
  };
  Config overrides;
  for (const std::string& assignment : layers.set) overrides.Set(assignment);
  const auto is_overridden = [&](const std::string& key) { return overrides.Has(key); };
  add(DoubtsOfFile(
      layers.fixed, idle, [&] { return options_with({}); }, is_overridden));
  add(DoubtsOfFixedPresets(plan, layers, ToYaml(options_with({}))));
  if (is_shipped) return doubts;
  for (const ConfigEntry& entry : layers.fixed.Entries()) overrides.Set(entry.key, entry.text);
  add(DoubtsOfFile(
      layers.experiment, idle, [&] { return ReadExperiment(layers.experiment, plan.base_folder); },
      is_overridden));
  return doubts;
}

std::optional<std::string> DoubtOfRepeats(const SweepPlan& plan) {
  std::unordered_map<std::string, const PlannedRun*> known;
  std::set<std::string> idle_keys;
  std::size_t repeats = 0;
  const std::size_t count = std::min(kMostRuns, plan.runs.size());
  for (std::size_t i = 0; i < count; ++i) {
    const PlannedRun& run = plan.runs[i];
    const auto [entry, is_new] =
        known.try_emplace(ToYaml(WithoutIdleSettings(plan.OptionsOf(run))), &run);
    if (is_new) continue;
    ++repeats;
    for (std::size_t k = 0; k < run.values.size(); ++k) {
      if (run.values[k] != entry->second->values[k]) idle_keys.insert(plan.parameter_keys[k]);
    }
  }
  if (repeats == 0) return {};
  // Random sweeps may draw a point twice where all axes are lists.
  const std::string why = idle_keys.empty()
                              ? "the same values are drawn again"
                              : fmt::format("there {} {} no effect", fmt::join(idle_keys, ", "),
                                            idle_keys.size() == 1 ? "has" : "have");
  return fmt::format("{}: {} of {} {} another: {}", plan.title, repeats, Counted(count, "run"),
                     repeats == 1 ? "repeats" : "repeat", why);
}

std::optional<std::string> DoubtOfCameras(const SweepPlan& plan) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < std::min(kMostRuns, plan.runs.size()); ++i) {
    try {
      for (std::string& doubt : DoubtsOfCamera(plan.OptionsOf(plan.runs[i]).sensor)) {
        const bool is_new = std::find(found.begin(), found.end(), doubt) == found.end();
        if (is_new) found.push_back(std::move(doubt));
      }
    } catch (const InputError&) {  // invalid camera: the run fails with its reason
    }
  }
  if (found.empty()) return {};
  const std::string more =
      found.size() == 1 ? "" : fmt::format(" (the first of {} such warnings)", found.size());
  return fmt::format("{}: {}{}", plan.title, found.front(), more);
}

std::vector<std::string> DoubtsOfLoneSeeds(const std::vector<SweepAxis>& axes) {
  std::vector<std::string> doubts;
  for (const SweepAxis& axis : axes) {
    if (!axis.is_lone || !axis.IsSeed()) continue;
    const std::string& value = axis.values.front().front();
    const auto number = ParseNumber(value);
    const bool may_be_count = number && *number >= 2.0 && *number <= kMostSweepRuns;
    if (!may_be_count) continue;
    doubts.push_back(
        fmt::format("{0}: axis '{1}' is the one seed {2}: write {{seeds: {2}}} where {2} seeds are "
                    "meant, [{2}] where not",
                    axis.place, axis.keys.front(), value));
  }
  return doubts;
}

std::optional<std::string> DoubtOfStop(const SweepPlan& plan, const std::string& place) {
  const std::size_t seeds = plan.runs.size() / static_cast<std::size_t>(plan.point_count);
  const auto least = static_cast<std::size_t>(plan.stop.min_seeds);
  if (!plan.stop.Enabled() || seeds > least) return {};
  return fmt::format(
      "{}: stop has no effect: min_seeds is {}, must be below the {} that a point has over the "
      "seeds",
      place, least, Counted(seeds, "run"));
}

std::vector<std::string> DoubtsOfAxisKeys(const SweepPlan& plan, const Config& fixed,
                                          const std::vector<std::string>& set) {
  std::vector<std::string> doubts;
  const auto check = [&](const Config& one, const std::string& given) {
    for (const std::string& key : plan.parameter_keys) {
      if (!one.Has(key)) continue;
      doubts.push_back(
          fmt::format("{}: has no effect because {} is an axis of the sweep", given, key));
    }
  };
  for (const ConfigEntry& entry : fixed.Entries()) {
    Config one;
    one.Set(entry.key, entry.text, entry.place);
    check(one, entry.place + ": " + entry.key);
  }
  for (const std::string& assignment : set) {
    Config one;
    one.Set(assignment);
    check(one, "--set " + assignment);
  }
  return doubts;
}

// Runs end in any order; the first in the plan's order is kept.
void RunDoubts::Kind::Add(int run, const std::string& doubt) {
  if (runs++ > 0 && run > first) return;
  first = run;
  of_first = doubt;
}

void RunDoubts::Add(const PlannedRun& run, const OccupancyMap& map, const TruthRecord& truth,
                    const ExperimentOptions& options) {
  if (const auto doubt = DoubtOfTruth(truth, options)) truth_.Add(run.run, *doubt);
  if (!HasFree(StatesOf(map))) map_.Add(run.run, "the map has no free cell");
}

std::vector<std::string> RunDoubts::Lines(const SweepPlan& plan) const {
  std::vector<std::string> lines;
  for (const Kind& kind : {truth_, map_}) {
    if (kind.runs == 0) continue;
    const PlannedRun& run = plan.runs[static_cast<std::size_t>(kind.first)];
    std::vector<std::string> values;
    for (std::size_t k = 0; k < plan.parameter_keys.size(); ++k) {
      values.push_back(plan.parameter_keys[k] + "=" + run.values[k]);
    }
    lines.push_back(fmt::format("{}: {} of {}, the first with {}: {}", plan.title, kind.runs,
                                Counted(plan.runs.size(), "run"), fmt::join(values, ", "),
                                kind.of_first));
  }
  return lines;
}

std::optional<std::string> DoubtOfProfiles(const std::string& name, const Config& experiment,
                                           const Config& fixed,
                                           const std::vector<SweepAxis>& axes) {
  Config changes = fixed;
  std::vector<std::string> profiles;
  if (changes.Has("slam.profile")) profiles = {changes.Text("slam.profile")};
  for (const SweepAxis& axis : axes) {
    for (std::size_t i = 0; i < axis.keys.size(); ++i) {
      const bool is_profile = axis.keys[i] == "slam.profile";
      if (is_profile) profiles.clear();
      for (const auto& value : axis.values) {
        if (is_profile) profiles.push_back(value[i]);
      }
      changes.Set(axis.keys[i], axis.values.empty() ? "0" : axis.values.front()[i], axis.place);
    }
  }
  const std::vector<std::string> kept = KeptBesideProfile(experiment, changes, profiles);
  if (kept.empty()) return {};
  return fmt::format("{}: its own values of {} are kept with slam.profile={}", name,
                     fmt::join(kept, ", "), fmt::join(profiles, ", "));
}

}  // namespace depthgrid
