// Where in a finished map a sequence begins.
#pragma once

#include <optional>

#include "mapper/core/frame.h"
#include "mapper/incremental_mapper.h"
#include "mapper/match/find_place.h"

namespace depthgrid {

// How well places in the map explained what was seen next, over so many frames.
struct StartTrial {
  int places = 0;
  int frames = 0;
  double explained = 0.0;       // mean share of a scan on the map, 0..1, of the place chosen
  double explained_next = 0.0;  // of the best one that led elsewhere
};

struct MapStart {
  FoundPlace place;
  std::optional<StartTrial> trial;  // where several places fitted the first views

  // Whether another place fits nearly as well.
  bool uncertain() const;
};

// The first views of `source` (of its first 3 m) are laid over the whole map. Where they fit in
// several places, the first metres are mapped from each, the map left as it is, and the place that
// explains most is taken. Nothing when no scan shows anything.
std::optional<MapStart> FindStart(const PriorMap& prior, FrameSource& source,
                                  const MapperOptions& options);

}  // namespace depthgrid
