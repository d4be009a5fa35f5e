#include "mapper/io/mapped_files.h"

#include <algorithm>
#include <filesystem>

#include "mapper/core/drives.h"
#include "mapper/core/error.h"
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
                      return a.frame == b.frame && a.stamp_s == b.stamp_s;
                    });
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
  // In this order the folder has a readable map at any interruption.
  fs::remove(MatchedPath(folder));
  WriteScans(DrawnPath(folder), drawn);
  if (!same) WriteScans(MatchedPath(folder), matched);
}

std::vector<MappedFrame> ReadMapped(const std::string& folder) {
  const std::vector<StoredScan> drawn = ReadScans(DrawnPath(folder));
  const std::string matched_path = MatchedPath(folder);
  const std::vector<StoredScan> matched =
      fs::exists(matched_path) ? ReadScans(matched_path) : drawn;
  if (drawn.empty()) throw InputError(DrawnPath(folder), "holds no scan");
  if (!AreOfOneMap(drawn, matched)) {
    throw InputError(
        matched_path,
        "does not belong to the scans.bin beside it, which can be read without it: move it away");
  }
  std::vector<int> numbers;
  for (const StoredScan& scan : drawn) numbers.push_back(scan.frame);
  numbers = PriorNumbers(numbers);
  std::vector<MappedFrame> frames(drawn.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    frames[i].frame = numbers[i];
    frames[i].stamp_s = drawn[i].stamp_s;
    frames[i].obstacles = drawn[i].scan;
    frames[i].scan = matched[i].scan;
    frames[i].map_from_base = drawn[i].map_from_base;
  }
  return frames;
}

}  // namespace depthgrid
