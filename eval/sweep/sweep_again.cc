#include "eval/sweep/sweep_again.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "eval/experiment/shipped.h"
#include "eval/sweep/sweep_results.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

const char* NameOf(SweepMode mode) {
  return mode == SweepMode::kGrid ? "grid" : mode == SweepMode::kZip ? "zip" : "random";
}

// Values are already YAML, except those that a list would split or change: names of files may
// contain any character.
std::string InList(const std::string& text) {
  const bool is_plain = text.starts_with("[") ||
                        (!text.empty() && text.find_first_of(" ,:#{}[]&*!|>'\"%@`\\") == text.npos);
  if (is_plain) return text;
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    quoted += letter;
  }
  return quoted + "\"";
}

std::string ValueText(const std::string& key, const std::string& text, const std::string& folder) {
  if (!IsFileKey(key) || !IsFileName(text)) return InList(text);
  return InList(fs::absolute(fs::path(folder) / text).lexically_normal().string());
}

std::string RangeText(const AxisRange& range) {
  return fmt::format("{{from: {}, to: {}{}}}", range.from, range.to,
                     range.scale == RangeScale::kLog ? ", scale: log" : "");
}

std::string AxisText(const SweepAxis& axis, const std::string& folder) {
  if (axis.range) return RangeText(*axis.range);
  std::vector<std::string> values;
  for (const std::vector<std::string>& value : axis.values) {
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < axis.keys.size(); ++i) {
      parts.push_back(ValueText(axis.keys[i], value[i], folder));
    }
    const std::string all = fmt::format("{}", fmt::join(parts, ", "));
    values.push_back(parts.size() > 1 ? "[" + all + "]" : all);
  }
  return fmt::format("[{}]", fmt::join(values, ", "));
}

}  // namespace

std::string SweepAgainText(const SweepPlan& plan, SweepMode mode, int samples,
                           std::uint64_t sample_seed) {
  std::string text = fmt::format("experiment: ./experiment.yaml\nmode: {}\n", NameOf(mode));
  if (mode == SweepMode::kRandom) {
    text += fmt::format("samples: {}\nsample_seed: {}\n", samples, sample_seed);
  }
  if (plan.stop.Enabled()) {
    text += fmt::format("stop: {{metric: {}, width: {}, min_seeds: {}}}\n", plan.stop.metric,
                        plan.stop.width, plan.stop.min_seeds);
  }
  text += "axes:\n";
  for (const SweepAxis& axis : plan.axes) {
    text +=
        fmt::format("  \"{}\": {}\n", fmt::join(axis.keys, ", "), AxisText(axis, plan.base_folder));
  }
  return text;
}

}  // namespace depthgrid
