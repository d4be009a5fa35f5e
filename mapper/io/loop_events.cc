#include "mapper/io/loop_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/damage.h"
#include "mapper/io/event_rows.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

using internal::CsvEvent;
using internal::FrameFinder;

// Stamps of loops.csv are copies of the recording's.
constexpr double kSameStampS = 1e-3;

enum class EventKind { kCsv, kOrbSlam, kStamped };

// Whether any line of the text is from a loops.csv.
bool LooksLikeCsv(std::string_view text) {
  const auto begins_a_line = [text](std::string_view word) {
    return text.starts_with(word) || text.find("\n" + std::string(word)) != std::string_view::npos;
  };
  const std::size_t columns = SplitAtCommas(text.substr(0, text.find('\n'))).size();
  return columns == internal::kCsvColumns || columns == internal::kCsvColumnsWithStamps ||
         begins_a_line("kind,") || begins_a_line("loop,") || begins_a_line("relocalisation,");
}

// Detected by the first word. Throws InputError for other files.
EventKind KindOf(std::string_view text, const std::vector<TextRow>& rows,
                 const std::string& place) {
  if (rows.empty()) throw InputError(place, "is empty, must hold a header or events");
  const std::string row_place = PlaceOfLine(place, rows.front().line);
  const std::string_view first = rows.front().fields.front();
  if (ParseNumber(first)) {
    constexpr std::size_t kPoseColumns = 8;
    if (rows.front().fields.size() != kPoseColumns) return EventKind::kStamped;
    throw InputError(row_place, "has 8 columns as a trajectory has, must be SLAM's events");
  }
  if (first == "LOOP" || first == "RELOC" || first == "GBA_DONE") return EventKind::kOrbSlam;
  if (LooksLikeCsv(text)) return EventKind::kCsv;
  throw InputError(row_place, fmt::format("begins with '{}', must be SLAM's events: a loops.csv, "
                                          "ORB-SLAM2's or stamped loops",
                                          first.substr(0, 40)));
}

std::string NameOf(EventKind kind) {
  if (kind == EventKind::kCsv) return kOwnEvents;
  return kind == EventKind::kOrbSlam ? kOrbSlamEvents : "stamped loops";
}

bool IsHeader(std::string_view row) {
  return row.starts_with("kind,frame,epoch,") &&
         (row.ends_with(",sigma_rotation_rad") || row.ends_with(",second_stamp_s"));
}

// The rows of loops.csv. Their fields may be empty, which SplitRows would drop.
std::vector<CsvEvent> CsvRows(std::string_view rest, const std::string& place, RowDamage& damage) {
  std::vector<CsvEvent> events;
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view row = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (row.ends_with('\r')) row.remove_suffix(1);
    if (row.empty() || row.starts_with('#')) continue;
    damage.Try([&] {
      if (events.empty() && IsHeader(row)) return;
      const std::string row_place = PlaceOfLine(place, line);
      const CsvEvent event = internal::ParseCsvEvent(row, row_place);
      if (!events.empty() && (event.event.frame < events.back().event.frame ||
                              *event.event.epoch < *events.back().event.epoch)) {
        throw InputError(row_place, "frames and epochs must not go down");
      }
      events.push_back(event);
    });
  }
  return events;
}

// Finds the frames of loops.csv: by stamp if the recording has these stamps (it may have lost rows
// since), by number if it has none of them (another clock) or if numbers match more.
class CsvFrames {
 public:
  CsvFrames(const std::vector<CsvEvent>& events, const FrameNames& frames, double max_difference_s)
      : frames_(frames), own_stamps_s_(frames.stamps_s), finder_(own_stamps_s_, kSameStampS) {
    for (double& stamp_s : own_stamps_s_) stamp_s -= frames.time_offset_s;
    int found = 0;
    int agreeing = 0;
    const auto judge = [&](int number, const std::optional<double>& stamp_s) {
      if (!stamp_s) return;
      found += finder_.At(*stamp_s) ? 1 : 0;
      const auto named = At(number, {});
      const bool agrees = named && std::abs(own_stamps_s_[static_cast<std::size_t>(*named)] -
                                            *stamp_s) <= max_difference_s;
      agreeing += agrees ? 1 : 0;
    };
    for (const CsvEvent& event : events) {
      judge(event.event.frame, event.stamp_s);
      if (!event.event.loop) continue;
      judge(event.event.loop->first_frame, event.first_stamp_s);
      judge(event.event.loop->second_frame, event.second_stamp_s);
    }
    by_stamp_ = found > 0 && found >= agreeing;
  }
  std::optional<int> At(int number, const std::optional<double>& stamp_s) const {
    if (by_stamp_ && stamp_s) return finder_.At(*stamp_s);
    const auto frame = From(number, {});
    return frame && frames_.NumberOf(static_cast<std::size_t>(*frame)) == number ? frame
                                                                                 : std::nullopt;
  }
  // The frame, or the first one after it.
  std::optional<int> From(int number, const std::optional<double>& stamp_s) const {
    std::size_t frame = 0;
    const auto is_before = [&] {
      return by_stamp_ && stamp_s ? own_stamps_s_[frame] < *stamp_s - kSameStampS
                                  : frames_.NumberOf(frame) < number;
    };
    while (frame < own_stamps_s_.size() && is_before()) ++frame;
    return frame < own_stamps_s_.size() ? std::optional(static_cast<int>(frame)) : std::nullopt;
  }

 private:
  const FrameNames& frames_;
  std::vector<double> own_stamps_s_;
  FrameFinder finder_;
  bool by_stamp_ = false;
};

std::optional<LoopClosure> FindLoop(const CsvEvent& row, int reported_at, const CsvFrames& frames) {
  LoopClosure loop = *row.event.loop;
  const auto first = frames.At(loop.first_frame, row.first_stamp_s);
  const auto second = frames.At(loop.second_frame, row.second_stamp_s);
  if (!first || !second) return {};
  loop.reported_at_frame = reported_at;
  loop.first_frame = *first;
  loop.second_frame = *second;
  return loop;
}

// The events with their frames. A loop of a missing frame is left out and counted; a change of
// epoch at a missing frame takes effect at the next frame.
std::vector<SlamEvent> FindFrames(const std::vector<CsvEvent>& rows, const FrameNames& frames,
                                  double max_difference_s, int& missing) {
  const CsvFrames names(rows, frames, max_difference_s);
  std::vector<SlamEvent> events;
  for (const CsvEvent& row : rows) {
    const auto frame = names.From(row.event.frame, row.stamp_s);
    if (!frame) {
      ++missing;
      continue;
    }
    events.push_back({*frame, row.event.epoch, row.event.new_epoch, std::nullopt});
    if (!row.event.loop) continue;
    events.back().loop = FindLoop(row, *frame, names);
    if (!events.back().loop) ++missing;
  }
  return events;
}

std::vector<SlamEvent> StampedEvents(const std::vector<TextRow>& rows, EventKind kind,
                                     const std::string& place, const FrameFinder& frames,
                                     RowDamage& damage, int& missing) {
  std::vector<SlamEvent> events;
  for (const TextRow& row : rows) {
    damage.Try([&] {
      const internal::FoundEvent found = kind == EventKind::kOrbSlam
                                             ? internal::ParseOrbEvent(row, place, frames)
                                             : internal::ParseStampedLoop(row, place, frames);
      if (found.event) events.push_back(*found.event);
      if (found.missing) ++missing;
    });
  }
  return events;
}

}  // namespace

SlamEvents ParseSlamEvents(const std::string& whole_text, const std::string& place,
                           const FrameNames& frames, double max_difference_s) {
  const std::string_view text = WithoutByteOrderMark(whole_text);
  const std::vector<TextRow> rows = SplitRows(text);
  const EventKind kind = KindOf(text, rows, place);
  SlamEvents result;
  result.kind = NameOf(kind);
  RowDamage damage;
  int missing = 0;
  if (kind == EventKind::kCsv) {
    result.events = FindFrames(CsvRows(text, place, damage), frames, max_difference_s, missing);
  } else {
    const FrameFinder finder(frames.stamps_s, max_difference_s);
    result.events = StampedEvents(rows, kind, place, finder, damage, missing);
  }
  std::stable_sort(result.events.begin(), result.events.end(),
                   [](const auto& a, const auto& b) { return a.frame < b.frame; });
  damage.RequireMostGood(whole_text);
  damage.AppendTo(result.warnings, place);
  if (missing > 0) {
    result.warnings.push_back(fmt::format("{}: {} of frames that the recording does not have",
                                          place, Counted(missing, "event")));
  }
  return result;
}

}  // namespace depthgrid
