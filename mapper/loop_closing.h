// From SLAM's loop closures to corrected poses: projection to the plane, overlap test, adjustment.
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
  // Whether a loop must pass the overlap test.
  bool verify = true;
  OverlapOptions overlap;
  // With more mapped frames than this, loops only bend the chain of poses during the run, and
  // surfels are adjusted at the end. A full adjustment delays a frame by 0.3 s at 4,300 frames, 0.4
  // s at 17,700 (docs/tried.md, "Loops that hold up a frame").
  int bend_frames = 4000;
  LoopSearchOptions search;
  // Whether what the finished map shows twice is joined (map_joining.h); only where loops are
  // searched for.
  bool join_doubled = true;
  // At the end SLAM is followed where the map leaves its path by this many times as much as usual
  // and nothing that was seen contradicts SLAM (astray_mending.h); 0: never. Only where loops are
  // searched for and with surfels.
  double astray_ratio = 8.0;
  SlideSearchOptions slide;
  RelocationOptions relocation;

  void Visit(OptionsVisitor& v);
};

// The loops that an adjustment with them accepted.
std::vector<PlanarLoop> Held(const std::vector<PlanarLoop>& loops, const Adjustment& adjustment);

// Collects the loops that passed the test and adjusts poses with them.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopOptions& options) : options_(options) {}

  struct Outcome {
    bool adjusted = false;
    std::vector<Pose2> map_from_base;  // of all frames given; only if adjusted
    Eigen::MatrixXd covariance;        // as Adjustment::covariance, for `asked`
    int accepted = 0;                  // among the new loops
    int rejected = 0;
    std::vector<PlanarLoop> held;  // all loops accepted by the adjustment, old ones included
  };
  // `frames`: the mapped frames; the newest input frame may be the last of them, provisionally, to
  // be placed by its loops (`newest_is_last`). Loops at a frame near which nothing is mapped yet
  // wait for later calls, and count as neither accepted nor rejected until then.
  Outcome Close(const std::vector<LoopClosure>& events, const FrameHistory& history,
                const std::vector<MappedFrame>& frames, bool newest_is_last,
                ReferenceMap& reference, std::span<const int> asked);
  // Adds loops that the mapper found itself. They are kept only if the adjustment with all loops
  // accepts them and their places then still pass the overlap test. With more than `bend_frames`
  // frames it costs less than `wanted`.
  Outcome Add(const std::vector<PlanarLoop>& found, const std::vector<MappedFrame>& frames,
              AdjustEffort wanted, ReferenceMap& reference, std::span<const int> asked);
  // Adjusts everything again with the loops known so far.
  Adjustment AdjustAll(const std::vector<MappedFrame>& frames, ReferenceMap& reference,
                       AdjustEffort effort, std::span<const int> asked) const {
    return reference.Adjust(frames, loops_, effort, asked);
  }
  const std::vector<PlanarLoop>& loops() const { return loops_; }
  bool waits() const { return !waiting_.empty(); }

 private:
  AdjustEffort EffortFor(const std::vector<MappedFrame>& frames, AdjustEffort wanted) const;

  LoopOptions options_;
  std::vector<PlanarLoop> loops_;
  std::vector<LoopClosure> waiting_;
};

}  // namespace depthgrid
