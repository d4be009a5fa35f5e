// Every setting of the mapper; each group is documented beside its class.
#pragma once

#include "mapper/adjustment_rounds.h"
#include "mapper/core/options.h"
#include "mapper/fuse/fusion_options.h"
#include "mapper/graph/scan_submap_graph.h"
#include "mapper/grid/grid_options.h"
#include "mapper/grid/submap.h"
#include "mapper/loop_closing.h"
#include "mapper/match/scan_matcher.h"
#include "mapper/scan/scan_options.h"
#include "mapper/scan_keeping.h"
#include "mapper/surfel/surfel_map.h"

namespace depthgrid {

enum class MapperMethod { kPaper, kSurfel };

struct MapperOptions {
  // The surfel method's errors are a fourth (rendered rooms) to a hundredth (laser logs) of the
  // paper's (docs/results.md, "The paper's experiment" and "The paper's chain on laser logs").
  MapperMethod method = MapperMethod::kSurfel;
  ScanOptions scan;
  GridOptions grid;
  SubmapOptions submap;
  ScanMatcherOptions match;
  FusionOptions fusion;
  LoopOptions loops;
  GraphOptions graph;
  SurfelOptions surfel;
  RoundOptions rounds;
  KeepOptions keep;

  // `auto`: only method surfel searches; the published method does not.
  bool SearchesLoops() const {
    return loops.search.use == LoopSearchUse::kOn ||
           (loops.search.use == LoopSearchUse::kAuto && method == MapperMethod::kSurfel);
  }
  void Visit(OptionsVisitor& v);
};

}  // namespace depthgrid
