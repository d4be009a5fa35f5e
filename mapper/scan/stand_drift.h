// How far SLAM's height and tilt can have drifted while no floor was in view, judged by how they
// drifted while one was.
#pragma once

#include <Eigen/Core>

namespace depthgrid {

class StandDrift {
 public:
  // A frame begins; SLAM moved the camera up by `rise_m` since the last one.
  void Step(double rise_m);
  // The floor is in view: how much higher above it the camera is than was expected, and the normal
  // of its plane less the expected one, in SLAM's frame.
  void Seen(double height_off_m, const Eigen::Vector3d& up_off);
  // Heights have another zero: anything is possible until the floor is seen.
  void Forget() { jumped_ = true; }

  // Whether SLAM can be off by this much since the floor was seen last.
  bool CanBe(double height_off_m) const { return jumped_ || height_off_m <= most_m_; }
  bool CanTilt(double tilt_rad) const { return tilt_rad <= most_rad_; }
  // Whether SLAM's tilt is known to drift so slowly that the floor stays tilted as it usually is.
  bool IsSlow() const;
  // How far its tilt drifts in so many frames.
  double TiltIn(double frames) const { return frames * rate_rad_; }

 private:
  // Errors of the frames of a window, and how fast SLAM drifted in the fastest one of late, a
  // frame.
  int frames_ = 0, windows_ = 0;
  double off_m_ = 0.0;
  Eigen::Vector3d up_off_ = Eigen::Vector3d::Zero();
  double rate_m_ = 0.0, rate_rad_ = 0.0;
  double most_m_ = 0.0, most_rad_ = 0.0;  // how far it can have drifted since the floor was seen
  bool jumped_ = false;
};

}  // namespace depthgrid
