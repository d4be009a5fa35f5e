// Cache of rendered depth on disk. The key of a frame contains everything that affects it, so an
// entry is either exactly what would be rendered or not found.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

#include "mapper/core/camera.h"
#include "mapper/core/pose3.h"
#include "mapper/core/trajectory.h"
#include "sim/depth/depth_camera.h"

namespace depthgrid {

constexpr std::uint64_t kDefaultCacheBytes = std::uint64_t{8} << 30U;

// Throws because the folder of a cache cannot be made: DiskFullError where there is no room, else
// InputError.
[[noreturn]] void RefuseCache(const std::string& folder, const std::error_code& error);

class DepthCache {
 public:
  // Frames of one scene seen by one camera, in `folder`, which several programs may use at once.
  // All entries of the folder count towards `size_limit_bytes`; the least recently used are removed
  // first. Entries that killed programs did not finish are removed now, once they are an hour old;
  // folders that cannot be read are ignored. Throws as RefuseCache() when its folder cannot be
  // made.
  DepthCache(const std::string& folder, const std::string& scene_hash, const PinholeCamera& camera,
             RayIsa isa, std::uint64_t size_limit_bytes = kDefaultCacheBytes);

  // Removes old entries until all frames of the path fit, or only their entries are left.
  void MakeRoomFor(const Trajectory& world_from_camera, bool with_incidence);

  // Empty when the frame is missing or damaged. Thread-safe.
  std::optional<DepthFrame> Load(const Pose3& world_from_camera, bool with_incidence) const;
  // Does nothing when the limit is reached or writing fails, because a cache is optional.
  // Thread-safe.
  void Store(const Pose3& world_from_camera, const DepthFrame& frame) const;

 private:
  std::filesystem::path EntryOf(const Pose3& world_from_camera, bool with_incidence) const;
  std::uint64_t BytesOf(bool with_incidence) const;

  std::filesystem::path root_;
  std::filesystem::path folder_;
  int width_px_;
  int height_px_;
  std::uint64_t size_limit_bytes_;
  mutable std::atomic<std::uint64_t> used_bytes_ = 0;
};

}  // namespace depthgrid
