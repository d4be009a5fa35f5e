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

// The median of the differences of distances (ViewSample::DifferencesM()), without their signs; 0
// if they are fewer than kFewReadings.
double MedianChangeM(std::vector<double> differences_m);

// Tells whoever comes before a sensor that stands from its motion, where it gives one pose again
// and again. They only hide what it saw; motion uncovers something as well.
class StillView {
 public:
  // The first frame with the pose.
  void Begin(double stamp_s);
  // The next one: by how much what it sees is farther than in the first (DifferencesM()), the
  // median change from the one before, and what counts as motion.
  void Add(double stamp_s, const std::vector<double>& since_first_m, double since_last_m,
           double moved_m);
  // Whether nothing but noise changed in the first second, and nothing was uncovered since.
  bool stands() const { return stood_ && !uncovered_; }

 private:
  double since_s_ = 0.0;
  double noise_m_ = 0.0;  // the largest change from one frame to the next
  bool still_ = true;
  bool stood_ = false;
  bool uncovered_ = false;
};

// Distances that a sensor sees at fixed places of its view.
class ViewSample {
 public:
  // Of an image: depths on a grid of 40 x 30 pixels. Of a scan: its hits, by bearing.
  void Take(const DepthImage& depth);
  void Take(const Scan& scan);
  void Clear() { readings_.clear(); }
  bool empty() const { return readings_.empty(); }

  // How much farther than in the other this is, of the distances that both have.
  std::vector<double> DifferencesM(const ViewSample& other) const;
  // Their median, without sign; 0 if they are few.
  double ChangeFromM(const ViewSample& other) const { return MedianChangeM(DifferencesM(other)); }

 private:
  struct Reading {
    float bearing_rad = 0.0F;  // of a scan's hit; an image's pixel has its place in the list
    float distance_m = 0.0F;   // 0: none
  };
  std::vector<Reading> readings_;
  int width_px_ = 0, height_px_ = 0;  // of the image
};

}  // namespace depthgrid
