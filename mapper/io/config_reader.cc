#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "mapper/core/error.h"
#include "mapper/core/plus_sign.h"
#include "mapper/io/config_text.h"
#include "mapper/io/config_tree_impl.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/yaml_text_impl.h"

namespace depthgrid {
namespace {

// Longer lists do not help in a one-line message.
constexpr std::size_t kMostListed = 12;

class YamlReader final : public OptionsVisitor {
 public:
  YamlReader(const Config::Tree& tree, std::function<std::vector<std::string>()> all_keys)
      : tree_(tree), all_keys_(std::move(all_keys)) {
    levels_.push_back({tree.root, "", {}});
  }

  void Number(std::string_view key, double& value, Interval allowed, std::string_view) override {
    if (const YAML::Node node = Lookup(key); node.IsDefined()) value = NumberIn(node, key, allowed);
  }
  void Number(std::string_view key, int& value, Interval allowed, std::string_view) override {
    if (const YAML::Node node = Lookup(key); node.IsDefined()) {
      int number = 0;
      if (!WholeIn(node, key, number)) Fail(node, key, "a whole number");
      if (number < allowed.low || number > allowed.high) Fail(node, key, Shown(allowed));
      value = number;
    }
  }
  void Seed(std::string_view key, std::uint64_t& value, std::string_view) override {
    if (const YAML::Node node = Lookup(key); node.IsDefined()) {
      std::uint64_t number = 0;
      if (!WholeIn(node, key, number)) {
        Fail(node, key, fmt::format("a whole number from 0 to {}", UINT64_MAX));
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
      value = TextIn(tree_, PathOf(key), node);
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
  // Rejects numbers that other programs would read differently.
  void RequireDecimal(const YAML::Node& node, std::string_view key) const {
    if (HasLeadingZero(node.Scalar())) {
      Fail(node, key, "a decimal number without leading zeros");
    }
  }
  template <typename Whole>
  bool WholeIn(const YAML::Node& node, std::string_view key, Whole& number) const {
    if (!node.IsScalar()) return false;
    RequireDecimal(node, key);
    const std::string_view text = WithoutPlus(node.Scalar());
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && stop == end;
  }
  double NumberIn(const YAML::Node& node, std::string_view key, const Interval& allowed) const {
    double number = 0.0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, number))
      Fail(node, key, "a number");
    RequireDecimal(node, key);
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
    FailValue(tree_, PathOf(key), node, rule);
  }
  void RequireUsed(const Level& level) const {
    for (const auto& entry : level.node) {
      const auto key = entry.first.Scalar();
      bool used = false;
      for (const auto& known : level.known) used = used || known == key;
      if (used) continue;
      const std::string prefix = level.path.empty() ? "" : level.path + ".";
      throw InputError(tree_.PlaceOfKey(prefix + key, MarkOfKey(entry.first, entry.second)),
                       fmt::format("unknown key '{}'{}", tree_.WholePath(prefix + Shortened(key)),
                                   Hint(prefix, key, entry.second, level.known)));
    }
  }
  // Suggests a group by its own name first, then keys of any group.
  std::string Hint(const std::string& prefix, const std::string& key, const YAML::Node& value,
                   const std::vector<std::string>& siblings) const {
    std::vector<std::string> paths = all_keys_();
    if (IsPathIn(paths, prefix + key)) return ", write it as " + Nested(key);
    for (std::string& known : paths) known = tree_.WholePath(known);
    const std::string path = tree_.WholePath(prefix + key + FirstPathIn(value));
    const std::string near_sibling = DidYouMean(key, siblings, tree_.WholePath(prefix));
    const std::string same = DidYouMeanKey(path, paths, false);
    if (!same.empty() && (near_sibling.empty() || !value.IsMap())) return same;
    if (!near_sibling.empty()) return near_sibling;
    const std::string near = DidYouMeanKey(path, paths, true);
    return near.empty() && siblings.size() <= kMostListed
               ? ", must be one of " + Joined({siblings.begin(), siblings.end()})
               : near;
  }
  // Whether the path is of a key or of a group of keys.
  static bool IsPathIn(const std::vector<std::string>& paths, const std::string& path) {
    return std::any_of(paths.begin(), paths.end(), [&](const std::string& known) {
      return known == path || known.starts_with(path + ".");
    });
  }
  // "slam: {loops: {recall: ...}}" of "slam.loops.recall".
  static std::string Nested(const std::string& path) {
    std::string opened, closed;
    for (const char letter : path) {
      if (letter == '.') closed += '}';
      opened += letter == '.' ? ": {" : std::string(1, letter);
    }
    return opened + ": ..." + closed;
  }
  static std::string FirstPathIn(YAML::Node node) {
    std::string path;
    while (node.IsMap() && node.size() > 0) {
      const auto first = *node.begin();
      path += "." + first.first.Scalar();
      node.reset(first.second);
    }
    return path;
  }

  const Config::Tree& tree_;
  std::function<std::vector<std::string>()> all_keys_;
  std::vector<Level> levels_;
};

}  // namespace

namespace {

// Sets the style per node, as the emitter uses each list's and map's own.
void WriteOnOneLine(YAML::Node node) {
  if (!node.IsSequence() && !node.IsMap()) return;
  node.SetStyle(YAML::EmitterStyle::Flow);
  for (const auto& item : node) WriteOnOneLine(node.IsMap() ? item.second : YAML::Node(item));
}

}  // namespace

std::string FlowText(const YAML::Node& node) {
  const bool is_word = !node.IsSequence() && !node.IsMap();
  const YAML::Node copy = is_word ? node : YAML::Clone(node);
  if (!is_word) WriteOnOneLine(copy);
  YAML::Emitter emitter;
  emitter << YAML::Flow << copy;
  return emitter.c_str();
}

namespace {

// For a key without a value yaml-cpp gives the mark of what follows; the key's mark is used
// instead.
YAML::Mark MarkOf(const Config::Tree& tree, const std::string& key_path, const YAML::Node& node) {
  YAML::Node group = tree.root;
  std::size_t begin = 0;
  while (node.IsNull() && group.IsMap()) {
    const std::size_t end = key_path.find('.', begin);
    const std::string key = key_path.substr(begin, end - begin);
    for (const auto& entry : group) {
      if (entry.first.Scalar() != key) continue;
      if (end == std::string::npos) return MarkOfKey(entry.first, entry.second);
      group.reset(entry.second);
      break;
    }
    if (end == std::string::npos) break;
    begin = end + 1;
  }
  return node.Mark();
}

}  // namespace

void FailValue(const Config::Tree& tree, const std::string& key_path, const YAML::Node& node,
               const std::string& rule) {
  constexpr std::size_t kMostLetters = 200;  // enough to recognise the value
  std::string text = FlowText(node);
  if (text.size() > kMostLetters) text.replace(kMostLetters, std::string::npos, "...");
  const std::string shown = node.IsNull() ? "empty" : "'" + text + "'";
  throw InputError(tree.PlaceOfKey(key_path, MarkOf(tree, key_path, node)),
                   fmt::format("{} is {}, must be {}", tree.WholePath(key_path), shown, rule));
}

std::string TextIn(const Config::Tree& tree, const std::string& key_path, const YAML::Node& node) {
  if (!node.IsScalar()) FailValue(tree, key_path, node, "a text");
  return node.Scalar();
}

std::string Config::Tree::PlaceOfKey(const std::string& key_path, const YAML::Mark& mark) const {
  const auto holds = [](const std::string& group, const std::string& key) {
    return group == key || key.starts_with(group + ".");
  };
  // The last assignment is in effect.
  for (auto set = overrides.rbegin(); set != overrides.rend(); ++set) {
    if (holds(set->key_path, key_path) || holds(key_path, set->key_path)) return set->place;
  }
  return At(mark);
}

std::string Config::Tree::At(const YAML::Mark& mark) const {
  return PlaceOf(place, mark) + (subject.empty() ? "" : ": " + subject);
}

std::vector<ConfigOverride> Config::Tree::OverridesBelow(const std::string& key) const {
  std::vector<ConfigOverride> below;
  for (const auto& set : overrides) {
    if (set.key_path.starts_with(key + ".")) {
      below.push_back({set.key_path.substr(key.size() + 1), set.place});
    }
  }
  return below;
}

std::unique_ptr<OptionsVisitor> MakeYamlReader(const Config::Tree& tree,
                                               std::function<std::vector<std::string>()> all_keys) {
  return std::make_unique<YamlReader>(tree, std::move(all_keys));
}

void RequireAllKeysUsed(OptionsVisitor& reader) {
  static_cast<YamlReader&>(reader).RequireAllUsed();
}

}  // namespace depthgrid
