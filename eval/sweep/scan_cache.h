// Scan sets kept on disk between sweeps and after a kill, under everything that shapes them.
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
  // Files in `folder`, which several programs may use at once. The longest unused go when a new
  // one would not fit into the limit. Throws InputError when the folder cannot be made.
  ScanCache(const std::string& folder, std::uint64_t size_limit_bytes = kDefaultScanCacheBytes);

  // Nothing when the set is not there, is damaged, or is larger than the limit: what Store() may
  // write is read, however large other files may be.
  std::optional<std::vector<FrameScans>> Load(const std::string& key) const;
  // Does nothing when the set is larger than the limit or the disk refuses: a cache may only save
  // time.
  void Store(const std::string& key, const std::vector<FrameScans>& scans) const;

 private:
  std::filesystem::path PathOf(const std::string& key) const;
  void MakeRoom(std::uint64_t bytes) const;

  std::filesystem::path folder_;
  std::uint64_t size_limit_bytes_;
};

}  // namespace depthgrid
