#include "mapper/io/config_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>

#include "mapper/io/config.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {

std::string Joined(const std::vector<std::string_view>& names) {
  std::string out;
  for (const auto& name : names) out += (out.empty() ? "" : ", ") + std::string(name);
  return out;
}

std::string OtherTextThanKeys(std::string_view text) {
  constexpr std::size_t kLooked = 4096;  // a row of a laser log may be longer
  const std::vector<TextRow> rows = SplitRows(text.substr(0, kLooked));
  if (rows.empty()) return "";
  const TextRow& first = rows.front();
  constexpr std::array<std::string_view, 6> kMessages = {"FLASER",    "RLASER", "ROBOTLASER1",
                                                         "RAWLASER1", "PARAM",  "ODOM"};
  if (first.fields.size() > 2 && std::ranges::find(kMessages, first.fields[0]) != kMessages.end()) {
    return "is a laser log, not YAML with keys; `depthgrid map` takes it";
  }
  constexpr std::size_t kColumns = 8;
  const auto is_number = [](std::string_view field) { return ParseNumber(field).has_value(); };
  if (first.fields.size() != kColumns || !std::ranges::all_of(first.fields, is_number)) return "";
  return "is a trajectory (rows of stamp x y z qx qy qz qw), not YAML with keys; `depthgrid eval "
         "trajectory` takes it, and --poses of `depthgrid map`";
}

namespace {

// Longer texts are not misspelt names and too slow to compare.
constexpr std::size_t kLongestName = 100;

// Optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbours.
std::size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> two_above, above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_above = std::move(above);
    above = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], two_above[j - 2] + 1);
      }
    }
  }
  return row.back();
}

}  // namespace

std::string NearestWord(const std::string& word, const std::vector<std::string>& candidates) {
  if (word.size() > kLongestName) return "";
  const auto begins_so = [&](const std::string& candidate) { return candidate.starts_with(word); };
  if (!word.empty() && std::ranges::count_if(candidates, begins_so) == 1) {
    return *std::ranges::find_if(candidates, begins_so);
  }
  std::string best;
  std::size_t best_distance = word.size() / 2 + 1;
  for (const auto& candidate : candidates) {
    const std::size_t distance = EditDistance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string Shortened(const std::string& word) {
  return word.size() > kLongestName ? word.substr(0, kLongestName) + "..." : word;
}

std::string DidYouMean(const std::string& word, const std::vector<std::string>& candidates,
                       const std::string& prefix) {
  const std::string nearest = NearestWord(word, candidates);
  return nearest.empty() ? "" : fmt::format(", did you mean '{}{}'?", prefix, nearest);
}

std::string DidYouMeanKey(const std::string& key_path, const std::vector<std::string>& key_paths,
                          bool or_near) {
  if (key_path.size() > kLongestName) return "";
  constexpr std::size_t kMost = 3;
  const auto last_of = [](const std::string& path) { return path.substr(path.rfind('.') + 1); };
  std::set<std::string> lasts;
  for (const std::string& path : key_paths) lasts.insert(last_of(path));
  std::string last = last_of(key_path);
  if (or_near && !lasts.contains(last)) last = NearestWord(last, {lasts.begin(), lasts.end()});
  std::vector<std::string> found;
  std::ranges::copy_if(key_paths, std::back_inserter(found), [&](const std::string& path) {
    return path != key_path && last_of(path) == last;
  });
  std::ranges::stable_sort(found, {},
                           [&](const std::string& path) { return EditDistance(key_path, path); });
  found.resize(std::min(found.size(), kMost));
  std::string hint;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const char* joint = i == 0 ? ", did you mean " : i + 1 == found.size() ? " or " : ", ";
    hint += fmt::format("{}'{}'", joint, found[i]);
  }
  return hint.empty() ? "" : hint + "?";
}

}  // namespace depthgrid
