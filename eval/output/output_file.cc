#include "eval/output/output_file.h"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "mapper/core/error.h"

namespace depthgrid {

namespace fs = std::filesystem;

void RequireNewFile(const std::string& path, bool force, const std::string& remedy) {
  if (fs::is_directory(path)) throw InputError(path, "is a folder, must be a file");
  const fs::path folder = fs::absolute(path).parent_path();
  if (!fs::is_directory(folder)) throw InputError(path, "its folder does not exist");
  // A device or a link would itself be replaced, not its target.
  const fs::file_status there = fs::symlink_status(path);
  if (fs::exists(there) && !fs::is_regular_file(there)) {
    throw InputError(path, "is no regular file, and would be replaced by one; choose another name");
  }
  if (!force && fs::exists(there)) throw InputError(path, "is there already; " + remedy);
  if (::access(folder.c_str(), W_OK) != 0) {
    throw InputError(path, "cannot be written: " + std::generic_category().message(errno));
  }
}

void RequireWritable(const std::string& folder, const std::string& remedy) {
  if (::access(folder.c_str(), W_OK) == 0) return;
  throw InputError(folder, "cannot be written: " + std::generic_category().message(errno) + remedy);
}

}  // namespace depthgrid
