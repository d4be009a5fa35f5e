// Whose scans are kept for the final map: memory must grow with the area seen, not with time
// (docs/math.md, "Scans that are kept").
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mapper/core/key_index.h"
#include "mapper/core/options.h"
#include "mapper/core/reference_map.h"

namespace depthgrid {

struct KeepOptions {
  // All of the first so many mapped frames, 16 MB of 640 beams: short runs, logs and rooms alike,
  // are drawn from everything. 0: all of a run of any length.
  int first_frames = 4000;
  // After that a place, so wide and seen under headings so wide, keeps this many. A robot at 1.2
  // m/s and 30 Hz passes it in 12 frames.
  int scans_per_place = 20;
  double place_m = 0.5;
  double place_deg = 24.0;
  // Each time the run is twice as long, a place keeps this share more: doors open and things are
  // moved, and a map of only the oldest scans would never show it. Grows with the logarithm of
  // time.
  double more_each_doubling = 0.5;
  // Scans that the map explains less of see something else than it has: of them a place keeps until
  // it has twice as many.
  double min_explained = 0.8;

  void Visit(OptionsVisitor& v);
};

class ScanKeeping {
 public:
  explicit ScanKeeping(const KeepOptions& options);

  // The kept frame that one there, whose place is well seen, is to be tied to: the one that drew
  // what it was matched against, half of it before and half after; if that is not known the nearest
  // of the place. Empty where its scan is to be kept. `frames` are those before it; those before
  // `from` do not count.
  std::optional<int> TieOf(const std::vector<MappedFrame>& frames, const Pose2& map_from_base,
                           bool explained, std::span<const MapPart> matched = {},
                           int from = 0) const;
  // The frame at this position was kept there.
  void Add(int position, const Pose2& map_from_base);
  // The frames were moved.
  void Rebuild(const std::vector<MappedFrame>& frames);

 private:
  struct Kept {
    int position = 0;
    int before = -1;  // the one kept before it of the same place, an index into kept_
  };
  struct Place {
    int newest = -1;  // index into kept_
    int count = 0;
  };
  std::uint64_t KeyOf(const Pose2& map_from_base) const;
  // The kept frame nearest in time to what these were drawn by.
  std::optional<int> DrawnBy(std::span<const MapPart> matched) const;
  double RoomAfter(std::size_t frames, bool explained) const;

  KeepOptions options_;
  KeyIndex place_of_key_;
  std::vector<Place> places_;
  std::vector<Kept> kept_;  // in order of time
};

}  // namespace depthgrid
