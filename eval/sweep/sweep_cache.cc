#include "eval/sweep/sweep_cache.h"

#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "eval/files/hash.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHexDigits = 16;

// HEX.depth and HEX-incidence.depth (eval/run/depth_cache.cc), HEX.scans
// (eval/sweep/scan_cache.cc), and their temporary names.
bool IsCacheFile(const std::string& name) {
  if (!ContentHash::IsHex(std::string_view(name).substr(0, kHexDigits))) return false;
  std::string_view ending = std::string_view(name).substr(kHexDigits);
  constexpr std::string_view kIncidence = "-incidence";
  if (ending.starts_with(kIncidence)) ending.remove_prefix(kIncidence.size());
  for (const std::string_view own : {".depth", ".scans"}) {
    if (ending == own) return true;
    if (!ending.starts_with(own)) continue;
    // Followed by the writer's process and thread numbers.
    const std::string_view rest = ending.substr(own.size());
    return rest.starts_with('.') &&
           (rest.ends_with(".tmp") || rest.find_first_not_of("-.0123456789") == rest.npos);
  }
  return false;
}

std::vector<fs::directory_entry> EntriesOf(const fs::path& folder) {
  std::error_code error;
  return {fs::directory_iterator(folder, error), fs::directory_iterator()};
}

}  // namespace

void RemoveSweepCache(const std::string& folder) {
  std::error_code ignored;  // such as: folder not empty, or already removed
  for (const fs::directory_entry& part : EntriesOf(folder)) {
    const std::string name = part.path().filename().string();
    const bool own = (name == "scans" || ContentHash::IsHex(name)) && !part.is_symlink(ignored);
    if (!own || !part.is_directory(ignored)) continue;
    for (const fs::directory_entry& file : EntriesOf(part.path())) {
      const bool is_file = file.is_regular_file(ignored) && !file.is_symlink(ignored);
      if (is_file && IsCacheFile(file.path().filename().string())) fs::remove(file, ignored);
    }
    fs::remove(part, ignored);
  }
  if (!fs::is_symlink(fs::symlink_status(folder, ignored))) fs::remove(folder, ignored);
}

}  // namespace depthgrid
