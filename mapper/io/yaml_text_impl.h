// YAML text as a tree, within bounds: the one door through which YAML comes in
// (mapper/io/config.h).
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace depthgrid {

// Groups in groups: far above any settings, far below what the stack carries.
inline constexpr int kMaxYamlDepth = 100;

// Throws InputError, naming `place` and the line, for text that is not YAML, an alias (`*name`), a
// key that is no plain word or is given twice, values nested deeper than kMaxYamlDepth, and more
// than a million values.
YAML::Node ParseYaml(const std::string& text, const std::string& place);
// The same of the value of one key, given beside it.
YAML::Node ParseYamlValue(const std::string& text, const std::string& place);

// "place:line", or the place alone where the line is not known.
std::string PlaceOf(const std::string& place, const YAML::Mark& mark);

// Where a key of a map stands. That of the first one of a text looks to PlaceOf as if its line were
// not known; its value, which is behind it, tells that it is.
YAML::Mark MarkOfKey(const YAML::Node& key, const YAML::Node& value);

}  // namespace depthgrid
