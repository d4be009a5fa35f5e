#include "eval/cli/shader_cache.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include "eval/cli/experiment_argument.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

// Mesa's src/util/disk_cache_os.c, 22.3: a 64-bit size and 2^16 keys of 20 bytes.
constexpr off_t kIndexBytes = 8 + (off_t{1} << 16) * 20;

// Mesa maps its cache's index into memory as a sparse file; if the disk is full when a hole is
// written, the program dies of SIGBUS. So this allocates the whole file beforehand; returns whether
// it succeeded.
bool TakeRoomForIndex(const fs::path& cache_folder) {
  const fs::path folder = cache_folder / "mesa_shader_cache";
  std::error_code error;
  fs::create_directories(folder, error);
  const int file = ::open((folder / "index").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file < 0) return false;
  const bool taken = ::posix_fallocate(file, 0, kIndexBytes) == 0;
  ::close(file);
  return taken;
}

}  // namespace

void KeepShadersInCache(const CommonArguments& arguments) {
  constexpr const char* kFolder = "MESA_SHADER_CACHE_DIR";
  constexpr const char* kDisable = "MESA_SHADER_CACHE_DISABLE";
  if (std::getenv(kFolder) != nullptr || std::getenv(kDisable) != nullptr) return;
  const std::string cache_folder = CacheFolder(arguments);
  if (cache_folder.empty() || !TakeRoomForIndex(cache_folder)) {
    ::setenv(kDisable, "true", 0);
  } else {
    ::setenv(kFolder, cache_folder.c_str(), 0);
  }
}

}  // namespace depthgrid::cli
