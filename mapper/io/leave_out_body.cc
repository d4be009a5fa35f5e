#include "mapper/io/leave_out_body.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "mapper/io/body_mask.h"
#include "mapper/io/images_ahead.h"
#include "mapper/io/pose_track.h"

namespace depthgrid {
namespace {

// Images between which the camera turned; if there are too many, an evenly spread choice.
std::vector<std::string> ViewsOf(const DepthSequence& sequence, const RecordingOptions& options) {
  const PoseTrack track(sequence.slam.live, options);
  std::vector<std::string> turned;
  std::optional<Eigen::Quaterniond> last;
  for (const RecordedImage& image : ImagesOfPart(sequence.recording)) {
    if (image.depth_path.empty()) continue;
    const auto pose = track.At(image.stamp_s).slam_from_camera;
    if (!pose) continue;
    const Eigen::Quaterniond& now = pose->rotation;
    if (last && last->angularDistance(now) < RadFromDeg(kBodyViewTurnDeg)) continue;
    last = now;
    turned.push_back(image.depth_path);
  }
  const std::size_t count = std::min(turned.size(), BodyFinder::kMostViews);
  std::vector<std::string> views;
  for (std::size_t i = 0; i < count; ++i) views.push_back(turned[i * turned.size() / count]);
  return views;
}

std::string Said(const BodyMask& body, const std::string& name) {
  return fmt::format(
      "{}: {:.1f} % of the depth image stay the same while the camera turns ({:.2f} m, columns {} "
      "to {}, rows {} to {}): taken for parts of the robot and left out "
      "(sequence.recording.drop_body=false keeps them)",
      name, 100.0 * body.share, body.depth_m, body.first_column, body.last_column, body.first_row,
      body.last_row);
}

}  // namespace

void internal::LeaveOutBody(const RecordingOptions& options, DepthSequence& sequence) {
  const std::vector<std::string> views = ViewsOf(sequence, options);
  if (views.size() < kFewestBodyViews) return;
  const DepthReader reader = sequence.reader;
  ImagesAhead images(0, views.size(), UsualImagesAhead(), [&](std::size_t i) {
    ReadImage read;
    try {
      read.depth = std::make_shared<DepthImage>(reader(views[i]));
    } catch (const InputError&) {  // reported when the recording is opened
    }
    return read;
  });
  BodyFinder finder;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (const auto depth = images.Next().depth) finder.Add(*depth);
  }
  auto body = finder.Find();
  if (!body) return;
  sequence.recording.warnings.push_back(Said(*body, sequence.recording.name));
  sequence.reader = [reader, body = std::move(*body)](const std::string& path) {
    DepthImage image = reader(path);
    body.Drop(image);
    return image;
  };
}

}  // namespace depthgrid
