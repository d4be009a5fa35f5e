// Maps as pictures a person reads: states in colours, true against estimated, and the map with its
// trajectories and a scale bar.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/pictures/path_drawing.h"
#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"

namespace depthgrid {

// One pixel a cell, north (largest y) up, over the given rectangle.
RgbImage PictureOf(const OccupancyMap& map, const GridGeometry& geometry);
RgbImage PictureOf(const StateMap& map, const GridGeometry& geometry);
RgbImage PictureOf(const CellSet& cells, const GridGeometry& geometry);
// Where the estimate agrees with the truth about walls, where it misses one and where it invents
// one; cells outside `observable` are paler.
RgbImage DifferencePicture(const StateMap& truth, const StateMap& estimate,
                           const std::optional<CellSet>& observable, const GridGeometry& geometry);

// Lines at whole metres of the map's frame (of a large map at whole tens and so on), numbered along
// the top and the left edge.
enum class Lattice { kNone, kMetres };

// The picture (one pixel a cell) enlarged, with paths, and below it a scale bar and a legend of as
// many lines as it takes.
RgbImage AnnotatedMap(const RgbImage& cells, const GridGeometry& geometry,
                      const std::vector<Path>& paths, PathDot dot = PathDot::kStart,
                      Lattice lattice = Lattice::kNone);

// The part of the map that holds anything but unknown cells, with a margin; empty if nothing does.
GridGeometry KnownPart(const StateMap& map, int margin_cells);
// `part` and the path with that margin: a camera may stand where it never saw the floor. Poses more
// than a camera's range away from it, or from the path's start if it is empty, are left out, so
// that no stray one makes a huge picture.
GridGeometry WithPath(GridGeometry part, const Trajectory& path, int margin_cells);
// All of the map in place of an empty part: a picture has a pixel at least.
GridGeometry OrAllOf(const StateMap& map, const GridGeometry& part);
// What a picture of the map with these paths shows: both, and half a metre around.
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
