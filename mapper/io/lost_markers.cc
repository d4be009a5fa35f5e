#include "mapper/io/lost_markers.h"

#include <algorithm>
#include <optional>

#include "mapper/io/slam_jumps.h"

namespace depthgrid {
namespace {

// Exactly: a camera that moves comes near to where it began, but not to the last bit.
bool IsIdentity(const std::optional<Pose3>& pose) {
  return pose && pose->translation.isZero(0.0) && pose->rotation.vec().isZero(0.0);
}

}  // namespace

std::vector<int> FindLostMarkers(const std::vector<SlamPose>& live) {
  std::vector<int> markers;
  if (std::none_of(live.begin(), live.end(),
                   [](const SlamPose& pose) { return IsIdentity(pose.slam_from_camera); })) {
    return markers;
  }
  const std::vector<int> jumps = FindJumps(live, {});
  const auto is_jump = [&](std::size_t i) {
    return std::binary_search(jumps.begin(), jumps.end(), static_cast<int>(i));
  };
  std::vector<int> run;  // identities since a jump
  for (std::size_t i = 0; i < live.size(); ++i) {
    if (!live[i].slam_from_camera) continue;
    if (is_jump(i)) {
      markers.insert(markers.end(), run.begin(), run.end());
      run.clear();
      if (IsIdentity(live[i].slam_from_camera)) run.push_back(static_cast<int>(i));
    } else if (!run.empty() && IsIdentity(live[i].slam_from_camera)) {
      run.push_back(static_cast<int>(i));
    } else {
      run.clear();
    }
  }
  markers.insert(markers.end(), run.begin(), run.end());
  return markers;
}

void Forget(const std::vector<int>& markers, std::vector<SlamPose>& live) {
  for (const int marker : markers) live[static_cast<std::size_t>(marker)].slam_from_camera.reset();
}

}  // namespace depthgrid
