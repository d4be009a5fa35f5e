// Converts pixels of map images to probabilities and back (rules: mapper/io/map_file.h).
#pragma once

#include <string>
#include <vector>

#include "mapper/core/occupancy_map.h"
#include "mapper/io/map_file.h"

namespace depthgrid::internal {

struct ShadeRule {
  MapMode mode = MapMode::kTrinary;
  bool negate = false;
  StateThresholds thresholds;
};

struct ShadeImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<double> shade;  // 0 black, 1 white; row 0 at the top
  std::vector<bool> opaque;
};

// A PGM or PNG file, told apart by its first bytes.
ShadeImage ReadShades(const std::string& path, MapMode mode);

float OccupiedProb(double shade, bool opaque, const ShadeRule& rule);

// The thresholds in the YAML file of a map written in this mode.
StateThresholds WrittenThresholds(MapMode mode);

// The image file: PGM, or PNG with transparency for kScale. With WrittenThresholds every cell keeps
// its state.
std::string EncodeMapImage(const OccupancyMap& map, MapMode mode);

}  // namespace depthgrid::internal
