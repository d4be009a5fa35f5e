#include "mapper/io/loop_events.h"

#include <fmt/format.h>

#include <algorithm>

#include "mapper/core/error.h"
#include "mapper/io/event_rows.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

using internal::FrameFinder;

std::vector<SlamEvent> CsvEvents(std::string_view rest, const std::string& place,
                                 std::size_t frame_count) {
  std::vector<SlamEvent> events;
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view row = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (row.ends_with('\r')) row.remove_suffix(1);
    const bool header = line == 1 && row.starts_with("kind");
    if (row.empty() || row.starts_with('#') || header) continue;
    const std::string row_place = PlaceOfLine(place, line);
    events.push_back(internal::ParseCsvEvent(row, row_place, frame_count));
    if (events.size() == 1) continue;
    const SlamEvent& before = events[events.size() - 2];
    if (events.back().frame < before.frame || *events.back().epoch < *before.epoch) {
      throw InputError(row_place, "frames and epochs must not go down");
    }
  }
  return events;
}

}  // namespace

SlamEvents ParseSlamEvents(const std::string& text, const std::string& place,
                           const std::vector<double>& frame_stamps_s, double max_difference_s) {
  const std::vector<TextRow> rows = SplitRows(text);
  const std::string_view first = rows.empty() ? "" : rows.front().fields.front();
  const bool stamped = ParseNumber(first).has_value();
  const bool orb = first == "LOOP" || first == "RELOC" || first == "GBA_DONE";
  SlamEvents result;
  if (!stamped && !orb) {
    result.kind = kOwnEvents;
    result.events = CsvEvents(text, place, frame_stamps_s.size());
    return result;
  }
  result.kind = orb ? "ORB-SLAM2 events" : "stamped loops";
  const FrameFinder frames(frame_stamps_s, max_difference_s);
  int missing = 0;
  for (const TextRow& row : rows) {
    const internal::FoundEvent found = orb ? internal::ParseOrbEvent(row, place, frames)
                                           : internal::ParseStampedLoop(row, place, frames);
    if (found.event) result.events.push_back(*found.event);
    if (found.missing) ++missing;
  }
  if (missing > 0) {
    result.warnings.push_back(
        fmt::format("{}: {} events of frames that the recording does not have", place, missing));
  }
  std::stable_sort(result.events.begin(), result.events.end(),
                   [](const auto& a, const auto& b) { return a.frame < b.frame; });
  return result;
}

}  // namespace depthgrid
