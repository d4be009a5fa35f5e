// Settings that all runs of one side of a comparison share, and in which the two sides may differ.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "eval/compare/comparison.h"

namespace depthgrid {

// Keys that determine what is seen: runs that differ in them cannot be a pair. Seeds among them.
bool MakesPairs(const std::string& key);

// Whether one of the conditions is on this axis.
bool NamesKey(const std::vector<Condition>& where, const std::string& key);

struct FixedSettings {
  std::vector<std::pair<std::string, std::string>> values;  // by key path, in the order of the file
  std::vector<std::string> given;  // of these, set by a file or the command line (sweeps only)

  // Null if the key is not fixed.
  const std::string* Find(const std::string& key) const;
};

// Of a sweep, its experiment without the axes; of a folder of runs, what all their run.yaml share.
FixedSettings FixedSettingsOf(const SweepResults& table);

// Makes a fixed key an axis with a single value where a condition names it, or where it determines
// what is seen and is an axis of the other side. Throws InputError where both sides fix such a key
// at different values and no condition names it, or where a room or path was changed in between.
void AlignFixedSettings(const CompareOptions& options, SweepResults& a, SweepResults& b);

// The settings that are fixed on both sides at different values. Those that only follow from
// another one (SLAM's from its profile) are left out.
std::vector<DifferentSetting> FixedDifferences(const FixedSettings& a, const FixedSettings& b);

}  // namespace depthgrid
