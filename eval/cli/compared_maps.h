// The maps that `depthgrid eval map` compares, on one grid.
#pragma once

#include <optional>
#include <string>

#include "eval/cli/commands.h"
#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/io/map_file.h"

namespace depthgrid::cli {

struct MapFiles {
  MapFile reference;
  MapFile estimate;  // in the frame of the reference's cells
};
// Throws InputError for a run's folder in place of a map, and for half-written results.
MapFiles ReadMapFiles(const EvalMapArguments& arguments);

// Both maps in cells of the larger of the two sizes, the estimate on the reference's grid; the
// reference is not resampled.
struct ComparedMaps {
  StateMap truth;
  OccupancyMap estimate;
  std::string observable_path;        // empty without one
  std::optional<CellSet> observable;  // in cells of the same size
  // How the estimate was resampled or one of them coarsened; empty if it was not.
  std::string redrawn_note;
  std::string coarsened_note;

  bool AreCoarsened() const { return !coarsened_note.empty(); }
  bool IsRedrawn() const { return !redrawn_note.empty(); }
};
// Throws InputError for maps whose cells cannot be compared.
ComparedMaps OnOneGrid(const MapFiles& files, const EvalMapArguments& arguments);

}  // namespace depthgrid::cli
