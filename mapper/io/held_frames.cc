#include "mapper/io/held_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mapper/core/view_change.h"
#include "mapper/io/pose_runs.h"

namespace depthgrid {
namespace {

// Fewer frames of one pose may be several images near one pose's stamp.
constexpr std::size_t kLeastFrames = 4;
// What differs by more than this and this many times what successive frames do, at least, has begun
// to move.
// Chosen: above what noise makes of it.
constexpr double kUnmovedM = 0.01, kUnmovedTimes = 1.2;
// A camera may be back where it was at the end: so many frames between are asked as well.
constexpr std::size_t kProbes = 4;
// The median difference of depths at pixels that both images have; 0 if they are few.
double DifferenceM(const DepthImage& a, const DepthImage& b) {
  ViewSample of_a, of_b;
  of_a.Take(a);
  of_b.Take(b);
  return of_b.ChangeFromM(of_a);
}

// Frames of one pose, from the one whose pose is right: the first, or at the start the last.
class Run {
 public:
  Run(std::size_t begin, std::size_t end, bool from_last, const ImageOfFrame& image)
      : begin_(begin), end_(end), from_last_(from_last), image_(image), right_(image(At(0))) {}

  // The number of frames, from the right one on, that are not held.
  std::size_t CountRight() const {
    const std::size_t last = end_ - begin_ - 1;
    std::shared_ptr<const DepthImage> next;
    for (std::size_t k = 1; k <= last && !next; ++k) next = image_(At(k));
    if (!right_ || !next) return last + 1;
    const double step_m = DifferenceM(*right_, *next);
    const double moved_m = kViewMovedM + kTimesNoise * step_m;
    for (std::size_t probe = 1; probe <= kProbes; ++probe) {
      const std::size_t k = probe * last / kProbes;
      if (k > 1 && SinceRightM(k) > moved_m) return CountStanding(k);
    }
    return last + 1;
  }
  std::size_t At(std::size_t k) const { return from_last_ ? end_ - 1 - k : begin_ + k; }

 private:
  double SinceRightM(std::size_t k) const {
    const auto there = image_(At(k));
    return there ? DifferenceM(*right_, *there) : 0.0;
  }
  // From the right one on, until the frames differ from it by more than noise. The right one alone
  // if that is soon.
  std::size_t CountStanding(std::size_t moved) const {
    const double changed_m = kUnmovedM + kUnmovedTimes * LeastStepM();
    const std::size_t standing = FirstBeyond(changed_m, moved);
    return standing > kLeastFrames ? standing : 1;
  }
  // The least difference of the first successive frames: noise, if the camera stands.
  double LeastStepM() const {
    double least_m = std::numeric_limits<double>::infinity();
    auto before = right_;
    for (std::size_t k = 1; k <= kLeastFrames && k < end_ - begin_; ++k) {
      auto here = image_(At(k));
      if (before && here) least_m = std::min(least_m, DifferenceM(*before, *here));
      before = std::move(here);
    }
    return std::isfinite(least_m) ? least_m : 0.0;
  }
  // Frames change more and more: bisects.
  std::size_t FirstBeyond(double change_m, std::size_t last) const {
    std::size_t below = 0;
    while (last - below > 1) {
      const std::size_t middle = below + (last - below) / 2;
      (SinceRightM(middle) >= change_m ? last : below) = middle;
    }
    return last;
  }

  std::size_t begin_, end_;
  bool from_last_;
  const ImageOfFrame& image_;
  std::shared_ptr<const DepthImage> right_;
};

}  // namespace

std::vector<bool> HeldFrames(const std::vector<std::optional<Pose3>>& slam_from_camera,
                             std::size_t first, std::size_t end, const ImageOfFrame& image) {
  const std::vector<PoseRun> runs = PoseRunsOf(slam_from_camera);
  std::vector<bool> held = FindRepeated(runs, slam_from_camera).held;
  if (runs.size() < 2) return held;
  for (const PoseRun& whole : runs) {
    const PoseRun in_part{whole.begin, std::min(whole.end, end)};
    if (in_part.end < in_part.begin + kLeastFrames || in_part.end <= first) continue;
    if (held[in_part.begin + 1]) continue;
    const Run run(in_part.begin, in_part.end, &whole == &runs.front(), image);
    for (std::size_t k = run.CountRight(); k < in_part.size(); ++k) held[run.At(k)] = true;
  }
  return held;
}

}  // namespace depthgrid
