// Monitors whether a robot localised in a finished map (PriorMap::fixed) is still on it.
#pragma once

#include <cstdint>
#include <optional>

#include "mapper/core/frame_report.h"

namespace depthgrid {

// Least share of a scan that the map explains at the right place. Of 46 starts in two furnished
// rooms, frames at the right place had 0.36 and more of their scan on the map, those at a wrong
// place or in another room 0.05 and less.
constexpr double kLeastOnMap = 0.2;

// Whether less than kLeastOnMap of the frame's scan lies on the map, or its place is a guess. Empty
// for a frame without a pose or a return. Only meaningful with PriorMap::fixed: an extended map
// contains these frames and explains them wherever they are.
std::optional<bool> IsOffMap(const FrameReport& report);

// Statistics over the last frames, since a single one may be off the map because a person stands
// before the sensor. While lost, poses follow SLAM's motion alone; if the map explains the scans
// again, SLAM has led back, or to a place that looks alike, or the mapper has found the place
// itself (FrameReport::carried, relocated). If it does not, use FindStart() or FindStartNear()
// (mapper/map_start.h) and a new mapper.
class PlaceWatch {
 public:
  // Call once per frame, in order of time.
  void Add(const FrameReport& report);
  // Whether nine in ten of the last 30 usable frames were off the map. False while there are fewer.
  bool lost() const;
  // Share of the last 30 usable frames that were off the map, 0 to 1.
  double off_map() const;

 private:
  std::uint32_t last_ = 0;  // one bit per frame, the newest lowest
  int count_ = 0;           // number of valid bits, at most 30
};

}  // namespace depthgrid
