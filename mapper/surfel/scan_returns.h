// A scan's hits as inverse ranges, without lone outliers, cut where the range jumps.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/scan.h"
#include "mapper/surfel/range_noise.h"

namespace depthgrid {

// Half-open interval of indices into the returns.
struct Span {
  int begin = 0;
  int end = 0;
  int size() const { return end - begin; }
};

struct ScanReturn {
  double bearing_rad = 0.0;
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
  double range_m = 0.0;         // as measured
  double inverse_range = 0.0;   // 1/m; near the sensor's reach corrected for what it cut off
  double relative_sigma = 0.0;  // of the range and of its inverse
  // Relative to an independent return far from the sensor's reach.
  double information = 1.0;
};

class ScanReturns {
 public:
  // `jump_sigmas`: a larger difference of two neighbours is a jump.
  explicit ScanReturns(double jump_sigmas) : jump_sigmas_(jump_sigmas) {}

  // Reads every `stride`-th beam: 1, or noise.stride().
  void Read(const Scan& scan, const RangeNoise& noise, int stride);

  int size() const { return static_cast<int>(returns_.size()); }
  const ScanReturn& operator[](int i) const { return returns_[static_cast<std::size_t>(i)]; }
  ScanReturn& operator[](int i) { return returns_[static_cast<std::size_t>(i)]; }
  const std::vector<Span>& runs() const { return runs_; }
  // How many independent returns a return is worth: less than 1 where beams are read that err as
  // their neighbours do (RangeNoise::stride()).
  double independent_share() const { return independent_share_; }
  double step_rad() const { return step_rad_; }  // mean angle between beams read
  // The sensor's reach; 0: not known, or what it cut off is not (RangeNoise::TellsCutoff).
  double max_range_m() const { return max_range_m_; }

 private:
  void LearnDirections(const Scan& scan);
  bool Jumps(const ScanReturn& a, const ScanReturn& b) const;
  void DropLoneOutliers();
  void Cut();

  double jump_sigmas_;
  std::vector<float> bearings_rad_;  // bearings of directions_
  std::vector<Eigen::Vector2d> directions_;
  double beam_step_rad_ = 1.0;
  double step_rad_ = 1.0;  // between beams read
  double max_range_m_ = 0.0;
  double independent_share_ = 1.0;
  std::vector<ScanReturn> returns_;
  std::vector<Span> runs_;
};

}  // namespace depthgrid
