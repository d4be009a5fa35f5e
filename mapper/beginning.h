// The first frames of a run and what they saw, to be gone through again (docs/math.md, "The
// first frames again" and "What moves").
#pragma once

#include <vector>

#include "mapper/scan/frame_scans.h"
#include "mapper/scan/moving_objects.h"

namespace depthgrid {

class Beginning {
 public:
  struct Seen {
    Frame frame;  // without what its sensor gave
    FrameScans scans;
  };

  // `wanted`: whether anybody will go through them.
  explicit Beginning(bool wanted) : lasts_(wanted) {}

  // The next frame, while it lasts: with more than 300 frames it is over. Going through more would
  // hold up a frame for too long.
  void Add(const Frame& frame, const FrameScans& scans);
  // Something that moved: where it was seen, and in frames between two such all that lies from the
  // one place to the other. Frames are counted from the first one added. False if none is here.
  bool TakeOut(const std::vector<MovingObjects::Sector>& object);
  void End();
  bool lasts() const { return lasts_; }
  const std::vector<Seen>& frames() const { return frames_; }

 private:
  bool lasts_;
  std::vector<Seen> frames_;
};

}  // namespace depthgrid
