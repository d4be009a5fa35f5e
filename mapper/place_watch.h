// Whether a robot that is localised in a finished map (PriorMap::fixed) is still on it, frame by
// frame, for a live system.
#pragma once

#include <cstdint>
#include <optional>

#include "mapper/core/frame_report.h"

namespace depthgrid {

// Whether hardly anything that the frame shows lies on the map (less than a fifth). Empty for a
// frame without a pose or without a return, which says nothing. Where the map is extended, it is by
// then of these frames as well and explains them wherever they are: only of localised ones.
std::optional<bool> IsOffMap(const FrameReport& report);

// Counts the last frames that say something. One frame off the map is nobody's loss: a person
// stands before the sensor. While it is lost, poses are SLAM's motion alone; when the map explains
// again what is seen, SLAM has brought it back there, or it was carried on to a place that looks
// alike. Put it right by FindStart() or FindStartNear() (mapper/map_start.h) and another mapper.
class PlaceWatch {
 public:
  // Once a frame, in the order of time.
  void Add(const FrameReport& report);
  // Of the last 30 frames that say something nine in ten were off the map. False while there are
  // fewer.
  bool lost() const;
  // A share of the last 30, 0 to 1: how far off that is.
  double off_map() const;

 private:
  std::uint32_t last_ = 0;  // a bit a frame, the newest the lowest
  int count_ = 0;           // of those that are there, 30 at most
};

}  // namespace depthgrid
