#include "eval/run/synthetic_source.h"

#include "mapper/core/error.h"
#include "mapper/io/png.h"

namespace depthgrid {

SyntheticSensor::SyntheticSensor(const World& world, const ExperimentOptions& options,
                                 const std::string& cache_folder)
    : camera_(world.rays, world.camera),
      movers_(world.movers),
      mover_camera_(world.movers, world.camera),
      noise_(options.sensor),
      seed_(options.DepthSeed()),
      trajectory_(world.trajectory) {
  if (cache_folder.empty()) return;
  cache_.emplace(cache_folder, world.hashes.room, world.camera, world.rays.isa());
  cache_->MakeRoomFor(trajectory_, noise_.NeedsIncidence());
}

DepthFrame SyntheticSensor::Clean(std::size_t frame) const {
  const Pose3& world_from_camera = trajectory_[frame].world_from_camera;
  DepthFrame clean = Room(world_from_camera);
  mover_camera_.DrawOver(world_from_camera, movers_.At(trajectory_, frame), clean);
  return clean;
}

DepthFrame SyntheticSensor::Room(const Pose3& world_from_camera) const {
  const bool with_incidence = noise_.NeedsIncidence();
  if (cache_) {
    auto cached = cache_->Load(world_from_camera, with_incidence);
    if (cached) return std::move(*cached);
  }
  DepthFrame clean;
  if (with_incidence) {
    clean = camera_.RenderWithIncidence(world_from_camera);
  } else {
    clean.depth = camera_.Render(world_from_camera);
  }
  if (cache_) cache_->Store(world_from_camera, clean);
  return clean;
}

DepthImage SyntheticSensor::Image(int frame) const {
  return QuantiseDepth(noise_.Apply(Clean(static_cast<std::size_t>(frame)), seed_,
                                    static_cast<std::uint32_t>(frame)));
}

SyntheticSource::SyntheticSource(const SyntheticSensor& sensor, SlamOutput slam, int threads)
    : camera_(sensor.camera()),
      slam_(std::move(slam)),
      images_(sensor.FrameCount(), threads, [&sensor](int frame) {
        return std::make_shared<const DepthImage>(sensor.Image(frame));
      }) {
  Require(sensor.FrameCount() == FrameCount(), "SLAM says something of every frame");
}

Frame SlamPlayback::FrameAt(int index, const SlamOutput& slam) {
  const SlamPose& pose = slam.live[static_cast<std::size_t>(index)];
  Frame frame;
  frame.index = index;
  frame.stamp_s = pose.stamp_s;
  frame.slam_from_camera = pose.slam_from_camera;
  frame.slam_epoch = pose.epoch;
  for (; next_loop_ < slam.loops.size() && slam.loops[next_loop_].reported_at_frame <= index;
       ++next_loop_) {
    frame.loops.push_back(slam.loops[next_loop_]);
  }
  return frame;
}

std::optional<Frame> SyntheticSource::Next() {
  auto image = images_.Next();
  if (!image) return std::nullopt;
  Frame frame = playback_.FrameAt(next_++, slam_);
  frame.depth = std::move(*image);
  return frame;
}

}  // namespace depthgrid
