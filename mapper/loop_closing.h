// From SLAM's loop events to corrected poses: project to the plane, test against what was seen,
// adjust.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mapper/frame_history.h"
#include "mapper/graph/loop_overlap.h"
#include "mapper/graph/loop_search_options.h"
#include "mapper/graph/relocation.h"
#include "mapper/graph/slide_search.h"

namespace depthgrid {

struct LoopOptions {
  bool use = true;
  // Whether a loop must lay what its two places saw over each other.
  bool verify = true;
  OverlapOptions overlap;
  // With more mapped frames than this a loop only bends the chain of poses while the run goes on,
  // and what was seen is laid over each other at the end. Adjusting all of it holds up a frame: for
  // 0.3 s at 4,300 frames, 0.4 s at 17,700 (docs/tried.md, "Loops that hold up a frame").
  int bend_frames = 4000;
  LoopSearchOptions search;
  SlideSearchOptions slide;
  RelocationOptions relocation;

  void Visit(OptionsVisitor& v);
};

// The loops known so far that passed the test, and the adjustments they led to.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopOptions& options) : options_(options) {}

  struct Outcome {
    bool adjusted = false;
    std::vector<Pose2> map_from_base;  // of all frames given, when adjusted
    Eigen::MatrixXd covariance;        // as of Adjustment, of the frames asked for
    int accepted = 0;                  // of the new events
    int rejected = 0;
    std::vector<PlanarLoop> held;  // all that the adjustment was made with, old ones included
  };
  // `frames` are the mapped frames; the newest input frame may be the last of them, provisionally,
  // to be placed by its loops.
  Outcome Close(const std::vector<LoopClosure>& events, const FrameHistory& history,
                const std::vector<MappedFrame>& frames, bool newest_is_last,
                ReferenceMap& reference, std::span<const int> asked);
  // Loops that the mapper found itself. They are kept when the adjustment with all loops takes them
  // in and still lays what their places saw over each other.
  Outcome Add(const std::vector<PlanarLoop>& found, const std::vector<MappedFrame>& frames,
              ReferenceMap& reference, std::span<const int> asked);
  // Everything once more, with the loops known so far.
  Adjustment AdjustAll(const std::vector<MappedFrame>& frames, ReferenceMap& reference,
                       AdjustEffort effort, std::span<const int> asked) const {
    return reference.Adjust(frames, loops_, effort, asked);
  }
  const std::vector<PlanarLoop>& loops() const { return loops_; }

 private:
  AdjustEffort EffortFor(const std::vector<MappedFrame>& frames) const;

  LoopOptions options_;
  std::vector<PlanarLoop> loops_;
};

}  // namespace depthgrid
