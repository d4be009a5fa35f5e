// The simulated sensor as a frame source: depth images rendered (or taken from the cache), with
// noise and quantised as in a PNG, ahead of the mapper on several threads.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eval/experiment/experiment_options.h"
#include "eval/run/depth_cache.h"
#include "eval/run/ordered_frames.h"
#include "eval/run/world.h"
#include "mapper/core/frame.h"
#include "mapper/core/slam_output.h"
#include "sim/depth/depth_camera.h"
#include "sim/depth/depth_noise.h"
#include "sim/scene/mover_scene.h"

namespace depthgrid {

// Frame i of the sensor: a pure function of the world, the options and i.
class SyntheticSensor {
 public:
  // Noise-free depth of the static scene comes from the cache if it is there; folder "": no cache.
  SyntheticSensor(const World& world, const ExperimentOptions& options,
                  const std::string& cache_folder);

  DepthImage Image(int frame) const;
  int FrameCount() const { return static_cast<int>(trajectory_.size()); }
  const PinholeCamera& camera() const { return camera_.camera(); }

 private:
  DepthFrame Clean(std::size_t frame) const;
  DepthFrame Room(const Pose3& world_from_camera) const;

  DepthCamera camera_;
  MoverScene movers_;
  MoverCamera mover_camera_;
  DepthNoise noise_;
  std::uint64_t seed_;
  Trajectory trajectory_;
  std::optional<DepthCache> cache_;
};

// SLAM's output frame by frame, without depth images.
class SlamPlayback {
 public:
  // The frame at position `index` of `slam`, with the loops reported since the last call.
  Frame FrameAt(int index, const SlamOutput& slam);

 private:
  std::size_t next_loop_ = 0;
};

class SyntheticSource final : public FrameSource {
 public:
  // `slam.live` has one entry per frame.
  SyntheticSource(const SyntheticSensor& sensor, SlamOutput slam, int threads);

  std::optional<Frame> Next() override;
  std::optional<PinholeCamera> Camera() const override { return camera_; }
  int FrameCount() const override { return static_cast<int>(slam_.live.size()); }
  std::vector<std::string> Warnings() const override { return {}; }

 private:
  PinholeCamera camera_;
  SlamOutput slam_;
  int next_ = 0;
  SlamPlayback playback_;
  OrderedFrames<std::shared_ptr<const DepthImage>> images_;
};

}  // namespace depthgrid
