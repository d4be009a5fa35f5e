#include <filesystem>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/run_report.h"
#include "eval/study_report.h"
#include "eval/sweep/sweep_database.h"
#include "eval/sweep_report.h"
#include "mapper/core/error.h"

namespace depthgrid::cli {

void Report(const ReportArguments& arguments) {
  if (!std::filesystem::is_directory(arguments.folder)) {
    throw InputError(arguments.folder, "no such folder");
  }
  if (SweepDatabase::Exists(arguments.folder)) {
    WriteSweepReport(arguments.folder);
  } else if (IsStudyFolder(arguments.folder)) {
    WriteStudyReport(arguments.folder);
  } else {
    WriteRunReport(arguments.folder);
  }
  SayReport(arguments.folder);
}

}  // namespace depthgrid::cli
