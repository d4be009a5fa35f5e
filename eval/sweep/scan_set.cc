#include "eval/sweep/scan_set.h"

#include "eval/files/hash.h"
#include "eval/run/experiment.h"
#include "mapper/io/config.h"
#include "sim/slam/slam_surrogate.h"

namespace depthgrid {
namespace {

// Incremented whenever the same input may give other scans.
constexpr int kScanFormat = 15;

void Add(ContentHash& hash, const Pose3& pose) {
  for (const double v : pose.rotation.coeffs()) hash.Value(v);
  for (const double v : pose.translation) hash.Value(v);
}

ContentHash DepthHash(const ScanSet& set) {
  ContentHash hash;
  hash.Text(DEPTHGRID_VERSION);
  hash.Text(DEPTHGRID_ARCH);
  hash.Value(kScanFormat);
  hash.Text(set.world->hashes.scene);
  hash.Text(ToYaml(set.options.sensor));
  hash.Value(set.options.DepthSeed());
  hash.Value(set.world->trajectory.size());
  for (const StampedPose& pose : set.world->trajectory) {
    hash.Value(pose.stamp_s);  // it determines where the movers are
    Add(hash, pose.world_from_camera);
  }
  return hash;
}

}  // namespace

ScanSet MakeSet(const ExperimentOptions& options, std::shared_ptr<const World> world) {
  ScanSet set;
  set.options = Completed(options, world->scene);
  set.slam = DisturbTrajectory(world->trajectory, set.options.slam, set.options.SlamSeed());
  set.world = std::move(world);
  return set;
}

std::string DepthKey(const ScanSet& set) { return DepthHash(set).Hex(); }

std::string ContentKey(const ScanSet& set) {
  ContentHash hash = DepthHash(set);
  hash.Text(ToYaml(set.options.mapper.scan));
  for (const SlamPose& pose : set.slam.live) {
    hash.Value(pose.stamp_s);
    hash.Value(pose.epoch);
    hash.Value(pose.slam_from_camera.has_value());
    if (pose.slam_from_camera) Add(hash, *pose.slam_from_camera);
  }
  return hash.Hex();
}

std::size_t BytesOf(const ScanSet& set) {
  constexpr std::size_t kScansAFrame = 2;
  return set.slam.live.size() * static_cast<std::size_t>(set.options.mapper.scan.beams) *
         sizeof(Beam) * kScansAFrame;
}

std::optional<Frame> ScannedSource::Next() {
  if (next_ == FrameCount()) return std::nullopt;
  const FrameScans& scans = set_.scans[static_cast<std::size_t>(next_)];
  Frame frame = playback_.FrameAt(next_++, set_.slam);
  frame.scan = scans.obstacles;
  frame.matched_scan = scans.matched;
  frame.stand = scans.stand;
  return frame;
}

}  // namespace depthgrid
