#include "eval/cli/usage.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <sstream>
#include <vector>

#include "eval/cli/commands.h"
#include "eval/cli/map_settings.h"
#include "mapper/io/config.h"
#include "mapper/io/number_rows.h"

namespace depthgrid::cli {
namespace {

// The innermost command given, and its full name: "depthgrid eval map".
const CLI::App& Reached(const CLI::App& app, std::string& name) {
  name += app.get_name();
  const std::vector<CLI::App*> next = app.get_subcommands();
  if (next.empty()) return app;
  name += ' ';
  return Reached(*next.front(), name);
}

std::vector<std::string> Commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

// Without their dashes, which would count as similarity.
std::vector<std::string> LongOptions(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  }
  return names;
}

std::string WithoutDashes(const std::string& option) {
  return option.substr(std::min(option.find_first_not_of('-'), option.size()));
}

// The keys that --set of a command accepts; empty for commands with other keys than these two
// kinds.
std::vector<std::string> KeysOf(const CLI::App& app) {
  const bool has_set = app.get_option_no_throw("--set") != nullptr;
  if (!has_set || app.get_name() == "slam") return {};
  std::istringstream lines(app.get_name() == "map" ? MapKeys() : ExperimentKeys());
  std::vector<std::string> keys;
  for (std::string line; std::getline(lines, line);) keys.push_back(line.substr(0, line.find(' ')));
  return keys;
}

// The key that an option probably means: one with this full path, or the only one with this ending.
std::string KeyMeant(const CLI::App& app, const std::string& option) {
  const std::string word = WithoutDashes(option);
  const std::vector<std::string> keys = KeysOf(app);
  if (std::find(keys.begin(), keys.end(), word) != keys.end()) return word;
  const auto ends_so = [&](const std::string& key) { return key.ends_with("." + word); };
  if (std::count_if(keys.begin(), keys.end(), ends_so) != 1) return "";
  return *std::find_if(keys.begin(), keys.end(), ends_so);
}

// The words that no command took, from the first on; after "--" none is an option.
struct UnknownWords {
  std::vector<std::string> words;
  bool ended = false;  // they come after "--"
};

UnknownWords UnknownOf(const CLI::App& app) {
  UnknownWords unknown{app.remaining(), false};
  if (!unknown.words.empty() && unknown.words.front() == "--") {
    unknown.words.erase(unknown.words.begin());
    unknown.ended = true;
  }
  return unknown;
}

std::string UnknownWord(const CLI::App& app, const UnknownWords& unknown) {
  const auto& [words, ended] = unknown;
  const std::string& word = words.front();
  if (word.starts_with('-') && !ended) {
    const auto equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const std::string key = name.starts_with("--") && name.size() > 2 ? KeyMeant(app, name) : "";
    if (!key.empty()) {
      const bool value_follows = words.size() > 1 && !words[1].starts_with('-');
      const std::string value = equals != std::string::npos ? word.substr(equals + 1)
                                : value_follows             ? words[1]
                                                            : "VALUE";
      return fmt::format("no option '{}': {} is a key, --set {}={}", name, key, key, value);
    }
    return fmt::format("no option '{}'{}", name,
                       DidYouMean(WithoutDashes(name), LongOptions(app), "--"));
  }
  const std::vector<std::string> commands = Commands(app);
  if (commands.empty()) {
    return fmt::format("'{}' is one argument too many{}", word,
                       ended ? ": after -- nothing is an option" : "");
  }
  return fmt::format("no command '{}'{}", word, DidYouMean(word, commands));
}

std::optional<double> FiniteNumber(const std::string& text) {
  const auto value = ParseNumber(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

std::string UsageMessage(const CLI::App& app, const CLI::ParseError& error,
                         const std::vector<std::string>& given) {
  std::string name;
  const CLI::App& reached = Reached(app, name);
  UnknownWords unknown = UnknownOf(reached);
  // Left to the commands above by one that has all its arguments at "--", or given before it.
  const std::vector<std::string> above = app.remaining(true);
  if (unknown.words.empty() && !above.empty() && above.front() != "--") {
    const auto word = std::find(given.begin(), given.end(), above.front());
    unknown = {above, std::find(given.begin(), word, "--") != word};
    if (!unknown.ended) return UnknownWord(app, unknown) + " (see depthgrid --help)";
  }
  const std::string what = unknown.words.empty() ? error.what() : UnknownWord(reached, unknown);
  return fmt::format("{} (see {} --help)", what, name);
}

std::string RefusalUnlessPositive(const std::string& text) {
  const auto value = FiniteNumber(text);
  return value && *value > 0.0 ? "" : "is '" + text + "', must be a number above 0";
}

std::string RefusalUnlessFinite(const std::string& text) {
  return FiniteNumber(text) ? "" : "is '" + text + "', must be a number";
}

std::string RefusalIfNegative(const std::string& text) {
  const auto value = FiniteNumber(text);
  return value && *value >= 0.0 ? "" : "is '" + text + "', must be a number, 0 or more";
}

std::string RefusalOfTilde(const std::string& path) {
  if (!path.starts_with("~/") && path != "~") return "";
  return fmt::format(
      "is '{}', whose ~ the shell has left as it is: must be $HOME{} instead, or stand apart from "
      "the option, without = and quotes",
      path, path.substr(1));
}

std::string RefusalUnlessPlace(const std::string& text) {
  return PlaceOf(text) ? "" : fmt::format("is '{}', {}", text, kPlaceRule);
}

std::string RefusalUnlessSeed(const std::string& text) {
  std::uint64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  // CLI11 would read 010 as 8.
  if (error == std::errc() && *stop == '\0' && !HasLeadingZero(text)) return "";
  return fmt::format("is '{}', must be a whole number from 0 to {}", text, UINT64_MAX);
}

}  // namespace depthgrid::cli
