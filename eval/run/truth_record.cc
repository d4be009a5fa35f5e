#include "eval/run/truth_record.h"

#include "mapper/io/map_file.h"
#include "mapper/scan/depth_to_scan.h"
#include "sim/truth/observable_cells.h"
#include "sim/truth/truth_grid.h"

namespace depthgrid {
namespace {

StateMap AsStates(const CellSet& cells) {
  StateMap states(cells.geometry);
  for (std::size_t i = 0; i < cells.members.size(); ++i) {
    states.states[i] = cells.members[i] != 0 ? CellState::kFree : CellState::kUnknown;
  }
  return states;
}

}  // namespace

TruthRecord MakeTruth(const World& world, const MapperOptions& options, int threads) {
  DepthToScan(world.camera, options.scan);  // throws if settings contradict each other
  const TruthGridOptions band = {options.grid.resolution_m, options.scan.band_low_m,
                                 options.scan.band_high_m};
  ObservableOptions seen;
  seen.min_range_m = options.scan.min_range_m;
  seen.max_range_m = options.scan.max_range_m;
  seen.min_depth_m = world.depth_range.min_m;
  seen.max_depth_m = world.depth_range.max_m;
  seen.threads = threads;
  const double floor_z_m = world.scene.floor_z_m;
  TruthRecord truth;
  truth.trajectory = world.trajectory;
  truth.map = TruthMap(world.scene.mesh, floor_z_m, world.trajectory, band);
  truth.observable = ObservableCells(world.scene.mesh, floor_z_m, truth.map, world.camera,
                                     world.trajectory, band, seen);
  return truth;
}

void WriteTruthMaps(const std::string& folder, const TruthRecord& truth) {
  WriteMap(folder + "/truth_map.yaml", truth.map);
  if (truth.observable) WriteMap(folder + "/observable.yaml", AsStates(*truth.observable));
}

}  // namespace depthgrid
