// Counts the epochs of SLAM's poses, within which the difference of two of them is a motion.
#pragma once

#include <array>
#include <optional>

#include "mapper/core/frame.h"
#include "mapper/core/slam_step.h"

namespace depthgrid {

class SlamEpochs {
 public:
  // The frame's epoch, counted from 0: another one where Frame::slam_epoch changes, and where SLAM
  // corrected itself without a word, as a step shows that nothing drives, or began anew, as a pose
  // shows that lies where the first one did after a pause. A frame without a pose has that of the
  // last one with a pose. Once a frame, in the order of time.
  int Of(const Frame& frame);
  // The last frame begins another epoch as well, as something else told.
  int BeginAtLast() { return ++epoch_; }

 private:
  struct Posed {
    double stamp_s = 0.0;
    Pose3 slam_from_camera;
    int slam_epoch = 0;
  };
  // The last motions: a ring.
  struct Motions {
    std::array<SlamStep, 8> steps;
    std::size_t count = 0;  // ever
    void Add(const SlamStep& step) { steps[count++ % steps.size()] = step; }
    bool AreFew() const;
    SlamStep Usual() const;  // their medians
  };
  bool Breaks(const Posed& last, const Posed& next);
  bool BeginsAnew(const Posed& last, const Posed& next) const;
  bool BreaksMotions(const SlamStep& step) const;

  std::optional<Pose3> first_;
  std::optional<Posed> last_;
  int epoch_ = 0;
  Motions since_;    // the last break or gap: by them the next step is judged
  Motions before_;   // while those are few, by these as well
  bool gap_ = true;  // between the two, or nothing was before
};

}  // namespace depthgrid
