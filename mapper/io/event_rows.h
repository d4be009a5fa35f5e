// The rows of the kinds of event files that mapper/io/loop_events.h tells apart.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mapper/io/loop_events.h"
#include "mapper/io/number_rows.h"

namespace depthgrid::internal {

// Number of columns of loops.csv.
constexpr std::size_t kCsvColumns = 14;
constexpr std::size_t kCsvColumnsWithStamps = 17;

// Finds the frame nearest to a stamp, within max_difference_s.
class FrameFinder {
 public:
  FrameFinder(const std::vector<double>& stamps_s, double max_difference_s)
      : stamps_s_(stamps_s), max_difference_s_(max_difference_s) {}
  std::optional<int> At(double stamp_s) const;

 private:
  const std::vector<double>& stamps_s_;
  double max_difference_s_;
};

// A row of loops.csv (columns: mapper/io/slam_files.h), with frames as numbered there.
struct CsvEvent {
  SlamEvent event;  // frames by their numbers in the recording
  // Stamps of the event's frame and of the loop's two, where the row has them.
  std::optional<double> stamp_s;
  std::optional<double> first_stamp_s;
  std::optional<double> second_stamp_s;
};
CsvEvent ParseCsvEvent(std::string_view row, const std::string& place);

// Result for a line of ORB-SLAM2's events, which may contain no event (GBA_DONE). `missing`: its
// frame is not in the recording.
struct FoundEvent {
  std::optional<SlamEvent> event;
  bool missing = false;
};
FoundEvent ParseOrbEvent(const TextRow& row, const std::string& path, const FrameFinder& frames);

// A row of numbers: both stamps, first_from_second and optionally the sigmas.
FoundEvent ParseStampedLoop(const TextRow& row, const std::string& path, const FrameFinder& frames);

}  // namespace depthgrid::internal
