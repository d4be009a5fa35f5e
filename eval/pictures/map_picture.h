// Pictures of maps: states as colours, the estimate compared with the truth, and the map with
// trajectories and a scale bar.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/pictures/path_drawing.h"
#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"

namespace depthgrid {

// One pixel per cell of the given rectangle, largest y at the top.
RgbImage PictureOf(const OccupancyMap& map, const GridGeometry& geometry);
RgbImage PictureOf(const StateMap& map, const GridGeometry& geometry);
RgbImage PictureOf(const CellSet& cells, const GridGeometry& geometry);
// Shows correct, missed and invented walls in different colours; cells outside `observable` are
// paler.
RgbImage DifferencePicture(const StateMap& truth, const StateMap& estimate,
                           const std::optional<CellSet>& observable, const GridGeometry& geometry);

// Lines at whole metres of the map's frame (for large maps at tens of metres and so on), numbered
// along the top and the left edge.
enum class Lattice { kNone, kMetres };

// The picture (one pixel per cell) enlarged, with paths, and below it a scale bar and a legend.
RgbImage AnnotatedMap(const RgbImage& cells, const GridGeometry& geometry,
                      const std::vector<Path>& paths, PathDot dot = PathDot::kStart,
                      Lattice lattice = Lattice::kNone);

// The rectangle of the known cells, with a margin; empty if there are none.
GridGeometry KnownPart(const StateMap& map, int margin_cells);
// Extends `part` to the path with that margin, because a camera may be where it never saw the
// floor. Poses farther than a camera's range from `part` (from the path's start if it is empty) are
// left out, so that an outlier does not make the picture huge.
GridGeometry WithPath(GridGeometry part, const Trajectory& path, int margin_cells);
// The whole map if `part` is empty, so that a picture has at least one pixel.
GridGeometry OrAllOf(const StateMap& map, const GridGeometry& part);
// The rectangle that a picture of the map with these paths shows: both, and a margin of half a
// metre.
GridGeometry ShownPart(const StateMap& map, const std::vector<Path>& paths);

namespace palette {
// Distinguishable also with the common colour vision deficiencies (Okabe and Ito 2008).
constexpr Colour kTruth = {0, 158, 115};
constexpr Colour kSlam = {230, 159, 0};
constexpr Colour kEstimate = {0, 114, 178};
constexpr Colour kMissed = {213, 94, 0};
constexpr Colour kInvented = {204, 121, 167};
}  // namespace palette

}  // namespace depthgrid
