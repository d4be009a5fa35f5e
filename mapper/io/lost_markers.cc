#include "mapper/io/lost_markers.h"

#include <algorithm>
#include <optional>

#include "mapper/io/slam_jumps.h"

namespace depthgrid {
namespace {

// Exactly: a camera that moves comes near to where it began, but not to the last bit.
bool IsMarker(const std::optional<Pose3>& pose, const Pose3& identity) {
  if (!pose || pose->translation != identity.translation) return false;
  const Eigen::Vector4d& q = identity.rotation.coeffs();
  return pose->rotation.coeffs() == q || pose->rotation.coeffs() == -q;
}

}  // namespace

std::vector<int> FindLostMarkers(const std::vector<SlamPose>& live, const Pose3& identity) {
  std::vector<int> markers;
  const auto is_identity = [&](const SlamPose& pose) {
    return IsMarker(pose.slam_from_camera, identity);
  };
  if (std::none_of(live.begin(), live.end(), is_identity)) {
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
      if (is_identity(live[i])) run.push_back(static_cast<int>(i));
    } else if (!run.empty() && is_identity(live[i])) {
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
