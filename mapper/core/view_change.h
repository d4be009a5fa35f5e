// How much of what a sensor sees has changed, to tell whether it moved.
#pragma once

#include <vector>

#include "mapper/core/depth_image.h"
#include "mapper/core/scan.h"

namespace depthgrid {

// A median change is motion if it exceeds this and this many times that of successive frames, which
// is noise. Chosen: a robot at 0.5 m/s and 10 Hz is detected after four scans.
constexpr double kViewMovedM = 0.05;
constexpr double kTimesNoise = 2.0;
// Motion began where this share of the change was reached.
constexpr double kBegunShare = 0.5;
// Fewer readings in common tell nothing.
constexpr std::size_t kFewReadings = 20;

// Distances that a sensor sees at fixed places of its view.
class ViewSample {
 public:
  // Of an image: depths on a grid of 40 x 30 pixels. Of a scan: its hits, by bearing.
  void Take(const DepthImage& depth);
  void Take(const Scan& scan);
  void Clear() { readings_.clear(); }
  bool empty() const { return readings_.empty(); }

  // The median difference of the distances that both have; 0 if they are few.
  double ChangeFromM(const ViewSample& other) const;

 private:
  struct Reading {
    float bearing_rad = 0.0F;  // of a scan's hit; an image's pixel has its place in the list
    float distance_m = 0.0F;   // 0: none
  };
  std::vector<Reading> readings_;
  int width_px_ = 0, height_px_ = 0;  // of the image
};

}  // namespace depthgrid
