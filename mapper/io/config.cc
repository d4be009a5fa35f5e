#include "mapper/io/config.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <sstream>

#include "mapper/core/error.h"
#include "mapper/io/config_text.h"
#include "mapper/io/file.h"

namespace depthgrid {

struct Config::Tree {
  YAML::Node root{YAML::NodeType::Map};
  std::string place;
};

namespace {

constexpr std::size_t kMaxConfigBytes = 16U << 20U;

std::string FlowText(const YAML::Node& node) {
  YAML::Emitter emitter;
  emitter << YAML::Flow << node;
  return emitter.c_str();
}

std::string PlaceOf(const std::string& place, const YAML::Node& node) {
  // Nodes of a copied tree have no mark of their own; yaml-cpp gives them that of the first letter.
  const bool unmarked = node.Mark().pos <= 0;
  return unmarked ? place : fmt::format("{}:{}", place, node.Mark().line + 1);
}

void RequireUniqueKeys(const YAML::Node& node, const std::string& place) {
  if (node.IsSequence()) {
    for (const auto& item : node) RequireUniqueKeys(item, place);
  }
  if (!node.IsMap()) return;
  std::vector<std::string> seen;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) {
      throw InputError(PlaceOf(place, entry.first), "a key must be a plain word");
    }
    const auto key = entry.first.Scalar();
    for (const auto& other : seen) {
      if (other == key)
        throw InputError(PlaceOf(place, entry.first), "key '" + key + "' is given twice");
    }
    seen.push_back(key);
    RequireUniqueKeys(entry.second, place);
  }
}

YAML::Node Parse(const std::string& text, const std::string& place) {
  try {
    YAML::Node node = YAML::Load(text);
    return node;
  } catch (const YAML::Exception& e) {
    const std::string where =
        e.mark.is_null() ? place : fmt::format("{}:{}", place, e.mark.line + 1);
    throw InputError(where, "not valid YAML: " + e.msg);
  }
}

std::vector<std::string> SplitPath(const std::string& path) {
  std::vector<std::string> parts;
  std::stringstream stream(path);
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

class YamlReader final : public OptionsVisitor {
 public:
  YamlReader(const YAML::Node& root, std::string place) : place_(std::move(place)) {
    levels_.push_back({root, "", {}});
  }

  void Number(std::string_view key, double& value, Interval allowed, std::string_view) override {
    if (const YAML::Node node = Lookup(key); node.IsDefined()) value = NumberIn(node, key, allowed);
  }
  void Number(std::string_view key, int& value, Interval allowed, std::string_view) override {
    if (const YAML::Node node = Lookup(key); node.IsDefined()) {
      int number = 0;
      if (!node.IsScalar() || !YAML::convert<int>::decode(node, number))
        Fail(node, key, "a whole number");
      if (number < allowed.low || number > allowed.high) Fail(node, key, Shown(allowed));
      value = number;
    }
  }
  void Seed(std::string_view key, std::uint64_t& value, std::string_view) override {
    if (const YAML::Node node = Lookup(key); node.IsDefined()) {
      std::uint64_t number = 0;
      const bool negative = node.IsScalar() && node.Scalar().starts_with('-');
      if (!node.IsScalar() || negative || !YAML::convert<std::uint64_t>::decode(node, number)) {
        Fail(node, key, "a whole number, 0 or more");
      }
      value = number;
    }
  }
  void Flag(std::string_view key, bool& value, std::string_view) override {
    if (const YAML::Node node = Lookup(key); node.IsDefined()) {
      if (!node.IsScalar() || !YAML::convert<bool>::decode(node, value))
        Fail(node, key, "true or false");
    }
  }
  void Text(std::string_view key, std::string& value, std::string_view) override {
    if (const YAML::Node node = Lookup(key); node.IsDefined()) {
      if (!node.IsScalar()) Fail(node, key, "a text");
      value = node.Scalar();
    }
  }
  void Numbers(std::string_view key, std::vector<double>& values, Interval allowed,
               std::string_view) override {
    const YAML::Node node = Lookup(key);
    if (!node.IsDefined()) return;
    if (!node.IsSequence()) Fail(node, key, "a list of numbers");
    values.clear();
    for (const auto& item : node) values.push_back(NumberIn(item, key, allowed));
  }
  void Tuple(std::string_view key, std::span<double> values, Interval allowed,
             std::string_view) override {
    if (const YAML::Node node = Lookup(key); node.IsDefined()) {
      TupleIn(node, key, values, allowed);
    }
  }
  void Rows(std::string_view key, std::vector<double>& values, std::size_t width, Interval allowed,
            std::string_view) override {
    const YAML::Node node = Lookup(key);
    if (!node.IsDefined()) return;
    if (!node.IsSequence()) Fail(node, key, fmt::format("a list of lists of {} numbers", width));
    values.assign(width * node.size(), 0.0);
    for (std::size_t i = 0; i < node.size(); ++i) {
      TupleIn(node[i], key, std::span(values).subspan(i * width, width), allowed);
    }
  }
  void PerAxis(std::string_view key, std::array<double, 3>& values, Interval allowed,
               std::string_view) override {
    const YAML::Node node = Lookup(key);
    if (!node.IsDefined()) return;
    if (node.IsScalar()) {
      values.fill(NumberIn(node, key, allowed));
      return;
    }
    if (!node.IsSequence() || node.size() != 3)
      Fail(node, key, "one number or [forward, left, yaw]");
    for (std::size_t i = 0; i < 3; ++i) values[i] = NumberIn(node[i], key, allowed);
  }

  void RequireAllUsed() const { RequireUsed(levels_.back()); }

 protected:
  void ChoiceIndex(std::string_view key, int& index, const std::vector<std::string_view>& names,
                   std::string_view) override {
    const YAML::Node node = Lookup(key);
    if (!node.IsDefined()) return;
    for (std::size_t i = 0; node.IsScalar() && i < names.size(); ++i) {
      if (names[i] == node.Scalar()) {
        index = static_cast<int>(i);
        return;
      }
    }
    const std::string nearest =
        node.IsScalar() ? NearestWord(node.Scalar(), {names.begin(), names.end()}) : "";
    Fail(node, key,
         "one of " + Joined(names) + (nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
  }
  bool Begin(std::string_view key, std::string_view) override {
    const YAML::Node node = Lookup(key);
    if (!node.IsDefined()) return false;
    if (!node.IsMap()) Fail(node, key, "a map of keys");
    levels_.push_back({node, PathOf(key), {}});
    return true;
  }
  void End() override {
    RequireUsed(levels_.back());
    levels_.pop_back();
  }

 private:
  struct Level {
    YAML::Node node;
    std::string path;
    std::vector<std::string> known;
  };

  std::string PathOf(std::string_view key) const {
    const std::string& path = levels_.back().path;
    return path.empty() ? std::string(key) : path + "." + std::string(key);
  }
  YAML::Node Lookup(std::string_view key) {
    Level& level = levels_.back();
    level.known.emplace_back(key);
    return static_cast<const YAML::Node&>(level.node)[std::string(key)];
  }
  double NumberIn(const YAML::Node& node, std::string_view key, const Interval& allowed) const {
    double number = 0.0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, number))
      Fail(node, key, "a number");
    if (!std::isfinite(number) || number < allowed.low || number > allowed.high) {
      Fail(node, key, Shown(allowed));
    }
    return number;
  }
  void TupleIn(const YAML::Node& node, std::string_view key, std::span<double> values,
               const Interval& allowed) const {
    if (!node.IsSequence() || node.size() != values.size()) {
      Fail(node, key, fmt::format("a list of {} numbers", values.size()));
    }
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = NumberIn(node[i], key, allowed);
  }
  [[noreturn]] void Fail(const YAML::Node& node, std::string_view key,
                         const std::string& rule) const {
    throw InputError(PlaceOf(place_, node),
                     fmt::format("{} is '{}', must be {}", PathOf(key), FlowText(node), rule));
  }
  void RequireUsed(const Level& level) const {
    for (const auto& entry : level.node) {
      const auto key = entry.first.Scalar();
      bool used = false;
      for (const auto& known : level.known) used = used || known == key;
      if (used) continue;
      const std::string nearest = NearestWord(key, level.known);
      const std::string prefix = level.path.empty() ? "" : level.path + ".";
      throw InputError(
          PlaceOf(place_, entry.first),
          fmt::format("unknown key '{}{}'{}", prefix, key,
                      nearest.empty() ? "" : ", did you mean '" + prefix + nearest + "'?"));
    }
  }

  std::string place_;
  std::vector<Level> levels_;
};

}  // namespace

Config::Config() : tree_(std::make_unique<Tree>()) {}
Config::Config(std::unique_ptr<Tree> tree) : tree_(std::move(tree)) {}
Config::Config(Config&&) noexcept = default;
Config& Config::operator=(Config&&) noexcept = default;
Config::Config(const Config& other) : tree_(std::make_unique<Tree>()) {
  tree_->root = YAML::Clone(other.tree_->root);
  tree_->place = other.tree_->place;
}
Config& Config::operator=(const Config& other) {
  if (this != &other) *this = Config(other);
  return *this;
}
Config::~Config() = default;

Config Config::FromFile(const std::string& path) {
  return FromText(ReadFile(path, kMaxConfigBytes), path);
}

Config Config::FromText(const std::string& text, const std::string& place) {
  auto tree = std::make_unique<Tree>();
  tree->place = place;
  tree->root = Parse(text, place);
  if (tree->root.IsNull()) throw InputError(place, "is empty");
  if (!tree->root.IsMap()) throw InputError(place, "must be a map of keys");
  RequireUniqueKeys(tree->root, place);
  return Config(std::move(tree));
}

void Config::Set(const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("--set " + assignment, "must have the form key.path=value");
  }
  Set(assignment.substr(0, equals), assignment.substr(equals + 1));
}

void Config::Set(const std::string& key_path, const std::string& yaml_value) {
  const std::string place = "--set " + key_path + "=" + yaml_value;
  const YAML::Node value = Parse(yaml_value, place);
  const auto parts = SplitPath(key_path);
  YAML::Node node = tree_->root;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty()) throw InputError(place, "must have the form key.path=value");
    if (i + 1 == parts.size()) {
      node[parts[i]] = value;
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
  const YAML::Node node = Find(tree_->root, key);
  if (node.IsDefined()) {
    if (!node.IsMap())
      throw InputError(PlaceOf(tree_->place, node), "'" + key + "' must be a map of keys");
    taken->root = node;
    tree_->root.remove(key);
  }
  return Config(std::move(taken));
}

std::vector<Config> Config::TakeMaps(const std::string& key) {
  std::vector<Config> maps;
  const YAML::Node node = Find(tree_->root, key);
  if (!node.IsDefined()) return maps;
  if (!node.IsSequence()) {
    throw InputError(PlaceOf(tree_->place, node), "'" + key + "' must be a list");
  }
  for (const auto& item : node) {
    if (!YAML::Node(item).IsMap()) {
      throw InputError(PlaceOf(tree_->place, item), "each item of '" + key + "' must be a map");
    }
    auto taken = std::make_unique<Tree>();
    taken->place = tree_->place;
    taken->root = YAML::Node(item);
    maps.push_back(Config(std::move(taken)));
  }
  tree_->root.remove(key);
  return maps;
}

std::string Config::Place() const { return PlaceOf(tree_->place, tree_->root); }

bool Config::Has(const std::string& key_path) const {
  return Find(tree_->root, key_path).IsDefined();
}

Config Config::Only(const std::vector<std::string>& keys) const {
  auto kept = std::make_unique<Tree>();
  kept->place = tree_->place;
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
  if (!node.IsDefined()) throw InputError(tree_->place, "key '" + key_path + "' is missing");
  if (!node.IsSequence()) return {FlowText(node)};
  std::vector<std::string> items;
  for (const auto& item : node) items.push_back(FlowText(item));
  return items;
}

std::string Config::ToYaml() const {
  YAML::Emitter emitter;
  emitter << tree_->root;
  return std::string(emitter.c_str()) + "\n";
}

std::unique_ptr<OptionsVisitor> Config::Reader() const {
  return std::make_unique<YamlReader>(tree_->root, tree_->place);
}

void Config::FinishReading(OptionsVisitor& reader) {
  static_cast<YamlReader&>(reader).RequireAllUsed();
}

}  // namespace depthgrid
