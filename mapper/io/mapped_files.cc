#include "mapper/io/mapped_files.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <optional>

#include "mapper/core/drives.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/scan_file.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

std::string DrawnPath(const std::string& folder) {
  return (fs::path(folder) / "scans.bin").string();
}
std::string MatchedPath(const std::string& folder) {
  return (fs::path(folder) / "matched.bin").string();
}

// A save writes the matched scans here first; until its last step ReadMapped() finds them here.
std::string NextMatchedPath(const std::string& folder) {
  return (fs::path(folder) / "matched.next.bin").string();
}

// Frames of prior maps get the highest negative numbers in their order, with one skipped between
// two drives, however many maps they came from.
std::vector<int> NumbersToStore(const std::vector<MappedFrame>& frames) {
  std::vector<int> numbers(frames.size());
  int next = -1;
  for (std::size_t i = frames.size(); i-- > 0;) {
    numbers[i] = frames[i].of_prior_map() ? next : frames[i].frame;
    --next;
    const bool both_prior = i > 0 && frames[i].of_prior_map();
    if (both_prior && BeginsDrive(frames[i - 1].frame, frames[i].frame)) --next;
  }
  return numbers;
}

bool AreOfOneMap(const std::vector<StoredScan>& drawn, const std::vector<StoredScan>& matched) {
  return std::equal(drawn.begin(), drawn.end(), matched.begin(), matched.end(),
                    [](const StoredScan& a, const StoredScan& b) {
                      return a.frame == b.frame && a.stamp_s == b.stamp_s &&
                             a.map_from_base == b.map_from_base;
                    });
}

// The matched scans at `path` if they are of the map that is drawn from `drawn`.
std::optional<std::vector<StoredScan>> MatchedOf(const std::vector<StoredScan>& drawn,
                                                 const std::string& path) {
  if (!fs::exists(path)) return std::nullopt;
  std::vector<StoredScan> matched = ReadScans(path);
  if (!AreOfOneMap(drawn, matched)) return std::nullopt;
  return matched;
}

// Those of a save that was killed at its last step. The matched.bin there is that of the map before
// then, whatever is in it, even damage.
std::optional<std::vector<StoredScan>> MatchedNext(const std::vector<StoredScan>& drawn,
                                                   const std::string& folder) {
  try {
    return MatchedOf(drawn, NextMatchedPath(folder));
  } catch (const InputError&) {  // damaged
    return std::nullopt;
  }
}

// Whether the map in the folder is one with MatchedNext().
bool HasMatchedNext(const std::string& folder) {
  if (!fs::exists(NextMatchedPath(folder))) return false;
  try {
    return MatchedNext(ReadScans(DrawnPath(folder)), folder).has_value();
  } catch (const InputError&) {  // no map, or one that cannot be read
    return false;
  }
}

// Does the last step of a save that was killed before it, or removes what it did not get to use.
void FinishKilledSave(const std::string& folder) {
  const std::string next = NextMatchedPath(folder);
  if (!fs::exists(next)) return;  // to remove nothing fails, too, where nothing can be written
  if (HasMatchedNext(folder)) {
    fs::rename(next, MatchedPath(folder));
  } else {
    fs::remove(next);
  }
}

// A full disk is not kept full by half a save. What failed is told by the error that led here.
void MakeRoomAfterFailure(const std::string& folder) {
  try {
    FinishKilledSave(folder);
  } catch (const std::exception&) {
    return;
  }
}

}  // namespace

void WriteMapped(const std::string& folder, const std::vector<MappedFrame>& frames) {
  const std::vector<int> numbers = NumbersToStore(frames);
  std::vector<StoredScan> drawn;
  std::vector<StoredScan> matched;
  bool same = true;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const MappedFrame& frame = frames[i];
    drawn.push_back({numbers[i], frame.stamp_s, frame.map_from_base, frame.obstacles});
    matched.push_back({numbers[i], frame.stamp_s, frame.map_from_base, frame.scan});
    same = same && frame.scan == frame.obstacles;
  }
  FinishKilledSave(folder);
  // scans.bin decides which map the folder has: before it is replaced the old matched.bin is read,
  // from then on the next one.
  const std::string next = NextMatchedPath(folder);
  if (!same || fs::exists(MatchedPath(folder))) WriteScans(next, matched);
  try {
    WriteScans(DrawnPath(folder), drawn);
  } catch (...) {
    MakeRoomAfterFailure(folder);
    throw;
  }
  if (same) {
    fs::remove(MatchedPath(folder));
    SyncToDisk(folder);  // never the old matched scans alone beside the new drawn ones
    fs::remove(next);
  } else {
    fs::rename(next, MatchedPath(folder));
  }
}

std::vector<MappedFrame> ReadMapped(const std::string& folder) {
  const std::vector<StoredScan> drawn = ReadScans(DrawnPath(folder));
  if (drawn.empty()) throw InputError(DrawnPath(folder), "holds no scan");
  const std::string matched_path = MatchedPath(folder);
  auto matched = MatchedNext(drawn, folder);
  if (!matched) matched = MatchedOf(drawn, matched_path);
  if (!matched) matched = MatchedOf(drawn, NextMatchedPath(folder));  // it throws if it is damaged
  if (!matched && fs::exists(matched_path)) {
    throw InputError(
        matched_path,
        "does not belong to the scans.bin beside it, which can be read without it: move it away");
  }
  if (!matched) matched = drawn;
  std::vector<int> numbers;
  for (const StoredScan& scan : drawn) numbers.push_back(scan.frame);
  numbers = PriorNumbers(numbers);
  std::vector<MappedFrame> frames(drawn.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    frames[i].frame = numbers[i];
    frames[i].stamp_s = drawn[i].stamp_s;
    frames[i].obstacles = drawn[i].scan;
    frames[i].scan = (*matched)[i].scan;
    frames[i].map_from_base = drawn[i].map_from_base;
  }
  return frames;
}

std::string MatchedFileOf(const std::string& folder) {
  if (HasMatchedNext(folder)) return NextMatchedPath(folder);
  return fs::exists(MatchedPath(folder)) ? MatchedPath(folder) : "";
}

}  // namespace depthgrid
