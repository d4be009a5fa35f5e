// The whole frame: what `depthgrid map` does with each, from a ready scan and from a depth image,
// and the adjustment at the end. References: the paper's chain with exhaustive search and Ceres;
// the image copied; the frames' own mapping.
#include <algorithm>

#include "bench/bench_data.h"
#include "bench/bench_table.h"
#include "mapper/core/level.h"
#include "mapper/incremental_mapper.h"

namespace depthgrid::bench {
namespace {

// A fixed stretch of a run, whatever a repetition's length: adjustments come after 60, 180, 540 and
// 1,620 frames and take the time of a hundred frames.
struct Stretch {
  int before = 0;
  int frames = 0;
};
constexpr Stretch kScans{600, 600};       // one round, without an adjustment
constexpr Stretch kWholeRun{0, 2400};     // with four
constexpr Stretch kPlainScans{100, 200};  // milliseconds each
constexpr Stretch kImages{240, 240};      // twice to and fro, without an adjustment

MapperOptions OptionsOf(MapperMethod method) {
  MapperOptions options;
  options.method = method;
  if (method == MapperMethod::kSurfel) options.fusion.mode = FusionMode::kLearned;
  return options;
}

MapperOptions PlainPaper() {
  MapperOptions options = OptionsOf(MapperMethod::kPaper);
  options.match.search.method = SearchMethod::kReference;
  options.match.least_squares.method = SolverMethod::kCeres;
  return options;
}

// Frames of an endlessly repeated walk with a drifting prior.
class EndlessScans {
 public:
  explicit EndlessScans(int beams) : walk_(LaserWalkOf(beams)) { odometry_.Start(walk_.truth[0]); }
  Frame Next() {
    const std::size_t size = walk_.truth.size();
    const auto i = static_cast<std::size_t>(next_);
    Frame frame;
    frame.index = next_++;
    frame.stamp_s = frame.index / 30.0;
    frame.scan = walk_.scans[i % size];
    const Pose2 motion =
        i == 0 ? Pose2{} : Between(walk_.truth[(i - 1) % size], walk_.truth[i % size]);
    frame.slam_from_camera = CameraOf(odometry_.Next(motion), 0.0);
    return frame;
  }

 private:
  const LaserWalk& walk_;
  DriftingOdometry odometry_;
  int next_ = 0;
};

Loop ScanFrameLoop(const MapperOptions& options, int beams, int before) {
  return [=](benchmark::State& state) {
    EndlessScans source(beams);
    IncrementalMapper mapper(options, std::nullopt);
    for (int k = 0; k < before; ++k) mapper.AddFrame(source.Next());
    for (auto _ : state) benchmark::DoNotOptimize(mapper.AddFrame(source.Next()));
  };
}

Loop DepthFrameLoop(const MapperOptions& options, int width_px) {
  return [=](benchmark::State& state) {
    const DepthWalk& walk = DepthStrollOf(width_px, width_px * 3 / 4);
    std::vector<std::shared_ptr<const DepthImage>> images;
    for (const DepthImage& image : walk.noisy) {
      images.push_back(std::make_shared<const DepthImage>(image));
    }
    IncrementalMapper mapper(options, walk.camera);
    int index = 0;
    const auto next = [&] {
      const auto k = static_cast<std::size_t>(index) % (2 * images.size());
      const std::size_t i = std::min(k, 2 * images.size() - 1 - k);  // to and fro
      Frame frame;
      frame.index = index;
      frame.stamp_s = index++ / 30.0;
      frame.depth = images[i];
      frame.slam_from_camera = walk.poses[i];
      return frame;
    };
    for (int k = 0; k < kImages.before; ++k) mapper.AddFrame(next());
    for (auto _ : state) benchmark::DoNotOptimize(mapper.AddFrame(next()));
  };
}

// Maps `frames` scans; times the mapping or, with `finish`, only the end.
Loop RunLoop(const MapperOptions& options, int frames, bool finish) {
  return [=](benchmark::State& state) {
    for (auto _ : state) {
      state.PauseTiming();
      EndlessScans source(640);
      IncrementalMapper mapper(options, std::nullopt);
      if (!finish) state.ResumeTiming();
      for (int k = 0; k < frames; ++k) mapper.AddFrame(source.Next());
      if (!finish) continue;
      state.ResumeTiming();
      benchmark::DoNotOptimize(mapper.Finish());
    }
  };
}

const char* NameOf(MapperMethod method) {
  return method == MapperMethod::kPaper ? "paper" : "surfel";
}

[[maybe_unused]] const bool added = [] {
  for (const MapperMethod method : {MapperMethod::kPaper, MapperMethod::kSurfel}) {
    const std::string name = NameOf(method);
    const MapperOptions options = OptionsOf(method);
    for (const int beams : {160, 640}) {
      const std::string floor = "paper, exhaustive, Ceres @ " + std::to_string(beams);
      AddFloor(floor, ScanFrameLoop(PlainPaper(), beams, kPlainScans.before), kPlainScans.frames);
      const std::string row = name + ", scan of " + std::to_string(beams) + " beams";
      AddCase({"whole frame", row, floor, ScanFrameLoop(options, beams, kScans.before), false,
               kScans.frames});
      if (beams != 640 || method != MapperMethod::kSurfel) continue;
      AddCase({"whole frame", row + ", adjustments too", floor,
               ScanFrameLoop(options, beams, kWholeRun.before), false, kWholeRun.frames});
    }
    for (const int width_px : {320, 640}) {
      const std::string size = std::to_string(width_px) + "x" + std::to_string(width_px * 3 / 4);
      AddCase({"whole frame", name + ", depth image " + size, size + " image copied",
               DepthFrameLoop(options, width_px), false, kImages.frames});
    }
    for (const int frames : {600, 2400}) {
      const std::string run = "mapping these frames @ " + name + std::to_string(frames);
      AddFloor(run, RunLoop(options, frames, false));
      AddCase({"final adjustment and map", name + ", " + std::to_string(frames) + " frames", run,
               RunLoop(options, frames, true), frames > 1000});
    }
  }
  return true;
}();

}  // namespace
}  // namespace depthgrid::bench
