// The rows of the kinds of event files that mapper/io/loop_events.h tells apart.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mapper/io/loop_events.h"
#include "mapper/io/number_rows.h"

namespace depthgrid::internal {

// Of a row of loops.csv.
constexpr std::size_t kCsvColumns = 14;
constexpr std::size_t kCsvColumnsWithStamps = 17;

// The frame of a stamp; nothing when the recording has none that near.
class FrameFinder {
 public:
  FrameFinder(const std::vector<double>& stamps_s, double max_difference_s)
      : stamps_s_(stamps_s), max_difference_s_(max_difference_s) {}
  std::optional<int> At(double stamp_s) const;

 private:
  const std::vector<double>& stamps_s_;
  double max_difference_s_;
};

// A row of loops.csv (mapper/io/slam_files.h lists the columns), with the frames as it names them.
struct CsvEvent {
  SlamEvent event;  // frames by their numbers in the recording
  // Stamps of the event's frame and of the loop's two, where the row has them.
  std::optional<double> stamp_s;
  std::optional<double> first_stamp_s;
  std::optional<double> second_stamp_s;
};
CsvEvent ParseCsvEvent(std::string_view row, const std::string& place);

// A line of ORB-SLAM2's events: any number of events (GBA_DONE is none). Empty and `missing` set
// when it is of a frame that is not there.
struct FoundEvent {
  std::optional<SlamEvent> event;
  bool missing = false;
};
FoundEvent ParseOrbEvent(const TextRow& row, const std::string& path, const FrameFinder& frames);

// A row of numbers: both stamps, first_from_second, and the sigmas or none.
FoundEvent ParseStampedLoop(const TextRow& row, const std::string& path, const FrameFinder& frames);

}  // namespace depthgrid::internal
