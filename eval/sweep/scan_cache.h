// Cache of scan sets on disk. The key contains everything that affects the scans.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapper/scan/frame_scans.h"

namespace depthgrid {

constexpr std::uint64_t kDefaultScanCacheBytes = std::uint64_t{4} << 30U;

class ScanCache {
 public:
  // Files in `folder`, which several programs may use at once. The least recently used are removed
  // when a new one would exceed the limit. Throws as RefuseCache() when the folder cannot be
  // made.
  ScanCache(const std::string& folder, std::uint64_t size_limit_bytes = kDefaultScanCacheBytes);

  // Empty when the set is missing, damaged, or larger than the limit; the limit also applies here,
  // so that every set that Store() writes can be read.
  std::optional<std::vector<FrameScans>> Load(const std::string& key) const;
  // Does nothing when the set is larger than the limit or writing fails, because a cache is
  // optional.
  void Store(const std::string& key, const std::vector<FrameScans>& scans) const;

 private:
  std::filesystem::path PathOf(const std::string& key) const;
  void MakeRoom(std::uint64_t bytes) const;

  std::filesystem::path folder_;
  std::uint64_t size_limit_bytes_;
};

}  // namespace depthgrid
