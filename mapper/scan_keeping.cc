#include "mapper/scan_keeping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mapper/core/grid_geometry.h"
#include "mapper/core/median.h"

namespace depthgrid {
namespace {

// Bits of heading and coordinates in a place's key.
constexpr int kHeadingBits = 12;
constexpr int kCoordinateBits = 26;
// Factor on the scans of a place for those that the map does not explain.
constexpr double kRoomForChange = 2.0;

std::uint64_t LowBits(int value, int bits) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(value)) &
         ((std::uint64_t{1} << bits) - 1);
}

}  // namespace

void KeepOptions::Visit(OptionsVisitor& v) {
  v.Number("first_frames", first_frames, {0, 1e9},
           "mapped frames whose scans are all kept for the final map; 0: always all");
  v.Number("scans_per_place", scans_per_place, {1, 1e6},
           "scans that a place keeps after those first frames");
  v.Number("place_m", place_m, {0.05, 100.0}, "width of a place, metres");
  v.Number("place_deg", place_deg, {1.0, 360.0},
           "range of the headings that a place is seen under, degrees");
  v.Number("more_each_doubling", more_each_doubling, {0.0, 10.0},
           "share of scans_per_place kept in addition each time the run is twice as long");
  v.Number("min_explained", min_explained, {0.0, 1.0},
           "twice as many are kept of scans of which the map explains less than this");
}

ScanKeeping::ScanKeeping(const KeepOptions& options) : options_(options) {}

std::uint64_t ScanKeeping::KeyOf(const Pose2& map_from_base) const {
  const Cell cell = CellOf(map_from_base.translation(), options_.place_m);
  const auto heading =
      static_cast<int>(std::floor((map_from_base.yaw_rad + kPi) / RadFromDeg(options_.place_deg)));
  return LowBits(cell.x, kCoordinateBits) << (kCoordinateBits + kHeadingBits) |
         LowBits(cell.y, kCoordinateBits) << kHeadingBits | LowBits(heading, kHeadingBits);
}

double ScanKeeping::RoomAfter(std::size_t frames, bool explained) const {
  const double doublings =
      std::floor(std::log2(static_cast<double>(frames) / options_.first_frames));
  return options_.scans_per_place * (1.0 + options_.more_each_doubling * doublings) *
         (explained ? 1.0 : kRoomForChange);
}

std::optional<int> ScanKeeping::TieOf(const std::vector<MappedFrame>& frames,
                                      const Pose2& map_from_base, bool explained,
                                      std::span<const MapPart> matched, int from) const {
  const std::size_t count = frames.size();
  if (options_.first_frames == 0 || count < static_cast<std::size_t>(options_.first_frames)) {
    return std::nullopt;
  }
  const int index = place_of_key_.Find(KeyOf(map_from_base));
  if (index < 0) return std::nullopt;
  const Place& place = places_[static_cast<std::size_t>(index)];
  const double room = RoomAfter(count, explained);
  if (place.count < room) return std::nullopt;
  std::optional<int> nearest;
  double least_apart = std::numeric_limits<double>::infinity();
  int counted = 0;
  int before = -1;
  for (int i = place.newest; i >= 0; i = before) {  // the newest first
    const Kept& kept = kept_[static_cast<std::size_t>(i)];
    if (kept.position < from) break;
    ++counted;
    before = kept.before;
    const double apart =
        Separation(frames[static_cast<std::size_t>(kept.position)].map_from_base, map_from_base);
    if (apart >= least_apart) continue;
    least_apart = apart;
    nearest = kept.position;
  }
  if (counted < room) return std::nullopt;
  const std::optional<int> drawn_by = DrawnBy(matched);
  return drawn_by && *drawn_by >= from ? drawn_by : nearest;
}

// Where the map was bent, the frames that drew one place may be moved apart by an adjustment: a
// frame must move with those it was matched to, not with the nearest ones.
std::optional<int> ScanKeeping::DrawnBy(std::span<const MapPart> matched) const {
  std::vector<Weighed> parts;
  parts.reserve(matched.size());  // called for every frame: allocate once
  for (const MapPart& part : matched) {
    parts.push_back({part.mapped, part.information.topLeftCorner<2, 2>().trace()});
  }
  if (parts.empty() || kept_.empty()) return std::nullopt;
  const double middle = WeighedMedian(std::move(parts));
  const auto after = std::lower_bound(kept_.begin(), kept_.end(), middle,
                                      [](const Kept& kept, double m) { return kept.position < m; });
  if (after == kept_.end()) return kept_.back().position;
  if (after == kept_.begin()) return after->position;
  const int before = (after - 1)->position;
  return middle - before < after->position - middle ? before : after->position;
}

void ScanKeeping::Add(int position, const Pose2& map_from_base) {
  if (options_.first_frames == 0) return;
  const std::uint64_t key = KeyOf(map_from_base);
  int index = place_of_key_.Find(key);
  if (index < 0) {
    index = static_cast<int>(places_.size());
    place_of_key_.Add(key, index);
    places_.push_back({});
  }
  Place& place = places_[static_cast<std::size_t>(index)];
  kept_.push_back({position, place.newest});
  place.newest = static_cast<int>(kept_.size()) - 1;
  ++place.count;
}

void ScanKeeping::Rebuild(const std::vector<MappedFrame>& frames) {
  place_of_key_.Clear();
  places_.clear();
  kept_.clear();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].kept()) Add(static_cast<int>(i), frames[i].map_from_base);
  }
}

}  // namespace depthgrid
