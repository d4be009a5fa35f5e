#include "eval/files/one_result.h"

#include <filesystem>

#include "mapper/core/error.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

fs::path MarkIn(const std::string& folder) { return fs::path(folder) / ".depthgrid-replacing"; }

}  // namespace

void MarkAsReplaced(const std::string& folder) {
  WriteFile(MarkIn(folder).string(), "files of an earlier and of a later result\n");
}

void UnmarkAsReplaced(const std::string& folder) { fs::remove(MarkIn(folder)); }

void RequireOneResult(const std::string& folder) {
  // The mark of a study lies beside its cases' folders.
  const std::string study = (fs::path(folder) / ".").lexically_normal().parent_path().parent_path();
  std::error_code unknown;
  if (!fs::exists(MarkIn(folder), unknown) && !fs::exists(MarkIn(study), unknown)) return;
  throw InputError(folder,
                   "holds files of two results: a command that replaced one was killed; --force "
                   "writes it again");
}

}  // namespace depthgrid
