// Error messages for wrong command lines.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace depthgrid::cli {

// One line without the program's name: an unknown command or option with the nearest known one, or
// CLI11's message. `given`: the words of the command line.
std::string UsageMessage(const CLI::App& app, const CLI::ParseError& error,
                         const std::vector<std::string>& given);

// For check(): CLI11's own PositiveNumber and NonNegativeNumber print the largest double in full.
std::string RefusalUnlessPositive(const std::string& text);
std::string RefusalUnlessFinite(const std::string& text);
std::string RefusalIfNegative(const std::string& text);

// For check(): shells replace ~ only at the beginning of an unquoted word, so not in --output=~/x.
std::string RefusalOfTilde(const std::string& path);

// For check(): a place in a map, "X,Y,YAW_DEG".
std::string RefusalUnlessPlace(const std::string& text);

// For check(): CLI11 reads -3 as 2^64 - 3, and numbers that are too large as the largest one.
std::string RefusalUnlessSeed(const std::string& text);

}  // namespace depthgrid::cli
