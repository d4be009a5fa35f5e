// The tables of scores that `eval map` prints.
#pragma once

#include "eval/metrics/map_metrics.h"

namespace depthgrid::cli {

// The quality must have been scored.
void PrintMapScore(const MapScore& score);

}  // namespace depthgrid::cli
