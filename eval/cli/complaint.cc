#include "eval/cli/complaint.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <new>
#include <system_error>

#include "eval/cli/console.h"
#include "eval/cli/interrupts.h"
#include "mapper/core/error.h"

namespace depthgrid::cli {
namespace {

// Whether the error is about the file name itself, as the user gave it.
bool IsOfName(const std::filesystem::filesystem_error& error) {
  const std::error_code& code = error.code();
  return code == std::errc::permission_denied || code == std::errc::filename_too_long ||
         code == std::errc::too_many_symbolic_link_levels;
}

}  // namespace

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
  // After an interrupt, any other error is a consequence of it.
  if (const auto exit_code = InterruptExitCode()) return Complain(InterruptText(), *exit_code);
  if (const auto* of_files = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    const std::string why = of_files->code().message();
    if (!of_files->path2().empty()) {  // of two paths, the second is the one to be written
      return Complain(of_files->path2().string() + ": cannot be written: " + why, kFailed);
    }
    return Complain(of_files->path1().string() + ": " + why,
                    IsOfName(*of_files) ? kBadInput : kFailed);
  }
  const auto* of_system = dynamic_cast<const std::system_error*>(&error);
  if (of_system != nullptr && std::ferror(stdout) != 0) {  // fmt does not name the file
    return Complain(CannotPrint(of_system->code().message()), kFailed);
  }
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return Complain("out of memory", kFailed);
  }
  const bool bad_input = dynamic_cast<const InputError*>(&error) != nullptr;
  return Complain(error.what(), bad_input ? kBadInput : kFailed);
}

}  // namespace depthgrid::cli
