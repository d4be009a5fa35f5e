#include "eval/cli/usage.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapper/io/config.h"
#include "mapper/io/number_rows.h"

namespace depthgrid::cli {
namespace {

// The command that the words reached, and its name as typed: "depthgrid eval map".
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

std::vector<std::string> Options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string UnknownWord(const CLI::App& app, const std::string& word) {
  if (word.starts_with('-')) {
    const std::string name = word.substr(0, word.find('='));
    return fmt::format("no option '{}'{}", name, DidYouMean(name, Options(app)));
  }
  const std::vector<std::string> commands = Commands(app);
  if (commands.empty()) return fmt::format("'{}' is one argument too many", word);
  return fmt::format("no command '{}'{}", word, DidYouMean(word, commands));
}

std::optional<double> FiniteNumber(const std::string& text) {
  const auto value = ParseNumber(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

std::string UsageMessage(const CLI::App& app, const CLI::ParseError& error) {
  std::string name;
  const CLI::App& reached = Reached(app, name);
  const std::vector<std::string> unknown = reached.remaining();
  const std::string what = unknown.empty() ? error.what() : UnknownWord(reached, unknown.front());
  return fmt::format("{} (see {} --help)", what, name);
}

std::string RefusalUnlessPositive(const std::string& text) {
  const auto value = FiniteNumber(text);
  return value && *value > 0.0 ? "" : "is '" + text + "', must be a number above 0";
}

std::string RefusalIfNegative(const std::string& text) {
  const auto value = FiniteNumber(text);
  return value && *value >= 0.0 ? "" : "is '" + text + "', must be a number, 0 or more";
}

std::string RefusalUnlessSeed(const std::string& text) {
  std::uint64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && *stop == '\0' ? "" : "'" + text + "' is no whole number";
}

}  // namespace depthgrid::cli
