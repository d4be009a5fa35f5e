// The mapped frames with their scans, kept for the final map or only for a while.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mapper/core/standing.h"
#include "mapper/scan/frame_scans.h"
#include "mapper/scan_keeping.h"

namespace depthgrid {

// How far poses were moved: the largest distance and the largest turn of any.
struct FrameMoves {
  double most_m = 0.0;
  double most_rad = 0.0;

  bool any() const { return most_m > 0.0 || most_rad > 0.0; }
  void Include(const Pose2& before, const Pose2& after);
  // Moves of the same poses that follow: the sums are upper bounds.
  void Append(const FrameMoves& next);
};

class MappedFrames {
 public:
  // The newest `recent_frames` have their scans even if tied, as active submaps may be redrawn and
  // places searched.
  MappedFrames(const KeepOptions& options, int recent_frames);

  const std::vector<MappedFrame>& all() const { return frames_; }
  bool empty() const { return frames_.empty(); }
  int size() const { return static_cast<int>(frames_.size()); }
  const MappedFrame& back() const { return frames_.back(); }
  // Number of these at which SLAM stood.
  int standing() const { return standing_frames_; }

  // Begins with the frames of a prior map.
  void StartFrom(std::vector<MappedFrame> prior);
  // The frame with its scans, without adding it.
  MappedFrame WithScans(MappedFrame frame, const FrameScans& scans);
  // Adds the frame, whose scans are kept unless its place is well seen already. `explained`: share
  // of the scan that the map explains; empty: always keep. `matched`: the parts it was matched
  // against. Frames before index `from` are not considered.
  const MappedFrame& Add(MappedFrame frame, const FrameScans& scans,
                         const std::optional<double>& explained,
                         std::span<const MapPart> matched = {}, int from = 0);
  // Sets corrected poses, one per frame. Matches of tied frames move with them.
  FrameMoves MoveTo(const std::vector<Pose2>& map_from_base);
  // Drops all frames from this index on.
  void CutAt(int position);
  // Drops SLAM's motion to this frame, which is wrong.
  void ForgetMotionTo(int position);

 private:
  struct Archive {
    ScanArchive matched;
    ScanArchive obstacles;
    void Keep(const FrameScans& scans, MappedFrame& frame);
  };

  KeepOptions options_;
  std::size_t recent_frames_;
  std::vector<MappedFrame> frames_;
  Standing standing_;
  int standing_frames_ = 0;
  ScanKeeping keeping_;
  Archive kept_;
  Archive recent_;
};

// The kept frames at the given poses (one per frame of `frames`), each with SLAM's motion from the
// previous kept one.
std::vector<MappedFrame> KeptFrames(const std::vector<MappedFrame>& frames,
                                    const std::vector<Pose2>& map_from_base);

// Moves tied ends of a loop to the kept frames they are tied to. Empty if that is the same frame,
// as no loop can then change their relative pose.
std::optional<PlanarLoop> BetweenKept(const PlanarLoop& loop,
                                      const std::vector<MappedFrame>& frames);

// The loops with indices among the kept frames. Their ends must be kept.
std::vector<PlanarLoop> AmongKept(std::vector<PlanarLoop> loops,
                                  const std::vector<MappedFrame>& frames);

}  // namespace depthgrid
