// The beams of a scan as line segments in cell coordinates (metres / resolution) of the map frame.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/core/grid_geometry.h"
#include "mapper/core/pose2.h"
#include "mapper/core/scan.h"

namespace depthgrid {

// One entry a beam in every vector, in the order of the scan; coordinates have up to
// kSegmentPadding - 1 entries more (the origin), so that vector loops need no remainder.
constexpr std::size_t kSegmentPadding = 4;

struct ScanSegments {
  std::vector<double> from_x;  // the clear interval; where there is none, the scan's origin twice
  std::vector<double> from_y;
  std::vector<double> to_x;
  std::vector<double> to_y;
  std::vector<double> end_x;  // the hit; the scan's origin where there is none
  std::vector<double> end_y;
  std::vector<std::uint8_t> clears;  // 0 or 1
  std::vector<std::uint8_t> hit;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  bool bearings_increase = true;  // strictly, and over less than a full turn
  Cell min_cell;                  // around all of them, with a cell to spare in x
  Cell max_cell;

  std::size_t size() const { return hit.size(); }
};

// Builds segments; keeps its memory, and the directions of the beams as long as the bearings stay.
class SegmentBuilder {
 public:
  // `clear_margin_m`: a beam stops clearing this far before its hit. The result is good until the
  // next call.
  const ScanSegments& Build(const Scan& scan, const Pose2& map_from_base, double resolution_m,
                            double clear_margin_m = 0.0);

 private:
  void Unpack(const Scan& scan, double clear_margin_m);
  void UpdateDirections();
  void Place(const Pose2& map_from_base, double resolution_m);
  void Bound();

  // One entry a beam.
  std::vector<float> bearing_rad_;
  std::vector<double> clear_from_m_;
  std::vector<double> clear_to_m_;
  std::vector<double> range_m_;           // 0 where there is no hit
  std::vector<float> known_bearing_rad_;  // bearings of cos_ and sin_
  std::vector<double> cos_;
  std::vector<double> sin_;
  std::vector<double> x_per_m_;
  std::vector<double> y_per_m_;
  ScanSegments segments_;
};

}  // namespace depthgrid
