#include "eval/doubts/truth_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "eval/doubts/storey_check.h"
#include "mapper/core/counted.h"

namespace depthgrid {
namespace {

std::size_t PosesInFree(const TruthRecord& truth) {
  const double cell_m = truth.map.geometry.resolution_m;
  return static_cast<std::size_t>(
      std::count_if(truth.trajectory.begin(), truth.trajectory.end(), [&](const StampedPose& pose) {
        const Eigen::Vector2d at_m = pose.world_from_camera.translation.head<2>();
        return truth.map.At(CellOf(at_m, cell_m)) == CellState::kFree;
      }));
}

}  // namespace

bool HasFree(const StateMap& map) {
  return std::find(map.states.begin(), map.states.end(), CellState::kFree) != map.states.end();
}

// Only most of the path counts: a hand-held camera may be above a table, whose cells are occupied.
std::optional<std::string> DoubtOfTruth(const TruthRecord& truth,
                                        const ExperimentOptions& options) {
  const ScanOptions& scan = options.mapper.scan;
  const std::size_t poses = truth.trajectory.size();
  const std::size_t others = poses - PosesInFree(truth);
  std::string what;
  if (!HasFree(truth.map)) {
    what = "the true map has no free cell";
  } else if (2 * others > poses) {
    what = fmt::format("{} of {} of the camera's path lie where the true map is not free", others,
                       Counted(poses, "pose"));
  } else {
    return {};
  }
  return fmt::format(
      "{}: {}: surfaces are {:g} to {:g} m (mapper.scan.band_low_m, band_high_m) above a floor at "
      "{:g} m there; the mesh's faces may point away from the room, or floor_z_m may be wrong",
      options.scene, what, scan.band_low_m, scan.band_high_m, scan.floor_z_m);
}

std::optional<std::string> DoubtOfStorey(const World& world, const ExperimentOptions& options) {
  const auto doubt = DoubtOfStorey(world.trajectory, world.scene, world.rays);
  if (!doubt) return {};
  return PlaceOfPath(world.scene, options) + ": " + *doubt;
}

std::optional<std::string> DoubtOfTruth(const World& world, const TruthRecord& truth,
                                        const ExperimentOptions& options) {
  auto doubt = DoubtOfStorey(world, options);
  return doubt ? doubt : DoubtOfTruth(truth, options);
}

}  // namespace depthgrid
