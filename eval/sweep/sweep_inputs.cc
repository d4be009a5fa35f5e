#include "eval/sweep/sweep_inputs.h"

#include <fmt/format.h>

namespace depthgrid {
namespace {

// Everything that LoadWorld reads.
std::string WorldKey(const ExperimentOptions& options) {
  const PinholeCamera camera = SensorCamera(options.sensor);
  const DepthRange range = SensorRange(options.sensor);
  return fmt::format("{}\n{}\n{}\n{} {}\n{} {} {} {} {} {} {} {} {}", options.scene,
                     options.trajectory, options.movers, options.frames, options.trajectory_seed,
                     camera.width_px, camera.height_px, camera.fx_px, camera.fy_px, camera.cx_px,
                     camera.cy_px, range.min_m, range.max_m, static_cast<int>(options.sensor.isa));
}

// In addition everything that MakeTruth reads.
std::string TruthKey(const ExperimentOptions& options) {
  const ScanOptions& scan = options.mapper.scan;
  return fmt::format("{}\n{} {} {} {} {}", WorldKey(options), options.mapper.grid.resolution_m,
                     scan.band_low_m, scan.band_high_m, scan.min_range_m, scan.max_range_m);
}

}  // namespace

std::shared_ptr<const World> SweepInputs::WorldOf(const ExperimentOptions& options) {
  return worlds_.Get(WorldKey(options), [&] { return LoadWorld(options, threads_); });
}

std::shared_ptr<const TruthRecord> SweepInputs::TruthOf(const ExperimentOptions& options) {
  return truths_.Get(TruthKey(options),
                     [&] { return MakeTruth(*WorldOf(options), options.mapper, threads_); });
}

}  // namespace depthgrid
