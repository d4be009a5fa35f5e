#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <functional>
#include <utility>

#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "mapper/io/config_text.h"

namespace depthgrid {
namespace {

std::string Shown(double value) { return fmt::format("{}", value); }

std::string NameAt(const std::vector<std::string_view>& names, int index) {
  Require(index >= 0, "what is written has a name");
  return std::string(names[static_cast<std::size_t>(index)]);
}

// Writes two-space indented YAML; numbers in the shortest form that parses to the same double.
class YamlWriter final : public OptionsVisitor {
 public:
  explicit YamlWriter(std::string& out) : out_(out) {}

  void Number(std::string_view key, double& value, Interval, std::string_view) override {
    Line(key, Shown(value));
  }
  void Number(std::string_view key, int& value, Interval, std::string_view) override {
    Line(key, fmt::format("{}", value));
  }
  void Seed(std::string_view key, std::uint64_t& value, std::string_view) override {
    Line(key, fmt::format("{}", value));
  }
  void Flag(std::string_view key, bool& value, std::string_view) override {
    Line(key, value ? "true" : "false");
  }
  void Text(std::string_view key, std::string& value, std::string_view) override {
    YAML::Emitter emitter;
    emitter << YAML::Node(value);
    Line(key, value.empty() ? "\"\"" : emitter.c_str());
  }
  void Numbers(std::string_view key, std::vector<double>& values, Interval,
               std::string_view) override {
    Line(key, fmt::format("[{}]", fmt::join(values, ", ")));
  }
  void Tuple(std::string_view key, std::span<double> values, Interval, std::string_view) override {
    Line(key, fmt::format("[{}]", fmt::join(values, ", ")));
  }
  void Rows(std::string_view key, std::vector<double>& values, std::size_t width, Interval,
            std::string_view) override {
    std::string rows;
    for (std::size_t i = 0; i < values.size(); i += width) {
      rows += fmt::format("{}[{}]", i == 0 ? "" : ", ",
                          fmt::join(std::span(values).subspan(i, width), ", "));
    }
    Line(key, "[" + rows + "]");
  }
  void PerAxis(std::string_view key, std::array<double, 3>& values, Interval,
               std::string_view) override {
    const bool same = values[0] == values[1] && values[1] == values[2];
    Line(key, same ? Shown(values[0]) : fmt::format("[{}]", fmt::join(values, ", ")));
  }

 protected:
  void ChoiceIndex(std::string_view key, int& index, const std::vector<std::string_view>& names,
                   std::string_view) override {
    Line(key, NameAt(names, index));
  }
  bool Begin(std::string_view key, std::string_view) override {
    out_ += fmt::format("{:{}}{}:\n", "", 2 * depth_, key);
    ++depth_;
    return true;
  }
  void End() override { --depth_; }

 private:
  void Line(std::string_view key, const std::string& value) {
    out_ += fmt::format("{:{}}{}: {}\n", "", 2 * depth_, key, value);
  }
  std::string& out_;
  int depth_ = 0;
};

constexpr const char* kWhole = "whole";

// Called with the description of each key.
using KeyLine = std::function<void(const std::string& path, const std::string& value,
                                   const std::string& allowed, std::string_view meaning)>;

class KeyLister final : public OptionsVisitor {
 public:
  // `only`: a key path, to skip the groups it is not in.
  explicit KeyLister(KeyLine line, std::string only = "")
      : line_(std::move(line)), only_(std::move(only)) {}

  void Number(std::string_view key, double& value, Interval allowed,
              std::string_view meaning) override {
    Line(key, Shown(value), Shown(allowed), meaning);
  }
  void Number(std::string_view key, int& value, Interval allowed,
              std::string_view meaning) override {
    Line(key, fmt::format("{}", value), fmt::format("{}, {}", kWhole, Shown(allowed)), meaning);
  }
  void Seed(std::string_view key, std::uint64_t& value, std::string_view meaning) override {
    Line(key, fmt::format("{}", value), fmt::format("{}, at least 0", kWhole), meaning);
  }
  void Flag(std::string_view key, bool& value, std::string_view meaning) override {
    Line(key, value ? "true" : "false", "true or false", meaning);
  }
  void Text(std::string_view key, std::string& value, std::string_view meaning) override {
    Line(key, value.empty() ? "\"\"" : value, "text", meaning);
  }
  void Numbers(std::string_view key, std::vector<double>& values, Interval allowed,
               std::string_view meaning) override {
    Line(key, fmt::format("[{}]", fmt::join(values, ", ")), "list, each " + Shown(allowed),
         meaning);
  }
  void Tuple(std::string_view key, std::span<double> values, Interval allowed,
             std::string_view meaning) override {
    Line(key, fmt::format("[{}]", fmt::join(values, ", ")),
         fmt::format("{} numbers, each {}", values.size(), Shown(allowed)), meaning);
  }
  void Rows(std::string_view key, std::vector<double>&, std::size_t width, Interval allowed,
            std::string_view meaning) override {
    Line(key, "[]", fmt::format("list of lists of {} numbers, each {}", width, Shown(allowed)),
         meaning);
  }
  void PerAxis(std::string_view key, std::array<double, 3>& values, Interval allowed,
               std::string_view meaning) override {
    Line(key, Shown(values[0]), Shown(allowed) + ", or [forward, left, yaw]", meaning);
  }

 protected:
  void ChoiceIndex(std::string_view key, int& index, const std::vector<std::string_view>& names,
                   std::string_view meaning) override {
    Line(key, NameAt(names, index), "one of " + Joined(names), meaning);
  }
  bool Begin(std::string_view key, std::string_view) override {
    path_.push_back(std::string(key) + ".");
    if (only_.empty() || only_.starts_with(fmt::format("{}", fmt::join(path_, "")))) return true;
    path_.pop_back();
    return false;
  }
  void End() override { path_.pop_back(); }

 private:
  void Line(std::string_view key, const std::string& value, const std::string& allowed,
            std::string_view meaning) {
    line_(fmt::format("{}{}", fmt::join(path_, ""), key), value, allowed, meaning);
  }
  KeyLine line_;
  std::string only_;
  std::vector<std::string> path_;
};

}  // namespace

namespace internal {
std::unique_ptr<OptionsVisitor> MakeYamlWriter(std::string& out) {
  return std::make_unique<YamlWriter>(out);
}
std::unique_ptr<OptionsVisitor> MakeKeyLister(std::string& out) {
  return std::make_unique<KeyLister>([&out](const std::string& path, const std::string& value,
                                            const std::string& allowed, std::string_view meaning) {
    out += fmt::format("{} = {} ({}): {}\n", path, value, allowed, meaning);
  });
}
std::unique_ptr<OptionsVisitor> MakeKeyPathLister(std::vector<std::string>& out) {
  return std::make_unique<KeyLister>([&out](const std::string& path, const std::string&,
                                            const std::string&,
                                            std::string_view) { out.push_back(path); });
}
std::unique_ptr<OptionsVisitor> MakeValueFinder(const std::string& key_path, std::string& out) {
  return std::make_unique<KeyLister>(
      [&out, key_path](const std::string& path, const std::string& value, const std::string&,
                       std::string_view) {
        if (path == key_path) out = value;
      },
      key_path);
}
std::unique_ptr<OptionsVisitor> MakeWholeFinder(const std::string& key_path, bool& is_whole) {
  return std::make_unique<KeyLister>(
      [&is_whole, key_path](const std::string& path, const std::string&, const std::string& allowed,
                            std::string_view) {
        if (path == key_path) is_whole = allowed.starts_with(kWhole);
      },
      key_path);
}
}  // namespace internal

}  // namespace depthgrid
