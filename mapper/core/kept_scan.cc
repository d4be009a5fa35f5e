#include "mapper/core/kept_scan.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// A beam's code: whether it is a hit and the source of its range, clear_from and clear_to (stored
// in this order). Each is 0, the previous beam's, the beam's own range or the next stored value.
constexpr std::uint8_t kHit = 1;
constexpr std::uint8_t kRangeGiven = 2;  // else 0
constexpr std::uint8_t kFromGiven = 4;   // else the previous beam's, 0 for the first
constexpr std::uint8_t kToGiven = 8;     // else ...
constexpr std::uint8_t kToIsRange = 16;  // ... its range, or the previous beam's
constexpr std::uint8_t kAllBits = 31;

// Precedes a scan's codes and values in its block.
struct Header {
  double max_range_m = 0.0;
  std::uint32_t beams = 0;
  std::uint32_t values = 0;
};

constexpr std::size_t kLargestBlockBytes = std::size_t{1} << 18;

std::size_t Padded(std::size_t bytes) {
  return (bytes + alignof(Header) - 1) / alignof(Header) * alignof(Header);
}

// Compares bits, so that -0 and NaN are restored exactly.
bool Same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

bool SameBearings(const Scan& scan, const std::vector<float>& bearings_rad) {
  return std::equal(
      scan.beams.begin(), scan.beams.end(), bearings_rad.begin(), bearings_rad.end(),
      [](const Beam& beam, float bearing_rad) { return Same(beam.bearing_rad, bearing_rad); });
}

}  // namespace

bool IsWhole(const PackedScan& packed) {
  if (packed.codes.size() != packed.bearings_rad.size()) return false;
  std::size_t values = 0;
  for (const std::uint8_t code : packed.codes) {
    if (code > kAllBits) return false;
    values += static_cast<std::size_t>(
        std::popcount(static_cast<unsigned>(code & (kRangeGiven | kFromGiven | kToGiven))));
  }
  return values == packed.values.size();
}

Scan Unpacked(const PackedScan& packed) {
  Scan scan;
  scan.max_range_m = packed.max_range_m;
  scan.beams.resize(packed.codes.size());
  const float* next = packed.values.data();
  Beam before;
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    const std::uint8_t code = packed.codes[i];
    Beam& beam = scan.beams[i];
    beam.bearing_rad = packed.bearings_rad[i];
    beam.hit = (code & kHit) != 0;
    beam.range_m = (code & kRangeGiven) != 0 ? *next++ : 0.0F;
    beam.clear_from_m = (code & kFromGiven) != 0 ? *next++ : before.clear_from_m;
    if ((code & kToGiven) != 0) {
      beam.clear_to_m = *next++;
    } else {
      beam.clear_to_m = (code & kToIsRange) != 0 ? beam.range_m : before.clear_to_m;
    }
    before = beam;
  }
  return scan;
}

PackedScan KeptScan::packed() const {
  Require(block_ != nullptr, "a scan was kept");
  const std::byte* from = block_->bytes.get() + at_;
  Header header;
  std::memcpy(&header, from, sizeof header);
  from += sizeof header;
  PackedScan packed;
  packed.max_range_m = header.max_range_m;
  packed.bearings_rad = *block_->bearings_rad;
  packed.values = {reinterpret_cast<const float*>(from), header.values};
  from += header.values * sizeof(float);
  packed.codes = {reinterpret_cast<const std::uint8_t*>(from), header.beams};
  return packed;
}

void ScanArchive::Pack(const Scan& scan) {
  codes_.clear();
  values_.clear();
  Beam before;
  for (const Beam& beam : scan.beams) {
    std::uint8_t code = beam.hit ? kHit : 0;
    const auto give = [&](float value, std::uint8_t bit) {
      code |= bit;
      values_.push_back(value);
    };
    if (!Same(beam.range_m, 0.0F)) give(beam.range_m, kRangeGiven);
    if (!Same(beam.clear_from_m, before.clear_from_m)) give(beam.clear_from_m, kFromGiven);
    if (Same(beam.clear_to_m, beam.range_m)) {
      code |= kToIsRange;
    } else if (!Same(beam.clear_to_m, before.clear_to_m)) {
      give(beam.clear_to_m, kToGiven);
    }
    codes_.push_back(code);
    before = beam;
  }
}

// The newest block if it has the scan's bearings and enough room, else a new one: twice as large as
// the last, or of the size of one scan if the bearings differ.
std::shared_ptr<KeptScan::Block> ScanArchive::BlockFor(const Scan& scan, std::size_t bytes) {
  const bool same_bearings = newest_ && SameBearings(scan, *newest_->bearings_rad);
  if (same_bearings && newest_->room - newest_->used >= bytes) return newest_;
  auto block = std::make_shared<KeptScan::Block>();
  if (same_bearings) {
    block->bearings_rad = newest_->bearings_rad;
    block->room = std::max(std::min(2 * newest_->room, kLargestBlockBytes), bytes);
  } else {
    auto bearings_rad = std::make_shared<std::vector<float>>();
    bearings_rad->reserve(scan.beams.size());
    for (const Beam& beam : scan.beams) bearings_rad->push_back(beam.bearing_rad);
    block->bearings_rad = std::move(bearings_rad);
    block->room = bytes;
  }
  block->bytes = std::make_unique_for_overwrite<std::byte[]>(block->room);
  return block;
}

KeptScan ScanArchive::Keep(const Scan& scan) {
  Pack(scan);
  const Header header{scan.max_range_m, static_cast<std::uint32_t>(codes_.size()),
                      static_cast<std::uint32_t>(values_.size())};
  const std::size_t value_bytes = values_.size() * sizeof(float);
  const std::size_t bytes = Padded(sizeof header + value_bytes + codes_.size());
  newest_ = BlockFor(scan, bytes);
  const std::size_t at = newest_->used;
  newest_->used += bytes;
  std::byte* to = newest_->bytes.get() + at;
  std::memcpy(to, &header, sizeof header);
  if (!values_.empty()) std::memcpy(to + sizeof header, values_.data(), value_bytes);
  if (!codes_.empty()) std::memcpy(to + sizeof header + value_bytes, codes_.data(), codes_.size());
  return KeptScan(newest_, at);
}

}  // namespace depthgrid
