#include "mapper/io/config.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>

#include "mapper/core/error.h"
#include "mapper/io/config_text.h"
#include "mapper/io/config_tree_impl.h"
#include "mapper/io/file.h"
#include "mapper/io/yaml_text_impl.h"

namespace depthgrid {

namespace {

constexpr std::size_t kMaxConfigBytes = 16U << 20U;

// "a." has an empty last part, which matches no key.
std::vector<std::string> SplitPath(const std::string& path) {
  std::vector<std::string> parts;
  std::stringstream stream(path + ".");
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

// Navigation without creating nodes: yaml-cpp's operator[] on a non-const node inserts.
YAML::Node Find(const YAML::Node& root, const std::string& key_path) {
  YAML::Node node = root;
  for (const auto& part : SplitPath(key_path)) {
    if (!node.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
    const YAML::Node child = static_cast<const YAML::Node&>(node)[part];
    if (!child.IsDefined()) return YAML::Node(YAML::NodeType::Undefined);
    node.reset(child);
  }
  return node;
}

// Without splitting at dots, which user-chosen names (of paths, materials) may contain.
YAML::Node FindTopLevel(const YAML::Node& root, const std::string& key) {
  return root.IsMap() ? root[key] : YAML::Node(YAML::NodeType::Undefined);
}

}  // namespace

const ConfigOverride* Config::Tree::GivenBefore(const std::string& key_path) const {
  const bool is_there = Find(root, key_path).IsDefined();
  for (const ConfigOverride& set : overrides) {
    // A key may be added to a group that was set as a whole if it lacks the key.
    const bool lost = set.key_path == key_path || set.key_path.starts_with(key_path + ".");
    const bool replaced = is_there && key_path.starts_with(set.key_path + ".");
    if (set.by_user && (lost || replaced)) return &set;
  }
  return nullptr;
}

Config::Config() : tree_(std::make_unique<Tree>()) {}
Config::Config(std::unique_ptr<Tree> tree) : tree_(std::move(tree)) {}
Config::Config(Config&&) noexcept = default;
Config& Config::operator=(Config&&) noexcept = default;
Config::Config(const Config& other) : tree_(std::make_unique<Tree>()) {
  tree_->root = YAML::Clone(other.tree_->root);
  tree_->place = other.tree_->place;
  tree_->subject = other.tree_->subject;
  tree_->within = other.tree_->within;
  tree_->overrides = other.tree_->overrides;
}
Config& Config::operator=(const Config& other) {
  if (this != &other) *this = Config(other);
  return *this;
}
Config::~Config() = default;

Config Config::FromFile(const std::string& path) {
  return FromText(ReadTextFile(path, kMaxConfigBytes), path);
}

Config Config::FromText(const std::string& text, const std::string& place) {
  const std::string other = OtherTextThanKeys(text);
  if (!other.empty()) throw InputError(place, other);
  auto tree = std::make_unique<Tree>();
  tree->place = place;
  tree->root = ParseYaml(text, place);
  if (tree->root.IsNull()) throw InputError(place, "is empty");
  if (!tree->root.IsMap()) {
    throw InputError(place, "is not YAML with keys, must be 'key: value' lines");
  }
  return Config(std::move(tree));
}

void Config::Set(const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("--set " + assignment, "must have the form key.path=value");
  }
  const std::string key_path = assignment.substr(0, equals);
  if (const ConfigOverride* before = tree_->GivenBefore(key_path)) {
    throw InputError("--set " + assignment, fmt::format("key '{}' is given twice, by {} as well",
                                                        key_path, before->place));
  }
  Set(key_path, assignment.substr(equals + 1));
  tree_->overrides.back().by_user = true;
}

void Config::Set(const std::string& key_path, const std::string& yaml_value,
                 const std::string& given_place) {
  const std::string place =
      given_place.empty() ? "--set " + key_path + "=" + yaml_value : given_place;
  const YAML::Node value = ParseYamlValue(yaml_value, place);
  const auto parts = SplitPath(key_path);
  if (parts.size() > kMaxYamlDepth) {
    throw InputError(place, fmt::format("keys are nested deeper than {}", kMaxYamlDepth));
  }
  YAML::Node node = tree_->root;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty()) {
      throw InputError(place, fmt::format("'{}' is no key: a name in it is empty", key_path));
    }
    if (i + 1 == parts.size()) {
      node[parts[i]] = value;
      tree_->overrides.push_back({key_path, place});
      return;
    }
    YAML::Node child = node[parts[i]];
    if (!child.IsDefined() || child.IsNull()) {
      node[parts[i]] = YAML::Node(YAML::NodeType::Map);
      child.reset(node[parts[i]]);
    }
    if (!child.IsMap()) throw InputError(place, "'" + parts[i] + "' is not a group of keys");
    node.reset(child);
  }
}

Config Config::Take(const std::string& key) {
  auto taken = std::make_unique<Tree>();
  taken->place = tree_->place;
  taken->within = tree_->WholePath(key);
  const YAML::Node node = FindTopLevel(tree_->root, key);
  if (node.IsDefined()) {
    if (!node.IsMap())
      throw InputError(tree_->At(node.Mark()), "'" + taken->within + "' must be a map of keys");
    taken->root.reset(node);
    taken->overrides = tree_->OverridesBelow(key);
    tree_->root.remove(key);
  }
  return Config(std::move(taken));
}

void Config::NameSubject(const std::string& subject) {
  tree_->subject = subject;
  tree_->within.clear();
}

std::vector<Config> Config::TakeMaps(const std::string& key) {
  std::vector<Config> maps;
  const YAML::Node node = FindTopLevel(tree_->root, key);
  if (!node.IsDefined()) return maps;
  if (!node.IsSequence()) {
    throw InputError(tree_->At(node.Mark()), "'" + tree_->WholePath(key) + "' must be a list");
  }
  for (const auto& item : node) {
    if (!YAML::Node(item).IsMap()) {
      throw InputError(tree_->At(item.Mark()),
                       "each item of '" + tree_->WholePath(key) + "' must be a map");
    }
    auto taken = std::make_unique<Tree>();
    taken->place = tree_->place;
    taken->subject = tree_->subject;
    taken->root.reset(item);
    maps.push_back(Config(std::move(taken)));
  }
  tree_->root.remove(key);
  return maps;
}

std::string Config::Place() const { return tree_->At(tree_->root.Mark()); }

std::string Config::PlaceOfKey(const std::string& key_path) const {
  const YAML::Node node = Find(tree_->root, key_path);
  return tree_->PlaceOfKey(key_path, (node.IsDefined() ? node : tree_->root).Mark());
}

std::string PlaceOfKey(const std::vector<const Config*>& layers, const std::string& key_path) {
  for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
    if ((*layer)->Has(key_path)) return (*layer)->PlaceOfKey(key_path);
  }
  return "";
}

bool Config::Has(const std::string& key_path) const {
  return Find(tree_->root, key_path).IsDefined();
}

bool Config::HasList(const std::string& key_path) const {
  return Find(tree_->root, key_path).IsSequence();
}

Config Config::Only(const std::vector<std::string>& keys) const {
  auto kept = std::make_unique<Tree>();
  kept->place = tree_->place;
  kept->subject = tree_->subject;
  kept->within = tree_->within;
  kept->overrides = tree_->overrides;
  for (const auto& entry : tree_->root) {
    if (std::find(keys.begin(), keys.end(), entry.first.Scalar()) != keys.end()) {
      kept->root.force_insert(entry.first, entry.second);
    }
  }
  return Config(std::move(kept));
}

std::vector<std::string> Config::Keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : tree_->root) keys.push_back(entry.first.Scalar());
  return keys;
}

std::vector<std::string> Config::List(const std::string& key_path) const {
  const YAML::Node node = Find(tree_->root, key_path);
  if (!node.IsDefined()) {
    throw InputError(tree_->place, "key '" + tree_->WholePath(key_path) + "' is missing");
  }
  if (!node.IsSequence()) return {FlowText(node)};
  std::vector<std::string> items;
  for (const auto& item : node) items.push_back(FlowText(item));
  return items;
}

std::string Config::Text(const std::string& key_path, const std::string& otherwise) const {
  const YAML::Node node = Find(tree_->root, key_path);
  return node.IsDefined() ? TextIn(*tree_, key_path, node) : otherwise;
}

std::vector<std::string> Config::Texts(const std::string& key_path) const {
  const YAML::Node node = Find(tree_->root, key_path);
  if (!node.IsDefined()) return {};
  if (!node.IsSequence()) return {TextIn(*tree_, key_path, node)};
  std::vector<std::string> texts;
  for (const auto& item : node) texts.push_back(TextIn(*tree_, key_path, item));
  return texts;
}

std::string Config::ToYaml() const {
  YAML::Emitter emitter;
  emitter << tree_->root;
  return std::string(emitter.c_str()) + "\n";
}

std::unique_ptr<OptionsVisitor> Config::Reader(
    std::function<std::vector<std::string>()> all_keys) const {
  return MakeYamlReader(*tree_, std::move(all_keys));
}

void Config::FinishReading(OptionsVisitor& reader) { RequireAllKeysUsed(reader); }

}  // namespace depthgrid
