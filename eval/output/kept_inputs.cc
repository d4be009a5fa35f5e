#include "eval/output/kept_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

fs::path Resolved(const fs::path& path) {
  std::error_code error;  // such as for a pipe, which has no path
  fs::path resolved = fs::weakly_canonical(fs::absolute(path), error);
  if (error) resolved = fs::absolute(path).lexically_normal();
  return resolved.has_filename() ? resolved : resolved.parent_path();
}

// The path relative to `folder`; empty if it is not below it.
fs::path Below(const fs::path& folder, const fs::path& path) {
  const fs::path relative = path.lexically_relative(folder);
  return relative.empty() || *relative.begin() == ".." || relative == "." ? fs::path() : relative;
}

// A file, both its path and its link's target, or the files of a folder.
std::vector<fs::path> FilesAt(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(Resolved(path), error)) {
      files.push_back(entry.path());
    }
    // So that messages do not depend on the file system's order.
    std::sort(files.begin(), files.end());
    return files;
  }
  const fs::path absolute = fs::absolute(path);
  return {Resolved(absolute.parent_path()) / absolute.filename(), Resolved(path)};
}

}  // namespace

void RequireInputsKept(const std::string& output, const std::string& option,
                       const std::vector<std::string>& inputs) {
  if (output.empty()) return;
  for (const std::string& input : inputs) {
    std::error_code missing;
    if (input.empty() || !fs::equivalent(input, output, missing)) continue;
    throw InputError(input, fmt::format("is read by this command, and {} {} would overwrite it; "
                                        "choose another name",
                                        option, output));
  }
}

void RequireInputsKept(const std::string& output, const FileRule& is_changed,
                       const std::vector<std::string>& inputs) {
  if (output.empty()) return;
  const fs::path folder = Resolved(output);
  for (const std::string& input : inputs) {
    if (input.empty()) continue;
    // A sequence as both input and output folder: its own files have no names of result files.
    if (fs::is_directory(input) && Resolved(input) == folder) continue;
    for (const fs::path& file : FilesAt(input)) {
      const fs::path relative = Below(folder, file);
      if (relative.empty() || !is_changed(relative)) continue;
      const fs::path shown =
          fs::is_directory(input) ? input / relative.filename() : fs::path(input);
      throw InputError(shown.string(),
                       fmt::format("is read by this command, and -o {} would overwrite or remove "
                                   "it; choose another folder",
                                   output));
    }
  }
}

}  // namespace depthgrid
