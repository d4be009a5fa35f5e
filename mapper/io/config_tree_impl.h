// The tree behind a Config, and how an options struct is filled from it (mapper/io/config.h).
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/io/config.h"

namespace depthgrid {

// A key that was set after the file was read, and the words that set it.
struct ConfigOverride {
  std::string key_path;
  std::string place;
  bool by_user = false;  // by an assignment such as --set has
};

struct Config::Tree {
  // Becomes part of another tree by reset(): an assignment copies the list of all nodes there are,
  // and took half of the time that reading a scene item by item takes.
  YAML::Node root{YAML::NodeType::Map};
  std::string place;
  std::string subject;  // what errors name behind file and line; may be empty
  std::string within;   // the key path of the root in its file, for errors: of a tree taken out
  std::vector<ConfigOverride> overrides;

  // A key path as it is in the file.
  std::string WholePath(const std::string& key_path) const {
    return within.empty() ? key_path : within + "." + key_path;
  }
  // The place of a node's mark, for errors: "file:line", and the subject.
  std::string At(const YAML::Mark& mark) const;
  // Where a value came from, for errors: the assignment that set it, or one that set the group of
  // keys it is in, else file and line.
  std::string PlaceOfKey(const std::string& key_path, const YAML::Mark& mark) const;
  // The assignment of a user's that has given a key already, or a group or a key of it; or null.
  const ConfigOverride* GivenBefore(const std::string& key_path) const;
  // The overrides inside the subtree of a key, their paths counted from there.
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
// Throws InputError for a key of the tree that a reader of MakeYamlReader was not asked for.
void RequireAllKeysUsed(OptionsVisitor& reader);

}  // namespace depthgrid
