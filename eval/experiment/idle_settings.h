// Finds settings without effect because of others (a gain that is learnt, the range of a laser with
// depth images), with reasons, and makes the warnings about them.
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
// For a recording of this format. `input_is`: the reason that follows from the format, "seq is a
// TUM RGB-D folder". `with_loops`: whether loops were given.
IdleSettingList IdleSettings(const SequenceOptions& options, SequenceFormat format,
                             const std::string& input_is, bool with_loops);

// Those of `a` that are idle in `b` as well, with the reasons in `a`.
IdleSettingList InBoth(const IdleSettingList& a, const IdleSettingList& b);

// Sets options without effect to their defaults; the result is the same.
ExperimentOptions WithoutIdleSettings(ExperimentOptions options);

// Keys that set others: the SLAM profile, the loop scenario.
bool IsPreset(const std::string& key);
// Why such a key sets nothing; empty if it does, or if it is the same without. `with` and `without`
// it: all effective keys as YAML.
std::string WhyPresetIsIdle(const std::string& key, const std::string& with,
                            const std::string& without);

// Warnings about overrides (--set) without effect, one line each. `settings_with` returns all
// effective keys as YAML with some of the overrides; an override that changes no key is not
// reported.
using SettingsWith = std::function<std::string(const std::vector<std::string>& set)>;
std::vector<std::string> DoubtsOfOverrides(const std::vector<std::string>& set,
                                           const IdleSettingList& idle,
                                           const SettingsWith& settings_with);

// Warnings about an experiment file's settings without effect, one line each: values other than the
// defaults that the file itself makes idle (`alone` reads it), regardless of overrides. Empty for a
// run.yaml, which states everything. `is_overridden`: keys that are not determined by the file.
using IsOverridden = std::function<bool(const std::string& key)>;
std::vector<std::string> DoubtsOfFile(const Config& file, const IdleSettingList& idle,
                                      const std::function<ExperimentOptions()>& alone,
                                      const IsOverridden& is_overridden);

}  // namespace depthgrid
