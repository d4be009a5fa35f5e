#include "eval/cli/complaint.h"

#include <fmt/format.h>

#include <filesystem>
#include <new>

#include "eval/cli/console.h"
#include "eval/cli/interrupts.h"
#include "mapper/core/error.h"

namespace depthgrid::cli {

int Complain(const std::string& message, int exit_code) {
  std::string line = message;
  for (char& c : line) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  SayAside(fmt::format("depthgrid: {}\n", Printable(line)));
  return exit_code;
}

int ComplainOf(const std::exception& error) {
  // Whatever came of being stopped, that is what happened.
  if (const auto exit_code = InterruptExitCode()) return Complain("interrupted", *exit_code);
  if (const auto* path = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    return Complain(path->path1().string() + ": " + path->code().message(), kBadInput);
  }
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return Complain("out of memory", kFailed);
  }
  const bool bad_input = dynamic_cast<const InputError*>(&error) != nullptr;
  return Complain(error.what(), bad_input ? kBadInput : kFailed);
}

}  // namespace depthgrid::cli
