#include "eval/doubts/place_check.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mapper/core/angle.h"
#include "mapper/core/counted.h"
#include "mapper/core/level.h"
#include "mapper/grid/map_drawing.h"
#include "mapper/map_start.h"
#include "mapper/match/distance_field.h"
#include "mapper/place_watch.h"

namespace depthgrid {
namespace {

constexpr int kOneOf = 10;
// Least score of a match that counts; with less, hardly anything on the map was seen.
constexpr double kLeastExplained = 0.2;
// This many frames on the map, and as many off it, are no coincidence.
constexpr int kStretchFrames = 30;
// Largest sigma along a line of a match that has seen an end of the line, rather than noise.
constexpr double kSeenSigmaM = 0.02;
constexpr double kLittleM = 0.05;
constexpr double kLittleRad = RadFromDeg(3.0);
// For directions that a match does not constrain.
constexpr double kUnseenSigmaM = 100.0;

// Index of the frame at which kStretchFrames lost frames begin, after as many that were not lost.
std::optional<int> LeftAt(const std::vector<std::pair<int, bool>>& index_and_lost) {
  int lost_before = 0, in_a_row = 0;
  for (int i = 0; i < static_cast<int>(index_and_lost.size()); ++i) {
    if (!index_and_lost[static_cast<std::size_t>(i)].second) {
      lost_before += in_a_row;
      in_a_row = 0;
    } else if (++in_a_row == kStretchFrames) {
      const int begin = i + 1 - in_a_row;
      const bool was_on_map = begin >= kStretchFrames && lost_before * kOneOf <= begin;
      if (was_on_map) return index_and_lost[static_cast<std::size_t>(begin)].first;
    }
  }
  return {};
}

// Whether 90 % of the first kStretchFrames are on the map.
template <typename Iterator>
bool IsOnMap(Iterator begin, Iterator end) {
  if (end - begin < kStretchFrames) return false;
  const auto is_lost = [](const std::pair<int, bool>& frame) { return frame.second; };
  return std::count_if(begin, begin + kStretchFrames, is_lost) * kOneOf <= kStretchFrames;
}

}  // namespace

std::optional<LostFrames> FramesLost(const MappingRun& run, bool localised) {
  LostFrames count;
  count.localised = localised;
  std::vector<std::pair<int, bool>> index_and_lost;
  for (const FrameReport& report : run.reports) {
    const auto lost = IsOffMap(report);
    if (!lost || report.guessed) continue;  // a guess has its own warning
    count.lost += *lost ? 1 : 0;
    ++count.frames;
    index_and_lost.emplace_back(report.index, *lost);
    if (!localised) break;
  }
  if (count.lost == 0 || count.lost * kOneOf < count.frames) return {};
  count.left_at = LeftAt(index_and_lost);
  count.comes_back = IsOnMap(index_and_lost.begin(), index_and_lost.end()) &&
                     IsOnMap(index_and_lost.rbegin(), index_and_lost.rend());
  return count;
}

std::string TextOf(const LostFrames& lost) {
  if (!lost.localised) {
    return "lost: hardly anything that the first frame sees lies on this map, by which alone it "
           "was placed; the sequence is of another place or begins elsewhere in the map";
  }
  const std::string leaves =
      lost.left_at ? fmt::format("from frame {} on the sequence leaves", *lost.left_at)
                   : "in between the sequence leaves";
  std::string why = "the sequence is of another place, begins elsewhere in it or leaves it";
  if (lost.left_at || lost.comes_back) {
    why = leaves +
          " the map, where poses are SLAM's motion alone (without --localise they extend it), ";
    why += lost.comes_back ? "and comes back" : "or it is of another place";
  }
  return fmt::format(
      "lost: in {} of the {} that were placed and see something, hardly anything that is seen lies "
      "on the map; {}",
      lost.lost, Counted(lost.frames, "frame"), why);
}

std::optional<MovedStart> StartMoved(const MappingRun& run, const Pose2& given) {
  for (std::size_t i = 0; i < run.reports.size(); ++i) {
    const auto& map_from_camera = run.result.map_from_camera[i];
    if (!map_from_camera || run.reports[i].beams == 0) continue;
    const Pose2 found = BaseOf(*map_from_camera) * Inverse(run.base_from_laser);
    const Pose2 move = Between(given, found);
    if (move.translation().norm() <= kLittleM && std::abs(move.yaw_rad) <= kLittleRad) return {};
    return MovedStart{found, move};
  }
  return {};
}

MapAgreement AgreementWithEarlier(const MappingRun& run, const GridOptions& grid) {
  MapDrawing before(grid);
  for (const MappedFrame& frame : run.result.mapped) {
    if (frame.of_prior_map()) before.Add(frame.frame, *frame.obstacles, frame.map_from_base);
  }
  const DistanceField walls(before.Map(), kOffWallM + grid.resolution_m);
  MapAgreement agreement;
  for (const MappedFrame& frame : run.result.mapped) {
    if (!frame.of_prior_map()) Compare(*frame.obstacles, frame.map_from_base, walls, agreement);
  }
  return agreement;
}

bool SeesAlong(const MappingRun& run, const UnsureAlong& line) {
  return std::any_of(run.reports.begin(), run.reports.end(), [&](const FrameReport& report) {
    if (!report.match.found || report.match.score < kLeastExplained) return false;
    const double turn_rad = line.direction_rad - report.match.map_from_base.yaw_rad;
    const Eigen::Vector3d along(std::cos(turn_rad), std::sin(turn_rad), 0.0);
    const Eigen::Matrix3d known =
        report.match.information +
        Eigen::Matrix3d(
            Eigen::Vector3d::Constant(1.0 / (kUnseenSigmaM * kUnseenSigmaM)).asDiagonal());
    return along.dot(known.inverse() * along) < kSeenSigmaM * kSeenSigmaM;
  });
}

}  // namespace depthgrid
