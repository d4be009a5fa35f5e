#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "eval/cli/command_output.h"
#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/cli/experiment_argument.h"
#include "eval/cli/shader_cache.h"
#include "eval/doubts/truth_check.h"
#include "eval/doubts/units_check.h"
#include "eval/files/shell_word.h"
#include "eval/output/run_folder.h"
#include "eval/run/experiment.h"
#include "eval/run/synthetic_source.h"
#include "eval/run/world.h"
#include "mapper/io/config.h"
#include "mapper/io/file.h"
#include "mapper/io/tum_folder.h"
#include "sim/colour/colour_camera.h"

namespace depthgrid::cli {
namespace {

// A frame that has been written.
struct Written {
  bool shows = false;  // has a depth anywhere
};

// Writes the images of one frame. A colour camera's context belongs to a thread, so each thread
// makes its own.
Written WriteFrame(const World& world, const SyntheticSensor& sensor, const TumFolderWriter& writer,
                   bool with_colour, int frame) {
  const StampedPose& pose = world.trajectory[static_cast<std::size_t>(frame)];
  const DepthImage depth = sensor.Image(frame);
  const Written written = {
      std::any_of(depth.z_m.begin(), depth.z_m.end(), [](float z_m) { return z_m > 0.0F; })};
  if (!with_colour) {
    writer.WriteFrame(pose.stamp_s, depth, nullptr);
    return written;
  }
  thread_local std::unique_ptr<ColourCamera> camera;
  if (!camera) camera = std::make_unique<ColourCamera>(world.scene, world.camera);
  const auto movers = world.movers.At(world.trajectory, static_cast<std::size_t>(frame));
  const RgbImage rgb = camera->Render(pose.world_from_camera, movers).rgb;
  writer.WriteFrame(pose.stamp_s, depth, &rgb);
  return written;
}

std::string NothingShown(const DepthRange& range) {
  const std::string range_text =
      std::isfinite(range.max_m)
          ? fmt::format(" that is {:g} to {:g} m away", range.min_m, range.max_m)
          : "";
  return "no depth image shows anything: the camera sees no surface" + range_text;
}

void RenderNamed(const RenderArguments& arguments) {
  const ExperimentOptions given = ExperimentOrScene(arguments.scene, arguments.common.set);
  OutputFolder folder =
      OpenOutput(arguments.common, ResultKind::kRender, InputsOf(arguments.scene, {given}));
  const int threads = ThreadsOr(arguments.common.threads);
  const std::string cache_folder = CacheFolder(arguments.common);
  KeepShadersInCache(arguments.common);
  const World world = LoadWorld(given, threads);
  Warn(DoubtsOfImages(arguments.scene, arguments.common.set));
  Warn(world.path_doubts);
  const ExperimentOptions options = Completed(given, world.scene);
  // Made first, so that its errors come now and not at the end.
  const TruthRecord truth = MakeTruth(world, options.mapper, threads);
  if (const auto doubt = DoubtOfUnits(world.scene)) Warn({*doubt});
  if (const auto doubt = DoubtOfTruth(world, truth, options)) Warn({*doubt});
  const SyntheticSensor sensor(world, options, cache_folder);
  const TumFolderWriter writer(folder.work().string(), {.camera = world.camera});
  bool any_shows = false;
  {
    ProgressBar bar("rendering");
    OrderedFrames<Written> frames(sensor.FrameCount(), threads, [&](int frame) {
      return WriteFrame(world, sensor, writer, !arguments.no_colour, frame);
    });
    int done = 0;
    while (const auto written = frames.Next()) {
      any_shows = any_shows || written->shows;
      bar.Show(++done, sensor.FrameCount());
    }
  }
  if (!any_shows) Warn({NothingShown(world.depth_range)});
  writer.Finish(StampsOf(world.trajectory), !arguments.no_colour, world.trajectory);
  WriteTruthMaps(folder.work().string(), truth);
  WriteFile(folder.File("render.yaml"), ToYaml(options) + Provenance(&world));
  folder.Commit();
  const std::string& output = arguments.common.output;
  fmt::print("rendered {} in {}; the true map is {}/truth_map.yaml\n",
             Counted(sensor.FrameCount(), "frame"), output, output);
  fmt::print("go on with: depthgrid slam {} -o POSES\n", ShellWord(output));
}

}  // namespace

void Render(const RenderArguments& arguments) {
  NamingPlaces(PlacesOf(arguments.scene, arguments.common.set), [&] { RenderNamed(arguments); });
}

}  // namespace depthgrid::cli
