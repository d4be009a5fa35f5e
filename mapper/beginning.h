// The first frames of a run and what they saw, to be gone through once more (docs/math.md, "The
// first frames again").
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

  // The next frame, while it lasts: with more than 300 frames it is over. By then something was
  // learnt in other ways, and going through all of it would hold up a frame for too long.
  void Add(const Frame& frame, const FrameScans& scans);
  // An object that moved, in some of the frames; between them it is where it was before or after.
  // False where none of them is here.
  bool TakeOut(const std::vector<MovingObjects::Beams>& object);
  void End();
  bool lasts() const { return lasts_; }
  const std::vector<Seen>& frames() const { return frames_; }

 private:
  bool lasts_;
  std::vector<Seen> frames_;
};

}  // namespace depthgrid
