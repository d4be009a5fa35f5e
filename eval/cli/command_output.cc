#include "eval/cli/command_output.h"

#include "eval/sweep/sweep_database.h"
#include "mapper/core/error.h"

namespace depthgrid::cli {

OutputFolder OpenOutput(const CommonArguments& arguments) {
  if (SweepDatabase::Exists(arguments.output)) {
    throw InputError(arguments.output, "holds a sweep; choose another folder");
  }
  return OutputFolder(arguments.output, arguments.force);
}

}  // namespace depthgrid::cli
