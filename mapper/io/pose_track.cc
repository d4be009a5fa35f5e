#include "mapper/io/pose_track.h"

#include <algorithm>

namespace depthgrid {
namespace {

// Stamps of poses at exactly the greatest gap differ from it by rounding, of 1.7e9 s by .24 us.
constexpr double kRoundingS = 1e-6;

}  // namespace

Pose3 Blend(const Pose3& a, const Pose3& b, double share_of_b) {
  if (a == b) return a;  // without rounding: HeldFrames() compares bits
  return {a.rotation.slerp(share_of_b, b.rotation).normalized(),
          a.translation + share_of_b * (b.translation - a.translation)};
}

SlamOutput SlamOutputOf(const Trajectory& trajectory) {
  SlamOutput slam;
  slam.live.reserve(trajectory.size());
  for (const auto& [stamp_s, pose] : trajectory) slam.live.push_back({stamp_s, pose, 0});
  slam.final = trajectory;
  return slam;
}

PoseTrack::PoseTrack(const std::vector<SlamPose>& live, const RecordingOptions& options)
    : options_(options), live_(live) {
  stamps_s_.reserve(live_.size());
  for (const SlamPose& pose : live_) stamps_s_.push_back(pose.stamp_s);
}

PoseTrack::Found PoseTrack::At(double stamp_s) const {
  const double pose_stamp_s = stamp_s + options_.time_offset_s;
  if (options_.interpolate_poses) return Interpolated(pose_stamp_s);
  const auto nearest = NearestStamp(stamps_s_, pose_stamp_s, options_.max_stamp_difference_s);
  if (!nearest) return {};
  return {live_[*nearest].slam_from_camera, live_[*nearest].epoch, nearest};
}

PoseTrack::Found PoseTrack::Interpolated(double stamp_s) const {
  const auto after = std::lower_bound(stamps_s_.begin(), stamps_s_.end(), stamp_s);
  if (after == stamps_s_.end()) return {};
  const auto b = static_cast<std::size_t>(after - stamps_s_.begin());
  if (*after == stamp_s) return {live_[b].slam_from_camera, live_[b].epoch, b};
  if (b == 0) return {};
  const std::size_t a = b - 1;
  const double gap_s = stamps_s_[b] - stamps_s_[a];
  // No interpolation between epochs: SLAM changed the frame of its poses.
  if (!live_[a].slam_from_camera || !live_[b].slam_from_camera ||
      live_[a].epoch != live_[b].epoch || gap_s > options_.max_interpolation_gap_s + kRoundingS) {
    return {};
  }
  const double share_of_b = (stamp_s - stamps_s_[a]) / gap_s;
  return {Blend(*live_[a].slam_from_camera, *live_[b].slam_from_camera, share_of_b), live_[a].epoch,
          share_of_b <= 0.5 ? a : b};
}

}  // namespace depthgrid
