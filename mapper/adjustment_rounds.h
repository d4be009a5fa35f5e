// Schedule of adjustments of poses and map during a run.
#pragma once

#include "mapper/core/options.h"

namespace depthgrid {

struct RoundOptions {
  // Mapped frames before the first round, and factor to each next one; 0: no rounds. Early, because
  // later frames are matched against what the first ones drew. Geometric, so that all rounds
  // together cost less than one over the whole run (docs/tried.md).
  int first_frames = 60;
  double growth = 3.0;
  // No rounds beyond this: with revisits their cost grows faster than the run (1.6 s at 4,860
  // frames of a 20 m floor), and the first frames have long been corrected.
  int last_frames = 2000;
  // `learned`: whether the first frames, up to 300, are mapped again after the first round that
  // estimates SLAM's noise, with that noise (docs/math.md, "The first frames again").
  bool again = true;

  void Visit(OptionsVisitor& v);
};

class AdjustmentRounds {
 public:
  explicit AdjustmentRounds(const RoundOptions& options)
      : options_(options), next_(options.first_frames) {}

  // Whether a round is due, which is then taken to begin; call once per frame with the number of
  // mapped frames, without those of a prior map (the first round is to correct this run's start in
  // it) and those at which SLAM stood, which add no information.
  bool BeginIfDue(int frames);
  bool any_was_due() const { return next_ > options_.first_frames; }

 private:
  RoundOptions options_;
  int next_;
};

}  // namespace depthgrid
