#include <fmt/format.h>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/cli/experiment_argument.h"
#include "eval/experiment/idle_settings.h"
#include "eval/experiment/seed_range.h"
#include "eval/run/world.h"
#include "mapper/core/error.h"
#include "sim/slam/slam_calibration.h"

namespace depthgrid::cli {
namespace {

IdleSettingList OfNoUse() {
  IdleSettingList idle;
  for (const char* key : {"mapper", "metrics", "movers", "sensor.noise", "depth_seed"}) {
    idle.push_back({key, "only SLAM's own poses are looked at"});
  }
  return idle;
}

void CalibrateNamed(const SlamCalibrateArguments& arguments) {
  for (const char* key : {"seed", "slam_seed"}) {
    RequireNotSet(arguments.common.set, key, "give --first-seed N");
  }
  RequireNotSet(arguments.common.set, "slam.drift_scale", "is what this command finds");
  RequireSeeds("--first-seed", arguments.first_seed, arguments.seeds);
  const ExperimentOptions options = ExperimentOrScene(arguments.experiment, arguments.common.set);
  const World world = LoadWorld(options, ThreadsOr(arguments.common.threads));
  Warn(DoubtsOfRecord(arguments.experiment, arguments.common.set));
  Warn(
      DoubtsOfOverrides(arguments.common.set, OfNoUse(), [&](const std::vector<std::string>& some) {
        return ToYaml(ExperimentOrScene(arguments.experiment, some));
      }));
  Warn(world.path_doubts);
  const SeedRange seeds = {arguments.first_seed, arguments.seeds};
  const DriftCalibration found =
      CalibrateDrift(world.trajectory, options.slam, arguments.target_m, seeds);
  if (!found.reached && found.mean_error_m == 0.0) {
    throw SettingError("slam.profile", fmt::format("is {}, whose poses have no error to scale: "
                                                   "choose another with --set slam.profile=NAME",
                                                   ValueOf(options, "slam.profile")));
  }
  if (!found.reached) {
    throw InputError("--target",
                     fmt::format("is {} m, but with drift_scale {} the error is {:.4f} m",
                                 arguments.target_m, found.drift_scale, found.mean_error_m));
  }
  fmt::print(
      "# mean live error {:.4f} m in xy, not aligned, over {} and {}\n"
      "slam: {{drift_scale: {:.4g}}}\n",
      found.mean_error_m, Counted(world.trajectory.size(), "frame"), Counted(seeds.count, "seed"),
      found.drift_scale);
}

}  // namespace

void SlamCalibrate(const SlamCalibrateArguments& arguments) {
  NamingPlaces(PlacesOf(arguments.experiment, arguments.common.set),
               [&] { CalibrateNamed(arguments); });
}

}  // namespace depthgrid::cli
