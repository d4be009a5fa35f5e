// Settings that have no effect beside the others (a gain that is learnt, the range of a laser for
// depth images): which they are, why, and what to say to whoever set them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "eval/experiment/experiment_options.h"
#include "mapper/io/config.h"
#include "mapper/io/sequence.h"

namespace depthgrid {

struct IdleSetting {
  std::string key;     // or a group: all keys in it
  std::string reason;  // "mapper.fusion.mode is learned"
};
using IdleSettingList = std::vector<IdleSetting>;

// "GROUP.KEY is VALUE" of one of the options' own keys.
template <typename Options>
std::string Stands(const Options& options, const std::string& group, const std::string& key) {
  return group + "." + key + " is " + ValueOf(options, key);
}

IdleSettingList IdleSettings(const MapperOptions& mapper);
IdleSettingList IdleSettings(const ExperimentOptions& options);
// Of a recording of this kind. `input_is` is the reason that the kind gives: "seq is a TUM RGB-D
// folder". `with_loops`: loops were given for it.
IdleSettingList IdleSettings(const SequenceOptions& options, SequenceFormat format,
                             const std::string& input_is, bool with_loops);

// Those of `a` that are idle in `b` as well, with the reasons in `a`.
IdleSettingList InBoth(const IdleSettingList& a, const IdleSettingList& b);

// The same experiment for the same result: what has no effect is at its default.
ExperimentOptions WithoutIdleSettings(ExperimentOptions options);

// Keys that set others: the SLAM profile, the loop scenario.
bool IsPreset(const std::string& key);
// Why one of them sets nothing; empty where it does, or is the same without. `with` and `without`
// it: every effective key as YAML.
std::string WhyPresetIsIdle(const std::string& key, const std::string& with,
                            const std::string& without);

// What of the overrides (--set) is idle, a line each. `settings_with` gives every effective key as
// YAML with some of them: one that changes nothing at all is no mistake.
using SettingsWith = std::function<std::string(const std::vector<std::string>& set)>;
std::vector<std::string> DoubtsOfOverrides(const std::vector<std::string>& set,
                                           const IdleSettingList& idle,
                                           const SettingsWith& settings_with);

// What of an experiment's file is idle, a line each: values other than the defaults, and idle by
// what the file says itself (`alone` reads it), whatever was set besides. Nothing of a run.yaml,
// which states everything. `is_overridden` says which keys the file does not decide.
using IsOverridden = std::function<bool(const std::string& key)>;
std::vector<std::string> DoubtsOfFile(const Config& file, const IdleSettingList& idle,
                                      const std::function<ExperimentOptions()>& alone,
                                      const IsOverridden& is_overridden);

}  // namespace depthgrid
