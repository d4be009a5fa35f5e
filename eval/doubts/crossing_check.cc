#include "eval/doubts/crossing_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "mapper/grid/crossed_walls.h"
#include "mapper/grid/map_drawing.h"

namespace depthgrid {

namespace {

bool MatchesOtherScans(const MapperResult& result) {
  return std::any_of(result.mapped.begin(), result.mapped.end(), [](const MappedFrame& frame) {
    return frame.kept() && !frame.of_prior_map() && frame.scan && frame.obstacles &&
           !(frame.scan == frame.obstacles);
  });
}

// The frames as if what was matched had been drawn too.
std::vector<MappedFrame> WithMatchedDrawn(std::vector<MappedFrame> frames) {
  for (MappedFrame& frame : frames) frame.obstacles = frame.scan;
  return frames;
}

OccupancyMap Drawn(const std::vector<MappedFrame>& frames, double resolution_m) {
  GridOptions options;
  options.resolution_m = resolution_m;
  MapDrawing drawing(options);
  for (const MappedFrame& frame : frames) {
    if (frame.kept() && frame.obstacles) {
      drawing.Add(frame.frame, *frame.obstacles, frame.map_from_base);
    }
  }
  return drawing.Map();
}

// A camera's obstacles change with its distance, and what is matched with its height, also where
// poses are right. Where they are wrong both contradict themselves, so the lesser share is told.
std::vector<CrossedWalls> WallsCrossed(const MapperResult& result) {
  std::vector<CrossedWalls> of_obstacles = WallsCrossed(result.mapped, result.map);
  if (!MatchesOtherScans(result)) return of_obstacles;
  const std::vector<MappedFrame> frames = WithMatchedDrawn(result.mapped);
  std::vector<CrossedWalls> of_matched =
      WallsCrossed(frames, Drawn(frames, result.map.geometry.resolution_m));
  return CrossingShare(of_matched) < CrossingShare(of_obstacles) ? of_matched : of_obstacles;
}

}  // namespace

std::optional<Crossing> CrossingOf(const MapperResult& result) {
  const std::vector<CrossedWalls> scans = WallsCrossed(result);
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

std::optional<std::string> DoubtOfCrossing(const Crossing& crossing, bool has_camera) {
  if (crossing.share < kDoubledShare) return {};
  return fmt::format(
      "the map contradicts its own scans: {:.1f} % of the beams lead through its walls (most "
      "around frame {}), so walls are drawn twice or askew, as where poses, or the "
      "{}, are wrong",
      100.0 * crossing.share, *crossing.worst_frame,
      has_camera ? "camera's focal length or distortion" : "laser's angles, maximum or place");
}

std::optional<std::string> DoubtOfCrossing(const MapperResult& result) {
  const auto crossing = CrossingOf(result);
  return crossing ? DoubtOfCrossing(*crossing) : std::nullopt;
}

}  // namespace depthgrid
