// The tree of a Config and the reader that fills an options struct from it (mapper/io/config.h).
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/io/config.h"

namespace depthgrid {

// A key that was set after the file was read, and the assignment that set it.
struct ConfigOverride {
  std::string key_path;
  std::string place;
  bool by_user = false;  // by an assignment as of --set
};

struct Config::Tree {
  // Make it share another tree's node by reset(), not by assignment, which copies the list of all
  // nodes (half of the time of reading a scene).
  YAML::Node root{YAML::NodeType::Map};
  std::string place;
  std::string subject;  // named after file and line in errors; may be empty
  std::string within;   // for errors: the root's key path in its file, if taken out
  std::vector<ConfigOverride> overrides;

  // The full path in the file of a key path in this tree.
  std::string WholePath(const std::string& key_path) const {
    return within.empty() ? key_path : within + "." + key_path;
  }
  // The place of a node's mark, for errors: "file:line", and the subject.
  std::string At(const YAML::Mark& mark) const;
  // Where a value came from, for errors: the assignment that set it or its group of keys, else file
  // and line.
  std::string PlaceOfKey(const std::string& key_path, const YAML::Mark& mark) const;
  // An earlier user assignment of this key, of a group it is in or of a key in it; or null.
  const ConfigOverride* GivenBefore(const std::string& key_path) const;
  // The overrides within the subtree of a key, with paths relative to it.
  std::vector<ConfigOverride> OverridesBelow(const std::string& key) const;
};

// One value as YAML on one line.
std::string FlowText(const YAML::Node& node);
// The error of a value that breaks a rule: place, key, value and rule.
[[noreturn]] void FailValue(const Config::Tree& tree, const std::string& key_path,
                            const YAML::Node& node, const std::string& rule);
// Throws InputError for a list or a map.
std::string TextIn(const Config::Tree& tree, const std::string& key_path, const YAML::Node& node);

// Fills options from `tree`, which must outlive it. `all_keys`: their key paths, for errors.
std::unique_ptr<OptionsVisitor> MakeYamlReader(const Config::Tree& tree,
                                               std::function<std::vector<std::string>()> all_keys);
// Throws InputError for a key of the tree that was not read by a reader from MakeYamlReader.
void RequireAllKeysUsed(OptionsVisitor& reader);

}  // namespace depthgrid
