// Counts the epochs of SLAM's poses, within which the difference of two of them is a motion.
#pragma once

#include <array>
#include <optional>

#include "mapper/core/frame.h"
#include "mapper/core/slam_step.h"

namespace depthgrid {

class SlamEpochs {
 public:
  // The frame's epoch, counted from 0. A new one begins where Frame::slam_epoch changes, where a
  // step is no possible motion (an unreported correction), and where SLAM restarted: after a pause,
  // a pose at the origin or at the first pose. A frame without a pose has the epoch of the last one
  // with a pose. Call once per frame, in order of time.
  int Of(const Frame& frame);
  int newest() const { return epoch_; }
  // Makes the last frame begin a new epoch, detected by other means (such as a slip).
  int BeginAtLast() { return ++epoch_; }

 private:
  struct Posed {
    double stamp_s = 0.0;
    Pose3 slam_from_camera;
    int slam_epoch = 0;
  };
  // Ring buffer of the last motions.
  struct Motions {
    std::array<SlamStep, 8> steps;
    std::size_t count = 0;  // added in all
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
  Motions since_;    // motions since the last break or gap, to judge the next step by
  Motions before_;   // motions before that, used as well while `since_` has few
  bool gap_ = true;  // whether a gap separates the two, or there is no `before_`
};

}  // namespace depthgrid
