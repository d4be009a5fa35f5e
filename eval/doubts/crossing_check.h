// Whether a run's scans agree with the map that was drawn from them: without a truth, the only sign
// that poses are wrong in parts.
#pragma once

#include <optional>
#include <string>

#include "mapper/incremental_mapper.h"

namespace depthgrid {

// Of a sample of the run's kept beams with a hit, laid into the map at the final poses.
struct Crossing {
  int beams = 0;
  // Lead through walls of it (mapper/grid/crossed_walls.h): one wall was drawn in two places. Near
  // 0 where poses are right; who walks about adds hardly anything.
  double share = 0.0;
  // Frame::index of the scan with the most of them, if any.
  std::optional<int> worst_frame;
};

// Empty for runs without such beams, as for those that only localised themselves.
std::optional<Crossing> CrossingOf(const MapperResult& result);

// A warning when so many beams disagree that the map must be wrong in parts; a laser's names its
// own likely causes.
std::optional<std::string> DoubtOfCrossing(const Crossing& crossing, bool has_camera = true);
std::optional<std::string> DoubtOfCrossing(const MapperResult& result);

}  // namespace depthgrid
