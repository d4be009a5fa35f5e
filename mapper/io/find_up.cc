#include "mapper/io/find_up.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "mapper/core/pose3.h"
#include "mapper/io/pose_track.h"

namespace depthgrid {
namespace {

// Number of images used for gravity.
constexpr int kGravityViews = 24;
// Number of images between the first two of them, to find up before SLAM drifts.
constexpr int kFirstGravityViews = 8;
// If SLAM's tilt drifts, up from the floor at one place is off by 1.5 degrees; such a small tilt is
// corrected per image anyway (FloorTracker).
constexpr double kMostSnapRad = RadFromDeg(3.0);
// An image is nearly the same as another if the camera moved by less than both.
constexpr double kSameM = 0.1;
constexpr double kSameRad = RadFromDeg(10.0);
// With fewer images that differ, all are used: together they show more of a small floor.
constexpr std::size_t kFewestMoving = 8;

struct PosedImage {
  RecordedImage image;
  Pose3 slam_from_camera;
};
using PosedImages = std::vector<PosedImage>;

// The images for finding up: all with poses, so that the parts of a recording share a world; only
// the part if SLAM's poses cover little more.
PosedImages ImagesForUp(const Recording& recording, const SlamOutput& slam,
                        const RecordingOptions& options) {
  const PoseTrack track(slam.live, options);
  const auto with_pose = [&](std::span<const RecordedImage> images) {
    PosedImages posed;
    for (const RecordedImage& image : images) {
      if (const auto pose = track.At(image.stamp_s).slam_from_camera)
        posed.push_back({image, *pose});
    }
    return posed;
  };
  PosedImages all = with_pose(recording.images);
  return MostLackPoses(all.size(), recording.images.size()) ? with_pose(ImagesOfPart(recording))
                                                            : all;
}

// Without those during which the camera stands, so that what it sees meanwhile counts once.
PosedImages Moving(const PosedImages& images) {
  PosedImages moving;
  for (const PosedImage& image : images) {
    if (!moving.empty()) {
      const Pose3 motion = Inverse(moving.back().slam_from_camera) * image.slam_from_camera;
      if (motion.translation.norm() < kSameM && LogRotation(motion.rotation).norm() < kSameRad) {
        continue;
      }
    }
    moving.push_back(image);
  }
  return moving.size() < kFewestMoving ? images : moving;
}

// The stamps of about `count` of them, the first among them.
std::vector<double> StampsOfSome(std::span<const PosedImage> images, std::size_t count) {
  const std::size_t every = std::max<std::size_t>(1, images.size() / count);
  std::vector<double> stamps_s;
  for (std::size_t i = 0; i < images.size(); i += every)
    stamps_s.push_back(images[i].image.stamp_s);
  return stamps_s;
}

// The images up to the second of the spread ones.
std::span<const PosedImage> FirstOf(const PosedImages& images,
                                    const std::vector<double>& spread_s) {
  const auto end = std::find_if(images.begin(), images.end(), [&](const PosedImage& image) {
    return spread_s.size() > 1 && image.image.stamp_s >= spread_s[1];
  });
  return {images.begin(), end};
}

}  // namespace

std::optional<Gravity> FindGravity(const Recording& recording, const SlamOutput& slam,
                                   const DepthReader& reader, const RecordingOptions& options) {
  const PosedImages images = ImagesForUp(recording, slam, options);
  const auto spread_s = StampsOfSome(Moving(images), kGravityViews);
  const auto first_s = StampsOfSome(FirstOf(images, spread_s), kFirstGravityViews);
  const std::set<double> spread(spread_s.begin(), spread_s.end());
  const std::set<double> first(first_s.begin(), first_s.end());
  std::vector<RecordedImage> chosen;
  for (const auto& [image, pose] : images) {
    if (spread.contains(image.stamp_s) || first.contains(image.stamp_s)) chosen.push_back(image);
  }
  GravityFinder finder;
  try {
    const auto source =
        OpenRecording(WithImages(recording, std::move(chosen)), slam, options, reader);
    while (const auto frame = source->Next()) {
      if (!frame->depth || !frame->slam_from_camera) continue;
      const Pose3& pose = *frame->slam_from_camera;
      if (spread.contains(frame->stamp_s)) finder.Add(*frame->depth, *source->Camera(), pose);
      if (first.contains(frame->stamp_s)) finder.AddFirst(*frame->depth, *source->Camera(), pose);
    }
  } catch (const InputError&) {
    return {};  // the error is reported when the whole recording is opened
  }
  return finder.Find(options.upside_down);
}

Eigen::Vector3d SnappedUp(const Gravity& gravity, WorldUp usual_up) {
  const Eigen::Vector3d usual = AxisOf(usual_up);
  const double usual_rad =
      gravity.drifts ? kMostSnapRad : std::min(gravity.wander_rad, kMostSnapRad);
  if (gravity.up_in_world.dot(usual) > std::cos(usual_rad)) return usual;
  const double unsure_rad =
      gravity.drifts ? kMostSnapRad : std::min(gravity.error_rad, kMostSnapRad);
  const WorldUp axis = NearestAxis(gravity.up_in_world, unsure_rad);
  return axis == WorldUp::kAuto ? gravity.up_in_world : AxisOf(axis);
}

std::string ShownUp(const Eigen::Vector3d& up) {
  const WorldUp axis = NearestAxis(up);
  return axis == WorldUp::kAuto ? fmt::format("({:.3f}, {:.3f}, {:.3f})", up.x(), up.y(), up.z())
                                : NameOf(axis);
}

}  // namespace depthgrid
