// How other files refer to the frames of a recording: by stamp or by number.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mapper/core/pose3.h"
#include "mapper/io/frame_part.h"

namespace depthgrid {

struct FrameNames {
  std::vector<double> stamps_s;  // in the clock of the poses
  // The number of each frame in the original recording, ascending; numbers of frames left out since
  // are not reused. Empty: 0, 1, 2 ...
  std::vector<std::int64_t> numbers = {};
  // Offset that was added to the recording's own stamps.
  double time_offset_s = 0.0;
  // Poses at most this far apart (s) are interpolated; empty: a frame gets the pose nearest to its
  // stamp.
  std::optional<double> interpolated_gap_s = {};
  // The frames that are read. Poses and events refer to the whole recording, messages to these
  // frames.
  FramePart part = {};

  std::size_t CountInPart() const { return part.CountAmong(stamps_s.size()); }
  bool IsWhole() const { return CountInPart() == stamps_s.size(); }
  std::int64_t NumberOf(std::size_t frame) const {
    return numbers.empty() ? static_cast<std::int64_t>(frame) : numbers[frame];
  }
};

// Whether one of two time spans (s) is so much longer that its unit must differ, such as
// milliseconds.
bool AreOfOtherUnits(double span_s, double other_span_s);

// "images from 1.000 to 5.000 s, poses from 11.000 to 15.000 s", with the offset added to the
// images, the part's range and advice. Requires frames and sorted poses.
std::string StampRanges(const FrameNames& names, const std::vector<double>& pose_stamps_s);

// Whether so few frames have a pose that a warning should explain it.
inline bool MostLackPoses(std::size_t with_pose, std::size_t frames) {
  return 2 * with_pose < frames;
}

// Whether two frames in five or more lack a pose, most of these between two frames that have one:
// poses come half as often as images.
bool LacksEachSecondPose(const std::vector<bool>& has_pose);

// The part as "frames 300 to 599 of 900, 10.000 to 19.967 s of 29.967".
std::string PartShown(const FrameNames& names);

struct PairedPoses {
  std::vector<std::optional<Pose3>> poses;  // one per frame
  bool lack_is_told = false;                // SlamOutput::lack_is_told
};

// Pairs poses without stamps with the frames: one pose per frame, per frame of the part or, if
// frames have been left out, per number from 0. Any other count gives a warning, and they are
// paired from the first.
PairedPoses PairInOrder(std::vector<std::optional<Pose3>> poses, const FrameNames& frames,
                        const std::string& place, std::vector<std::string>& warnings);

}  // namespace depthgrid
