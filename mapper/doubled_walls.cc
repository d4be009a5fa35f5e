#include "mapper/doubled_walls.h"

#include <algorithm>
#include <cmath>

#include "mapper/graph/place.h"
#include "mapper/graph/place_matcher.h"

namespace depthgrid {
namespace {

// The limits below are choices; what others gave: docs/tried.md, "Lost and found".
// A scan of which this share leads through walls lies wrong, or the walls do.
constexpr double kMuchOfScan = 0.2;
// Most scans that are searched for, and most places for each.
constexpr std::size_t kQueries = 6;
constexpr std::size_t kCandidates = 10;
// Path between any two of them: their places are nearly the same otherwise.
constexpr double kApartM = 0.5;
// Half the search window: what such maps are off by. Candidates are that much and half of what a
// camera sees away, in headings from which they see the same.
constexpr double kWindowM = 1.5;
constexpr double kWindowDeg = 10.0;
constexpr double kSightM = 3.0;
constexpr double kMaxTurnDeg = 100.0;

// The scans that contradict the map most.
std::vector<int> Queries(std::vector<CrossedWalls> crossed, const std::vector<double>& way_m) {
  const auto more = [](const CrossedWalls& a, const CrossedWalls& b) {
    return a.share() > b.share();
  };
  std::stable_sort(crossed.begin(), crossed.end(), more);
  std::vector<int> queries;
  const auto way = [&](int i) { return way_m[static_cast<std::size_t>(i)]; };
  for (const CrossedWalls& scan : crossed) {
    if (scan.share() < kMuchOfScan || queries.size() == kQueries) break;
    const bool is_apart = std::all_of(queries.begin(), queries.end(), [&](int query) {
      return std::abs(way(query) - way(scan.mapped)) >= kApartM;
    });
    if (is_apart) queries.push_back(scan.mapped);
  }
  return queries;
}

// Frames at other times that may have seen the query's place, nearest first.
std::vector<int> Candidates(const std::vector<MappedFrame>& frames,
                            const std::vector<double>& way_m, int query, double min_way_m) {
  struct Ranked {
    double cost = 0.0;
    int frame = 0;
  };
  std::vector<Ranked> ranked;
  std::optional<double> last_m;
  for (int k = 0; k < static_cast<int>(frames.size()); ++k) {
    const double here_m = way_m[static_cast<std::size_t>(k)];
    if (!FrameAt(frames, k).kept() || (last_m && here_m - *last_m < kApartM)) continue;
    if (std::abs(here_m - way_m[static_cast<std::size_t>(query)]) < min_way_m) continue;
    const Pose2 off = Between(PoseAt(frames, k), PoseAt(frames, query));
    if (off.translation().norm() > kWindowM + kSightM) continue;
    if (std::abs(off.yaw_rad) > RadFromDeg(kMaxTurnDeg)) continue;
    last_m = here_m;
    ranked.push_back({Separation(PoseAt(frames, k), PoseAt(frames, query)), k});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.cost < b.cost; });
  std::vector<int> candidates;
  for (const Ranked& r : ranked) {
    if (candidates.size() == kCandidates) break;
    candidates.push_back(r.frame);
  }
  return candidates;
}

bool Corrects(const std::vector<MappedFrame>& frames, const PlanarLoop& loop,
              const LoopSearchOptions& search) {
  const Pose2 now = Between(PoseAt(frames, loop.first), PoseAt(frames, loop.second));
  const Pose2 correction = Between(now, loop.first_from_second);
  return correction.translation().norm() >= search.min_correction_m ||
         std::abs(correction.yaw_rad) >= RadFromDeg(search.min_correction_deg);
}

}  // namespace

std::optional<PlanarLoop> LoopOfDoubledWalls(const std::vector<MappedFrame>& frames,
                                             std::vector<CrossedWalls> crossed,
                                             const LoopSearchOptions& search,
                                             const OverlapOptions& overlap,
                                             const std::vector<GuessedPart>& guessed) {
  const std::vector<double> way_m = WaysTo(frames);
  const PlaceMatcher matcher(search, overlap);
  for (const int query : Queries(std::move(crossed), way_m)) {
    // Places of frames nearer along the path share frames.
    for (const int candidate : Candidates(frames, way_m, query, 2.0 * search.place.reach_m)) {
      const auto [first, second] = std::minmax(candidate, query);
      const bool leaves_guess = std::any_of(
          guessed.begin(), guessed.end(),
          [&](const GuessedPart& part) { return part.IsLeftBetween(candidate, query); });
      if (leaves_guess) continue;
      const auto loop =
          matcher.LoopBetween(frames, first, second, kWindowM, RadFromDeg(kWindowDeg));
      if (loop && Corrects(frames, *loop, search)) return loop;
    }
  }
  return {};
}

}  // namespace depthgrid
