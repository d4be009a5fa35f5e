// Maps as ROS's map_server and Nav2 keep them: a YAML file beside an image (docs/formats.md,
// "Maps").
#pragma once

#include <string>
#include <vector>

#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// How a pixel's shade is read, with p = (255 - x) / 255, or x / 255 when `negate` is set:
// trinary: p above occupied_thresh is occupied, below free_thresh free, anything else unknown;
// scale:   the same, but the shades between the thresholds are probabilities and only transparent
//          pixels unknown;
// raw:     x is the occupancy in percent, above 100 unknown.
enum class MapMode { kTrinary, kScale, kRaw };

// A map as read. The thresholds of the file have been applied: certain cells have probability 0 or
// 1, unknown ones NaN, so that StatesOf gives the states Nav2 gives.
struct MapFile {
  OccupancyMap map;
  // From the frame of the map's cells to the world the file speaks of, or to the frame that was
  // asked for: the identity unless the origin has a yaw there or is no multiple of the resolution.
  Pose2 world_from_grid;
  bool negate = false;
  // What of the YAML is allowed but likely of another unit, a line each.
  std::vector<std::string> doubts;
};

// Throws InputError for a missing, unreadable or contradictory YAML or image (PGM or PNG).
// `world_from_frame`: such as another map's world_from_grid, in whose cells this one is wanted.
MapFile ReadMap(const std::string& yaml_path, const Pose2& world_from_frame = {});

// The map redrawn on cells along the world's axes, or the frame's: each takes the value of the cell
// its centre falls into.
OccupancyMap AlignedMap(const MapFile& file);

// The states of a map file's cells, on the lattice.
StateMap ReadStates(const std::string& path, const Pose2& world_from_frame = {});

// The cells a map file calls free: in observable.yaml those that could be seen.
CellSet ReadFreeCells(const std::string& path);

// The image beside a map: the same name with .pgm, or for `scale`, which needs transparency,
// .scale.png.
std::string MapImageOf(const std::string& yaml_path, MapMode mode);

// Writes a map of at least one cell: `yaml_path` and the image beside it (MapImageOf). In `trinary`
// a cell is what StatesOf makes of it; the other modes keep probabilities, to 1/255 and 1 %.
// Throws InputError when both files would have one name, std::runtime_error when they cannot be
// written.
void WriteMap(const std::string& yaml_path, const OccupancyMap& map,
              MapMode mode = MapMode::kTrinary);
void WriteMap(const std::string& yaml_path, const StateMap& map);

}  // namespace depthgrid
