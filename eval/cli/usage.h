// What is wrong with a command line, in words that name the word at fault.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace depthgrid::cli {

// One line without the program's name: a command or option that is not known with the nearest that
// is, or what CLI11 says.
std::string UsageMessage(const CLI::App& app, const CLI::ParseError& error);

// For check(): CLI11's own PositiveNumber and NonNegativeNumber print the largest double in full.
std::string RefusalUnlessPositive(const std::string& text);
std::string RefusalUnlessFinite(const std::string& text);
std::string RefusalIfNegative(const std::string& text);

// For check(): a place in a map, "X,Y,YAW_DEG".
std::string RefusalUnlessPlace(const std::string& text);

// For check(): CLI11 reads -3 as 2^64 - 3 and takes what is too large for the largest number.
std::string RefusalUnlessSeed(const std::string& text);

}  // namespace depthgrid::cli
