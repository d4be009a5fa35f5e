#include "mapper/scan/cut_ends.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace depthgrid {
namespace {

// A surface ends where this many bearings in a row have no hit; fewer are lost pixels.
constexpr int kBearingsOfNothing = 4;
// The end's depth is the greatest of this many beams, as noise makes beams short.
constexpr int kBeamsOfEnd = 3;

// Measured: docs/tried.md, "Where a depth camera's reach ends".
constexpr std::size_t kBeamsAround = 10;
constexpr double kSigmasFromReach = 2.5;

// The scan's beams in either order, so that both ends are treated alike.
class BeamsFrom {
 public:
  BeamsFrom(Scan& scan, bool backwards) : beams_(scan.beams), backwards_(backwards) {}

  int size() const { return static_cast<int>(beams_.size()); }
  Beam& operator[](int i) const {
    return beams_[static_cast<std::size_t>(backwards_ ? size() - 1 - i : i)];
  }
  float DepthM(int i) const { return (*this)[i].range_m * std::cos((*this)[i].bearing_rad); }
  bool AreOneSurface(int i, int k, float noise_m) const {
    const Beam& a = (*this)[i];
    const Beam& b = (*this)[k];
    if (!a.hit || !b.hit) return false;
    const float steep_m = static_cast<float>(kSteepestTangent) *
                          std::abs(a.bearing_rad - b.bearing_rad) * std::min(a.range_m, b.range_m);
    return std::abs(a.range_m - b.range_m) <= noise_m + steep_m;
  }
  bool IsNothingAfter(int i) const {
    if (i + kBearingsOfNothing >= size()) return false;
    for (int k = 1; k <= kBearingsOfNothing; ++k) {
      if ((*this)[i + k].hit) return false;
    }
    return true;
  }

 private:
  std::vector<Beam>& beams_;
  bool backwards_;
};

// Drops the cut end of the surface whose last hit is beam `last`.
void DropCutEnd(const BeamsFrom& beams, int last, float width_m, double farthest_m) {
  float end_m = 0.0F;
  int first = last;
  for (; first == last || (first >= 0 && beams.AreOneSurface(first, first + 1, width_m)); --first) {
    if (last - first < kBeamsOfEnd) end_m = std::max(end_m, beams.DepthM(first));
  }
  if (end_m + width_m < farthest_m) return;
  const int size = last - first;
  int dropped = 0;
  while (dropped < size && beams.DepthM(last - dropped) > end_m - 0.5F * width_m) ++dropped;
  if (2 * dropped >= size) return;
  for (int k = 0; k < dropped; ++k) beams[last - k].hit = false;
}

// The mean range around beam `i` of what lies within the window's width of it. That of one beam
// would not do: of those near the reach, the ones that noise made short would be left.
float RangeAround(const std::vector<Beam>& beams, std::size_t i, float width_m) {
  const float here_m = beams[i].range_m;
  float sum_m = 0.0F;
  int count = 0;
  const std::size_t end = std::min(i + kBeamsAround + 1, beams.size());
  for (std::size_t k = i - std::min(i, kBeamsAround); k < end; ++k) {
    const float range_m = std::abs(beams[k].range_m);
    if (!beams[k].hit || std::abs(range_m - here_m) > width_m) continue;
    sum_m += range_m;
    ++count;
  }
  return sum_m / static_cast<float>(count);
}

// Drops what lies within noise of both reaches, the scan's and the camera's, beyond which no image
// showed anything: the samples that noise would have made longer are missing.
void DropAtReach(const NoiseWindow& window, double farthest_m, Scan& scan) {
  const double reach_m = farthest_m + NoiseWindow::kClassM;
  std::vector<Beam>& beams = scan.beams;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (!beams[i].hit) continue;
    const float width_m = window.At(beams[i].range_m);
    if (beams[i].range_m + width_m < scan.max_range_m) continue;
    const float range_m = RangeAround(beams, i, width_m);
    const double depth_m = range_m * std::cos(beams[i].bearing_rad);
    const double noise_m = kSigmasFromReach * window.SigmaM(depth_m);
    const bool is_cut = range_m + noise_m > scan.max_range_m && depth_m + noise_m > reach_m;
    if (is_cut) beams[i].range_m = -beams[i].range_m;  // until all are found
  }
  for (Beam& beam : beams) {
    if (beam.range_m >= 0.0F) continue;
    beam.hit = false;
    beam.range_m = -beam.range_m;
  }
}

}  // namespace

void DropCutEnds(const NoiseWindow& window, double farthest_m, Scan& scan) {
  DropAtReach(window, farthest_m, scan);
  for (const bool backwards : {false, true}) {
    const BeamsFrom beams(scan, backwards);
    for (int i = 0; i < beams.size(); ++i) {
      if (!beams[i].hit || !beams.IsNothingAfter(i)) continue;
      const float width_m = window.At(beams[i].range_m);
      if (beams[i].range_m + width_m > scan.max_range_m) continue;
      DropCutEnd(beams, i, width_m, farthest_m);
    }
  }
}

}  // namespace depthgrid
