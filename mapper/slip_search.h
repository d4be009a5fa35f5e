// Where wheels slip, or SLAM turns by less than shows in its poses: the map explained the last scan
// and all at once explains little of this one, and another heading would explain it (docs/math.md,
// "Epochs").
#pragma once

#include <memory>
#include <optional>

#include "mapper/frame_history.h"
#include "mapper/fuse/fusion_options.h"
#include "mapper/graph/relocation.h"

namespace depthgrid {

// False for a fixed gain that takes little of what a match says, along any axis: the map then errs
// by more and more, and what it explains comes and goes without a slip.
bool CanTellSlips(const FusionOptions& fusion);

class SlipSearch {
 public:
  // Headings up to `slip_deg` from the prediction are tried; 0: none.
  explicit SlipSearch(double slip_deg) : slip_deg_(slip_deg) {}

  // Whether this frame's scan, of which the map explains `share`, came after a slip. `usually`
  // knows what it explains in ordinary times.
  bool IsSuspected(const FrameRecord& frame, double share, const Relocation& usually) const;

  // The pose at another heading at which the map explains the scan about as well as the last one;
  // empty where there is none. Only after IsSuspected(). `map_from_last` is where last_frame()
  // lies, `mapped_frames` how many there are.
  std::optional<Pose2> Find(const std::shared_ptr<const Scan>& scan, const Prediction& prediction,
                            const Pose2& map_from_last, int mapped_frames,
                            ReferenceMap& reference) const;

  // A frame with a scan and a pose, and what the map explained of it where it was placed.
  void Placed(const FrameRecord& frame, const std::shared_ptr<const Scan>& scan,
              const MatchResult& match);
  // FrameRecord::index of the last of them.
  int last_frame() const { return last_frame_; }

 private:
  // Of all headings the match that explains most; empty where none is a slip's.
  std::optional<MatchResult> BestHeading(const std::shared_ptr<const Scan>& scan,
                                         const Prediction& prediction,
                                         ReferenceMap& reference) const;

  double slip_deg_;
  int last_frame_ = -1;
  double last_stamp_s_ = 0.0;
  int last_epoch_ = 0;
  double last_share_ = 0.0;  // of its pieces that were explained, and how many these are
  int last_explained_ = 0;
  std::shared_ptr<const Scan> last_scan_;  // null before the first
};

}  // namespace depthgrid
