// Maps in the format of ROS's map_server and Nav2: a YAML file and an image (docs/formats.md,
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
  // From the frame of the map's cells to the file's world, or to the requested frame: the identity
  // unless the origin has a yaw there or is not a multiple of the resolution.
  Pose2 world_from_grid;
  bool negate = false;
  // Values of the YAML that are allowed but probably in a wrong unit, one line each.
  std::vector<std::string> doubts;
};

// Throws InputError for a missing, unreadable or contradictory YAML or image (PGM or PNG).
// `world_from_frame`: the frame wanted for the cells, such as another map's world_from_grid.
MapFile ReadMap(const std::string& yaml_path, const Pose2& world_from_frame = {});

// The map resampled to cells along the axes of the world (or the requested frame): each takes the
// value of the cell that contains its centre.
OccupancyMap AlignedMap(const MapFile& file);

// The states of a map file's cells, on the lattice.
StateMap ReadStates(const std::string& path, const Pose2& world_from_frame = {});

// The free cells of a map file; in observable.yaml these are the observable ones.
CellSet ReadFreeCells(const std::string& path);

// The image beside a map: the same name with .pgm, or for `scale`, which needs transparency,
// .scale.png.
std::string MapImageOf(const std::string& yaml_path, MapMode mode);

// The map as it is written: itself, or a single unknown cell if it has none, as while nothing is
// mapped (image files have no empty form).
OccupancyMap MapToWrite(const OccupancyMap& map);

// Writes MapToWrite(map): `yaml_path` and the image beside it (MapImageOf). In `trinary` a cell is
// what StatesOf makes of it; the other modes keep probabilities, to 1/255 and 1 %. Throws
// InputError when both files would have one name, std::runtime_error when they cannot be written.
void WriteMap(const std::string& yaml_path, const OccupancyMap& map,
              MapMode mode = MapMode::kTrinary);
void WriteMap(const std::string& yaml_path, const StateMap& map);

}  // namespace depthgrid
