#include "mapper/finished_map.h"

#include <optional>

#include "mapper/grid/map_drawing.h"
#include "mapper/surfel/wall_ranges.h"

namespace depthgrid {
namespace {

// With less noise at the farthest hit next to nothing is gained (docs/results.md, "Finished map").
constexpr double kLeastCells = 1.5;

bool Exceeds(const LaserNoise& noise, const GridOptions& options) {
  return options.sharpen_sigmas > 0.0 && noise.most_m() > kLeastCells * options.resolution_m;
}

}  // namespace

OccupancyMap DrawKept(const std::vector<MappedFrame>& frames, const GridOptions& options) {
  MapDrawing drawing(options);
  for (const MappedFrame& frame : frames) {
    if (frame.kept()) drawing.Add(frame.frame, *frame.obstacles, frame.map_from_base);
  }
  return drawing.Map();
}

bool IsSharpened(const std::vector<MappedFrame>& frames, const GridOptions& options) {
  return Exceeds(LaserNoise(frames), options);
}

OccupancyMap DrawFinished(const std::vector<MappedFrame>& frames, const GridOptions& options) {
  const LaserNoise noise(frames);
  std::optional<WallRanges> walls;
  if (Exceeds(noise, options)) {
    walls.emplace(frames, noise, options.resolution_m, options.sharpen_sigmas);
  }
  MapDrawing drawing(options);
  for (const MappedFrame& frame : frames) {
    if (!frame.kept() || !frame.obstacles) continue;
    const Scan scan = *frame.obstacles;
    const bool is_sharpened = walls && DrawsWhatItMatches(frame);
    drawing.Add(frame.frame, is_sharpened ? walls->Sharpened(scan, frame.map_from_base) : scan,
                frame.map_from_base);
  }
  return drawing.Map();
}

}  // namespace depthgrid
