// Scans kept for later, packed without loss: a day of driving is a matter of memory. Bearings are
// shared, and of each beam only what the beams before it do not say is stored: a laser's scan takes
// 5 bytes a beam instead of 20.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "mapper/core/scan.h"

namespace depthgrid {

// What a kept scan is made of; see kept_scan.cc for the codes.
struct PackedScan {
  double max_range_m = 0.0;
  std::span<const float> bearings_rad;  // one a beam
  std::span<const std::uint8_t> codes;  // one a beam: which values follow for it
  std::span<const float> values;
};

// False when the codes ask for other values than there are.
bool IsWhole(const PackedScan& packed);
// Of a whole one.
Scan Unpacked(const PackedScan& packed);

// A handle, cheap to copy. Many scans share a block of memory, which lives as long as any of them.
class KeptScan {
 public:
  KeptScan() = default;
  explicit operator bool() const { return block_ != nullptr; }
  Scan operator*() const { return Unpacked(packed()); }
  // Points into the block.
  PackedScan packed() const;

  bool operator==(const KeptScan& other) const { return **this == *other; }

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

// Where scans are kept. Takes memory in blocks that grow, not for every scan.
class ScanArchive {
 public:
  KeptScan Keep(const Scan& scan);

 private:
  void Pack(const Scan& scan);
  std::shared_ptr<KeptScan::Block> BlockFor(const Scan& scan, std::size_t bytes);

  std::shared_ptr<KeptScan::Block> newest_;
  // The last scan packed.
  std::vector<std::uint8_t> codes_;
  std::vector<float> values_;
};

}  // namespace depthgrid
