// Lossless compression of stored scans, so that a day of driving fits in memory. Scans share their
// bearings, and a beam stores only what does not follow from the beams before it: 5 bytes a beam
// for a laser instead of 20.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "mapper/core/scan.h"

namespace depthgrid {

// The compressed form of a scan; the codes are explained in kept_scan.cc.
struct PackedScan {
  double max_range_m = 0.0;
  std::span<const float> bearings_rad;  // one a beam
  std::span<const std::uint8_t> codes;  // one a beam: which values follow for it
  std::span<const float> values;
};

// False when the number of values is not what the codes require.
bool IsWhole(const PackedScan& packed);
// Requires IsWhole(packed).
Scan Unpacked(const PackedScan& packed);

// A handle, cheap to copy. Many scans share a block of memory, which lives as long as any of them.
class KeptScan {
 public:
  KeptScan() = default;
  explicit operator bool() const { return block_ != nullptr; }
  Scan operator*() const { return Unpacked(packed()); }
  // A view of the block's memory.
  PackedScan packed() const;

  bool operator==(const KeptScan& other) const {
    return (block_ == other.block_ && at_ == other.at_) || **this == *other;
  }

 private:
  friend class ScanArchive;
  struct Block {
    std::shared_ptr<const std::vector<float>> bearings_rad;  // of all its scans
    std::size_t room = 0;                                    // bytes
    std::size_t used = 0;
    std::unique_ptr<std::byte[]> bytes;
  };
  KeptScan(std::shared_ptr<const Block> block, std::size_t at)
      : block_(std::move(block)), at_(at) {}

  std::shared_ptr<const Block> block_;
  std::size_t at_ = 0;
};

// Storage of scans. Allocates blocks of growing size rather than memory for every scan.
class ScanArchive {
 public:
  KeptScan Keep(const Scan& scan);

 private:
  void Pack(const Scan& scan);
  std::shared_ptr<KeptScan::Block> BlockFor(const Scan& scan, std::size_t bytes);

  std::shared_ptr<KeptScan::Block> newest_;
  // Buffers of Pack(): the last scan packed.
  std::vector<std::uint8_t> codes_;
  std::vector<float> values_;
};

}  // namespace depthgrid
