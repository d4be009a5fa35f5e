// Takes the noise out of a laser's hits: all scans together show where the walls are.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/core/key_index.h"
#include "mapper/core/mapped_frame.h"
#include "mapper/surfel/range_noise.h"
#include "mapper/surfel/surfel.h"

namespace depthgrid {

// How much a laser's ranges err, from scans evenly spread over the frames.
class LaserNoise {
 public:
  explicit LaserNoise(const std::vector<MappedFrame>& frames);

  // Standard deviation of a range.
  double SigmaM(double range_m) const { return range_m * noise_.RelativeSigma(range_m); }
  // At the farthest hit; 0 if no frame is a laser's.
  double most_m() const { return farthest_m_ > 0.0 ? SigmaM(farthest_m_) : 0.0; }

 private:
  RangeNoise noise_;
  double farthest_m_ = 0.0;
};

// Whether the map is drawn from the readings that are matched, but for those left out there: a
// laser's. Of a camera the two are met at different heights.
bool DrawsWhatItMatches(const MappedFrame& frame);

class WallRanges {
 public:
  // The walls that the kept laser frames see from their poses. Hits whose standard deviation
  // exceeds `least_sigma_m` are moved, by `most_sigmas` of it at most.
  WallRanges(const std::vector<MappedFrame>& frames, const LaserNoise& noise, double least_sigma_m,
             double most_sigmas);

  // The scan with such hits moved along their beams onto the wall that most likely returned them.
  // Those of none stay.
  Scan Sharpened(const Scan& scan, const Pose2& map_from_base) const;

 private:
  static constexpr double kCellM = 0.2;

  static std::uint64_t KeyOf(const Eigen::Vector2d& place_m);
  void Add(const Surfel& surfel);
  double RangeOnWall(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction,
                     double range_m) const;

  LaserNoise noise_;
  double least_sigma_m_;
  double most_sigmas_;
  KeyIndex cell_of_key_;
  std::vector<std::vector<Surfel>> cells_;
};

}  // namespace depthgrid
