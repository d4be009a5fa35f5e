#include "eval/cli/command_output.h"

#include "eval/cli/experiment_argument.h"
#include "eval/output/kept_inputs.h"

namespace depthgrid::cli {

OutputFolder OpenOutput(const CommonArguments& arguments, ResultKind kind,
                        const std::vector<std::string>& inputs,
                        const std::vector<std::string>& cases) {
  const std::string& folder = arguments.output;
  RequireReachable(folder);
  RequireNotCurrent(folder);
  RequireNoOtherResult(folder, kind);
  RequireNamesFree(folder, kind, cases);
  // Commands that render have a cache; with --force the folder may exist.
  const bool has_cache = kind != ResultKind::kMap && kind != ResultKind::kSlam;
  if (has_cache && !arguments.force) RequireCacheElsewhere(arguments);
  if (arguments.force) RequireOwnFiles(folder, kind, cases);
  const FileRule written = FilesOf(kind);
  const FileRule removed = FilesLeftBy(kind, folder);
  RequireInputsKept(
      folder, [&](const auto& file) { return written(file) || removed(file); }, inputs);
  return OutputFolder(folder, arguments.force, removed, MarkOf(kind));
}

}  // namespace depthgrid::cli
