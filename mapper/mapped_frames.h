// The frames that were mapped, and their scans: kept for the final map, or for a while only.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mapper/core/standing.h"
#include "mapper/scan/frame_scans.h"
#include "mapper/scan_keeping.h"

namespace depthgrid {

class MappedFrames {
 public:
  // The newest frames have their scans whether these are kept or not: what is being mapped may be
  // drawn again, and where it lies may be searched for.
  MappedFrames(const KeepOptions& options, int recent_frames);

  const std::vector<MappedFrame>& all() const { return frames_; }
  bool empty() const { return frames_.empty(); }
  int size() const { return static_cast<int>(frames_.size()); }
  const MappedFrame& back() const { return frames_.back(); }
  // Of these, those to which SLAM's pose stood.
  int standing() const { return standing_frames_; }

  // Those of a prior map.
  void StartFrom(std::vector<MappedFrame> prior);
  // The frame with its scans, for now.
  MappedFrame WithScans(MappedFrame frame, const FrameScans& scans);
  // The frame and its scans, kept unless its place is well seen already. `explained` is the share
  // of the scan that the map explains; empty: it is kept wherever it is. `matched`: what it was
  // matched against. What was seen before the frame at `from` does not count.
  const MappedFrame& Add(MappedFrame frame, const FrameScans& scans,
                         const std::optional<double>& explained,
                         std::span<const MapPart> matched = {}, int from = 0);
  // Corrected poses, one a frame. Matches of frames that are tied move with them.
  void MoveTo(const std::vector<Pose2>& map_from_base);
  // What SLAM says of the motion to this frame is wrong.
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

// The kept ones alone at these poses (one a frame of `frames`), each with SLAM's motion from the
// kept one before it.
std::vector<MappedFrame> KeptFrames(const std::vector<MappedFrame>& frames,
                                    const std::vector<Pose2>& map_from_base);

// A loop between frames whose scans are kept: ends that are tied move to what they are tied to.
// Empty where that is one frame: both move with it, and no loop can change how they lie.
std::optional<PlanarLoop> BetweenKept(const PlanarLoop& loop,
                                      const std::vector<MappedFrame>& frames);

// The same loops between positions among the kept frames. Their ends are kept.
std::vector<PlanarLoop> AmongKept(std::vector<PlanarLoop> loops,
                                  const std::vector<MappedFrame>& frames);

}  // namespace depthgrid
