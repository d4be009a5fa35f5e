#include "eval/doubts/crossing_check.h"

#include <fmt/format.h>

#include "mapper/grid/crossed_walls.h"

namespace depthgrid {

std::optional<Crossing> CrossingOf(const MapperResult& result) {
  const std::vector<CrossedWalls> scans = WallsCrossed(result.mapped, result.map);
  Crossing crossing;
  crossing.share = CrossingShare(scans);
  int most = 0;
  for (const CrossedWalls& scan : scans) {
    crossing.beams += scan.beams;
    if (scan.crossing <= most) continue;
    most = scan.crossing;
    crossing.worst_frame = FrameAt(result.mapped, scan.mapped).frame;
  }
  if (crossing.beams == 0) return {};
  return crossing;
}

std::optional<std::string> DoubtOfCrossing(const Crossing& crossing) {
  if (crossing.share < kDoubledShare) return {};
  return fmt::format(
      "the map contradicts its own scans: {:.1f} % of the beams lead through its walls (most "
      "around frame {}), so walls are drawn twice or askew, as where poses are wrong",
      100.0 * crossing.share, *crossing.worst_frame);
}

std::optional<std::string> DoubtOfCrossing(const MapperResult& result) {
  const auto crossing = CrossingOf(result);
  return crossing ? DoubtOfCrossing(*crossing) : std::nullopt;
}

}  // namespace depthgrid
