// Detects slips of wheels, or errors of SLAM's heading within a frame: the map explained the last
// scan, suddenly explains little of this one, and would explain it at another heading
// (docs/math.md, "Slips").
#pragma once

#include <memory>
#include <optional>

#include "mapper/frame_history.h"
#include "mapper/fuse/fusion_options.h"
#include "mapper/graph/relocation.h"

namespace depthgrid {

// False for a small fixed gain along any axis: the map's errors then grow, and the share it
// explains varies without slips.
bool CanTellSlips(const FusionOptions& fusion);

class SlipSearch {
 public:
  // Headings up to `slip_deg` from the prediction are tried; 0: none.
  explicit SlipSearch(double slip_deg) : slip_deg_(slip_deg) {}

  // Whether the map, which explained the last scan as usual, suddenly explains less than half as
  // much of this frame's: this `share`.
  bool FellSuddenly(const FrameRecord& frame, double share, const Relocation& usually) const;

  // Whether a slip before this frame is likely, given the map's explained `share` of its scan.
  // `usually` gives the usual share.
  bool IsSuspected(const FrameRecord& frame, double share, const Relocation& usually) const;

  // Where the camera was at last_frame(), and how far it may have gone since.
  struct Last {
    Pose2 map_from_base;
    double longest_way_m = 0.0;
  };
  // A pose at another heading at which the map explains the scan about as well as the last one;
  // empty if there is none. Requires IsSuspected(). `mapped_frames`: their number.
  std::optional<Pose2> Find(const std::shared_ptr<const Scan>& scan, const Prediction& prediction,
                            const Last& last, int mapped_frames, ReferenceMap& reference) const;

  // Records a frame's scan and its match at the final prediction.
  void Placed(const FrameRecord& frame, const std::shared_ptr<const Scan>& scan,
              const MatchResult& match);
  // FrameRecord::index of the last frame recorded.
  int last_frame() const { return last_frame_; }

 private:
  // The match at the heading that explains most; empty if none qualifies as a slip.
  std::optional<MatchResult> BestHeading(const std::shared_ptr<const Scan>& scan,
                                         const Prediction& prediction, const Last& last,
                                         ReferenceMap& reference) const;

  double slip_deg_;
  int last_frame_ = -1;
  double last_stamp_s_ = 0.0;
  int last_epoch_ = 0;
  double last_share_ = 0.0;  // explained share and number of the last scan's pieces
  int last_explained_ = 0;
  std::shared_ptr<const Scan> last_scan_;  // null before the first
};

}  // namespace depthgrid
