#include <filesystem>

#include "eval/cli/commands.h"
#include "eval/run_report.h"
#include "mapper/core/error.h"

namespace depthgrid::cli {

void Report(const ReportArguments& arguments) {
  if (!std::filesystem::is_directory(arguments.folder)) {
    throw InputError(arguments.folder, "no such folder");
  }
  WriteRunReport(arguments.folder);
}

}  // namespace depthgrid::cli
