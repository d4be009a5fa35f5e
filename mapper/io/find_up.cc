#include "mapper/io/find_up.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <span>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "mapper/io/pose_track.h"
#include "mapper/io/world_up.h"

namespace depthgrid {
namespace {

// Number of images used for gravity.
constexpr int kGravityViews = 24;
// Number of images between the first two of them, to find up before SLAM drifts.
constexpr int kFirstGravityViews = 8;
// If SLAM's tilt drifts, up from the floor at one place is off by 1.5 degrees; such a small tilt is
// corrected per image anyway (FloorTracker).
constexpr double kDriftingAxisRad = RadFromDeg(3.0);

// The images for finding up: all with poses, so that the parts of a recording share a world; only
// the part if SLAM's poses cover little more.
std::vector<RecordedImage> ImagesForUp(const Recording& recording, const SlamOutput& slam,
                                       const RecordingOptions& options) {
  const PoseTrack track(slam.live, options);
  const auto with_pose = [&](std::span<const RecordedImage> images) {
    std::vector<RecordedImage> posed;
    std::copy_if(images.begin(), images.end(), std::back_inserter(posed),
                 [&](const RecordedImage& image) {
                   return track.At(image.stamp_s).slam_from_camera.has_value();
                 });
    return posed;
  };
  const std::vector<RecordedImage> all = with_pose(recording.images);
  return MostLackPoses(all.size(), recording.images.size()) ? with_pose(ImagesOfPart(recording))
                                                            : all;
}

}  // namespace

std::optional<Gravity> FindGravity(const Recording& recording, const SlamOutput& slam,
                                   const DepthReader& reader, const RecordingOptions& options) {
  std::vector<RecordedImage> chosen;
  const std::vector<RecordedImage> images = ImagesForUp(recording, slam, options);
  const std::size_t every = std::max<std::size_t>(1, images.size() / kGravityViews);
  const std::size_t every_first = std::max<std::size_t>(1, every / kFirstGravityViews);
  std::set<double> spread_s;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const bool spread = i % every == 0;
    if (!spread && !(i < every && i % every_first == 0)) continue;
    chosen.push_back(images[i]);
    if (spread) spread_s.insert(images[i].stamp_s);
  }
  GravityFinder finder;
  try {
    const auto source =
        OpenRecording(WithImages(recording, std::move(chosen)), slam, options, reader);
    const double first_end_s =
        images.empty() ? 0.0 : images[std::min(every, images.size() - 1)].stamp_s;
    while (const auto frame = source->Next()) {
      if (!frame->depth || !frame->slam_from_camera) continue;
      const Pose3& pose = *frame->slam_from_camera;
      if (spread_s.contains(frame->stamp_s)) finder.Add(*frame->depth, *source->Camera(), pose);
      if (frame->stamp_s < first_end_s) finder.AddFirst(*frame->depth, *source->Camera(), pose);
    }
  } catch (const InputError&) {
    return {};  // the error is reported when the whole recording is opened
  }
  return finder.Find();
}

Eigen::Vector3d SnappedUp(const Gravity& gravity) {
  const double unsure_rad =
      gravity.drifts ? std::max(gravity.wander_rad, kDriftingAxisRad) : gravity.wander_rad;
  const WorldUp axis = NearestAxis(gravity.up_in_world, unsure_rad);
  return axis == WorldUp::kAuto ? gravity.up_in_world : AxisOf(axis);
}

std::string ShownUp(const Eigen::Vector3d& up) {
  const WorldUp axis = NearestAxis(up);
  return axis == WorldUp::kAuto ? fmt::format("({:.3f}, {:.3f}, {:.3f})", up.x(), up.y(), up.z())
                                : NameOf(axis);
}

}  // namespace depthgrid
