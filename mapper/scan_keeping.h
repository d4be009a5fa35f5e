// Selects the scans kept for the final map: memory must grow with the area seen, not with time
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
  // The first mapped frames, all of which are kept (16 MB with 640 beams), so that short runs are
  // drawn from everything. 0: keep all of any run.
  int first_frames = 4000;
  // After that, each place (a cell of place_m and place_deg) keeps this many. At 1.2 m/s and 30 Hz
  // a robot passes it in 12 frames.
  int scans_per_place = 20;
  double place_m = 0.5;
  double place_deg = 24.0;
  // With each doubling of the run's length a place keeps this share more, so that changes such as
  // opened doors show in the map. Grows with the logarithm of time.
  double more_each_doubling = 0.5;
  // Scans of which the map explains less show something new: a place keeps these until it has twice
  // as many.
  double min_explained = 0.8;

  void Visit(OptionsVisitor& v);
};

class ScanKeeping {
 public:
  explicit ScanKeeping(const KeepOptions& options);

  // The kept frame to tie a new frame to if its place is well seen; empty if its scan is to be
  // kept. It is the kept frame nearest to the median, by information, of those that drew what was
  // matched; if unknown, the nearest of the place. `frames`: all earlier frames; those before index
  // `from` are not considered.
  std::optional<int> TieOf(const std::vector<MappedFrame>& frames, const Pose2& map_from_base,
                           bool explained, std::span<const MapPart> matched = {},
                           int from = 0) const;
  // Records that the frame at index `position` was kept.
  void Add(int position, const Pose2& map_from_base);
  // Call after the frames' poses changed.
  void Rebuild(const std::vector<MappedFrame>& frames);

 private:
  struct Kept {
    int position = 0;
    int before = -1;  // previous one of the same place, index into kept_
  };
  struct Place {
    int newest = -1;  // index into kept_
    int count = 0;
  };
  std::uint64_t KeyOf(const Pose2& map_from_base) const;
  // The kept frame nearest to the median frame that drew these parts.
  std::optional<int> DrawnBy(std::span<const MapPart> matched) const;
  double RoomAfter(std::size_t frames, bool explained) const;

  KeepOptions options_;
  KeyIndex place_of_key_;
  std::vector<Place> places_;
  std::vector<Kept> kept_;  // in order of time
};

}  // namespace depthgrid
