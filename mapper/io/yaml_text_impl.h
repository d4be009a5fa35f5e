// Parses YAML text within limits; all YAML input goes through here (mapper/io/config.h).
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace depthgrid {

// Maximum nesting: far more than any settings need, far less than the stack allows.
inline constexpr int kMaxYamlDepth = 100;

// Throws InputError, naming `place` and the line, for text that is not YAML, an alias (`*name`), a
// key that is not a plain word or is given twice, values nested deeper than kMaxYamlDepth, and more
// than a million values.
YAML::Node ParseYaml(const std::string& text, const std::string& place);
// The same for the value of a single key, given separately.
YAML::Node ParseYamlValue(const std::string& text, const std::string& place);

// "place:line", or the place alone where the line is not known.
std::string PlaceOf(const std::string& place, const YAML::Mark& mark);

// The mark of a map's key. The mark of a text's first key is that of an unknown line to PlaceOf, so
// the value, which follows it, is used to tell the difference.
YAML::Mark MarkOfKey(const YAML::Node& key, const YAML::Node& value);

}  // namespace depthgrid
