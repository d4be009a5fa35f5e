#include "mapper/graph/old_views.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "mapper/graph/place.h"

namespace depthgrid {
namespace {

// Spacing of the old frames drawn, and their largest number.
constexpr double kDrawnEveryM = 0.2;
constexpr double kDrawnEveryRad = RadFromDeg(15.0);
constexpr int kMostDrawn = 500;
// Old frames that each new one is compared with.
constexpr std::size_t kOldForEach = 2;
// Old frames that the newest one alone is compared with, at most.
constexpr int kMostForNewest = 100;

}  // namespace

std::vector<int> ViewsWithin(const std::vector<MappedFrame>& frames, int begin, int end,
                             const Pose2& around, double reach_m) {
  std::vector<int> old;
  for (int i = begin; i < end; ++i) {
    if (!frames[static_cast<std::size_t>(i)].scan) continue;
    const Pose2& pose = PoseAt(frames, i);
    if ((pose.translation() - around.translation()).norm() > reach_m) continue;
    if (!old.empty()) {
      const Pose2 step = Between(PoseAt(frames, old.back()), pose);
      if (step.translation().norm() < kDrawnEveryM && std::abs(step.yaw_rad) < kDrawnEveryRad) {
        continue;
      }
    }
    old.push_back(i);
  }
  const std::size_t stride = old.size() / kMostDrawn + 1;
  std::vector<int> drawn;
  for (std::size_t k = 0; k < old.size(); k += stride) drawn.push_back(old[k]);
  return drawn;
}

std::vector<int> SeenFromNear(const std::vector<MappedFrame>& frames, const std::vector<int>& old,
                              const std::vector<int>& members, const Pose2& shift) {
  std::vector<int> near;
  for (const int member : members) {
    const Pose2 pose = shift * PoseAt(frames, member);
    std::vector<int> ranked = old;
    std::stable_sort(ranked.begin(), ranked.end(), [&](int a, int b) {
      return Separation(PoseAt(frames, a), pose) < Separation(PoseAt(frames, b), pose);
    });
    const std::size_t count = std::min(ranked.size(), kOldForEach);
    for (std::size_t k = 0; k < count; ++k) near.push_back(ranked[k]);
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

OverlapEachWay OverlapOfNewest(const std::vector<MappedFrame>& frames,
                               const OverlapOptions& options) {
  const int newest = static_cast<int>(frames.size()) - 1;
  const Pose2& pose = PoseAt(frames, newest);
  const std::vector<int> old =
      EvenlySpread(OldFrames(frames, newest, pose, kSightM), kMostForNewest);
  if (old.empty()) return {};
  const int middle = old.back();
  return EachWay(SeenFrom(frames, old, middle, options),
                 SeenFrom(frames, {newest}, newest, options),
                 Between(PoseAt(frames, middle), pose));
}

}  // namespace depthgrid
