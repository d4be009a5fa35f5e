#include "mapper/scan/farthest_seen.h"

#include <algorithm>

namespace depthgrid {
namespace {

// Horizontal range at row v; 0 where the depth is not usable.
float RangeAt(const DepthImage& image, const BearingLine& line, const ReturnLimits& limits, int v) {
  const auto row = static_cast<float>(v);
  const float z_m = DepthOn(image, line, v);
  return z_m >= limits.min_depth_m ? z_m * (line.h0 + line.h1 * row) : 0.0F;
}

// The row of level rays, near which rays reach farthest.
int LevelRow(const BearingLine& line, const RowRange& rows) {
  const float row = line.g1 != 0.0F ? -line.g0 / line.g1 : 0.0F;
  return static_cast<int>(
      std::clamp(row, static_cast<float>(rows.first), static_cast<float>(rows.last)));
}

}  // namespace

float FarthestSeen(const DepthImage& image, const BearingLine& line, const ReturnLimits& limits,
                   float enough_m) {
  const RowRange rows = RowsOf(line, limits);
  if (rows.first > rows.last) return 0.0F;
  const int level = LevelRow(line, rows);
  float farthest_m = 0.0F;
  for (int away = 0; away <= rows.last - rows.first && farthest_m < enough_m; ++away) {
    for (const int v : {level - away, level + away}) {
      if (v < rows.first || v > rows.last) continue;
      farthest_m = std::max(farthest_m, RangeAt(image, line, limits, v));
    }
  }
  return farthest_m;
}

void EndWhereNothingWasSeen(const DepthImage& image, const BearingLineTable& lines,
                            const ReturnLimits& limits, Scan& scan) {
  for (std::size_t k = 0; k < scan.beams.size(); ++k) {
    Beam& beam = scan.beams[k];
    if (beam.hit || beam.clear_to_m <= beam.clear_from_m) continue;
    beam.clear_to_m =
        std::min(beam.clear_to_m, FarthestSeen(image, lines[k], limits, beam.clear_to_m));
    if (beam.clear_to_m <= beam.clear_from_m) beam.clear_from_m = beam.clear_to_m = 0.0F;
  }
}

}  // namespace depthgrid
