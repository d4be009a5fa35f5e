// When poses and map are adjusted while a run goes on.
#pragma once

#include "mapper/core/options.h"

namespace depthgrid {

struct RoundOptions {
  // After so many mapped frames, and then each time there are `growth` times as many as the last
  // time; 0: never. What the first frames draw crookedly is what later ones are matched against.
  // Geometric, so that all rounds together cost less than one of everything (docs/tried.md).
  int first_frames = 60;
  double growth = 3.0;
  // None with more frames than this: where places are seen again and again its cost grows faster
  // than the run (1.6 s at 4,860 frames of a 20 m floor), and the first frames are long put right.
  int last_frames = 2000;
  // `learned`: whether the first frames, up to 300, are gone through again after the first round
  // that tells how SLAM errs, with what is known of it then (docs/math.md, "The first frames
  // again").
  bool again = true;

  void Visit(OptionsVisitor& v);
};

class AdjustmentRounds {
 public:
  explicit AdjustmentRounds(const RoundOptions& options)
      : options_(options), next_(options.first_frames) {}

  // Whether it is time with so many mapped frames of this run; asked once a frame. A prior map's do
  // not count: where this run began in it is put right by the first round. Nor do those to which
  // SLAM stood, which tell nothing new.
  bool IsDue(int frames);
  bool any_was_due() const { return next_ > options_.first_frames; }

 private:
  RoundOptions options_;
  int next_;
};

}  // namespace depthgrid
