// Parses the options of a measuring program; an error is one line and exit code 2 (guarded_main.h).
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

#include "mapper/core/error.h"

namespace depthgrid {

// False if help was requested and printed.
inline bool ReadCommandLine(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return true;
  } catch (const CLI::Success&) {
    std::fputs(app.help().c_str(), stdout);
    return false;
  } catch (const CLI::ParseError& error) {
    throw InputError("", std::string(error.what()) + " (see --help)");
  }
}

// For check(): CLI11's own Range accepts "nan" and prints large numbers in full.
inline CLI::Validator FromTo(double low, double high) {
  std::ostringstream range;
  range.precision(10);
  range << "from " << low << " to " << high;
  const auto refusal = [low, high, rule = range.str()](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool is_number = !text.empty() && *end == '\0';
    return is_number && value >= low && value <= high ? "" : "is '" + text + "', must be " + rule;
  };
  return CLI::Validator(refusal, range.str());
}

}  // namespace depthgrid
