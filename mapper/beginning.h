// The first frames of a run with their scans, stored to be mapped again (docs/math.md, "The first
// frames again" and "What moves").
#pragma once

#include <vector>

#include "mapper/scan/frame_scans.h"
#include "mapper/scan/moving_objects.h"

namespace depthgrid {

class Beginning {
 public:
  struct Seen {
    Frame frame;  // without image and scans
    FrameScans scans;
  };

  // `wanted`: whether to store frames at all.
  explicit Beginning(bool wanted) : lasts_(wanted) {}

  // Stores the next frame. With more than 300 frames all are dropped, as mapping more again would
  // delay a frame too long.
  void Add(const Frame& frame, const FrameScans& scans);
  // Removes a moving object from the stored scans: in its sectors and, in frames between two of
  // them, in their common range of bearings. Sector::frame counts from the first frame added. False
  // if no stored frame is affected.
  bool TakeOut(const std::vector<MovingObjects::Sector>& object);
  void End();
  bool lasts() const { return lasts_; }
  const std::vector<Seen>& frames() const { return frames_; }

 private:
  bool lasts_;
  std::vector<Seen> frames_;
};

}  // namespace depthgrid
