// How other files name the frames of a recording: by stamp, or by a number.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mapper/core/pose3.h"
#include "mapper/io/frame_part.h"

namespace depthgrid {

struct FrameNames {
  std::vector<double> stamps_s;  // by the clock of the poses
  // Of each frame in the recording as it was recorded, ascending: frames that were left out since
  // keep theirs. Empty: 0, 1, 2 ...
  std::vector<std::int64_t> numbers = {};
  // What was added to the recording's own stamps to get those of the poses.
  double time_offset_s = 0.0;
  // Poses this near to each other are interpolated; none: a frame has the pose of its stamp.
  std::optional<double> interpolated_gap_s = {};
  // Those that are read: poses and events are of the whole recording, messages of these.
  FramePart part = {};

  std::size_t CountInPart() const { return part.CountAmong(stamps_s.size()); }
  bool IsWhole() const { return CountInPart() == stamps_s.size(); }
  std::int64_t NumberOf(std::size_t frame) const {
    return numbers.empty() ? static_cast<std::int64_t>(frame) : numbers[frame];
  }
};

// Whether of two spans of time, in seconds, one is so much longer that it must be of other units:
// milliseconds take a thousand times as long.
bool AreOfOtherUnits(double span_s, double other_span_s);

// "images from 1.000 to 5.000 s, poses from 11.000 to 15.000 s", what was added to the images', the
// part's own and what may be done about it. `names` has frames, and there are poses, in order.
std::string StampRanges(const FrameNames& names, const std::vector<double>& pose_stamps_s);

// Whether so few frames have a pose that it is to be said why.
inline bool MostLackPoses(std::size_t with_pose, std::size_t frames) {
  return 2 * with_pose < frames;
}

// "frames 300 to 599 of 900, 10.000 to 19.967 s of 29.967": which they are of the whole recording.
std::string PartShown(const FrameNames& names);

// Poses without stamps, an entry a frame of `numbers`: one for each frame in order, or for each of
// the part or, where some frames have been left out, one for each number from 0. Another count is a
// warning, and they pair from the first.
std::vector<std::optional<Pose3>> PairInOrder(std::vector<std::optional<Pose3>> poses,
                                              const FrameNames& frames, const std::string& place,
                                              std::vector<std::string>& warnings);

}  // namespace depthgrid
