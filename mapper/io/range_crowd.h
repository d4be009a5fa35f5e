// Detects no-returns of a laser that writes them as its maximum range with some noise rather than
// as one number: readings cluster at the log's longest ranges, wherever the laser is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "mapper/core/pose2.h"

namespace depthgrid {

// The cluster of the log's longest readings.
struct RangeCrowd {
  double shortest_m = 0.0;
  double longest_m = 0.0;
  std::int64_t count = 0;
  std::int64_t readings = 0;   // all readings examined
  double times_as_many = 0.0;  // relative to the mean of equally wide bands below
};

class RangeCrowdCheck {
 public:
  // Hits are readings in [least_m, most_m). Only the first scan at each place is used.
  void Add(const Pose2& odom_from_laser, const std::vector<double>& range_m, double least_m,
           double most_m);
  // Nothing if the laser was at too few places.
  std::optional<RangeCrowd> Found() const;

 private:
  static constexpr std::size_t kSectors = 256;  // of the field of view
  using Sectors = std::array<int, kSectors>;
  struct Bin {
    Sectors sectors{};
    std::int64_t count = 0;
    double shortest_m = 0.0;
    double longest_m = 0.0;
  };
  std::int64_t CountOf(int first_bin, int last_bin) const;
  double SectorsOf(int first_bin, int last_bin) const;
  RangeCrowd BandOf(int first_bin, int last_bin) const;

  std::map<int, Bin> bins_;
  std::int64_t readings_ = 0;
  int places_ = 0;
  std::optional<Pose2> last_place_;
};

}  // namespace depthgrid
