// Who walks on before a camera as fast as it moves: each match finds them where they were, and says
// that the camera stands. SLAM says that it does not (docs/math.md, "What moves").
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/scan/frame_scans.h"

namespace depthgrid {

// Follows what stands free in the view from scan to scan, and compares how it moves there with how
// SLAM says that the camera does.
class MovingObjects {
 public:
  // An object is judged once SLAM has moved the camera so that it lies `after_m` elsewhere in the
  // view if it stands; 0: nothing is followed.
  explicit MovingObjects(double after_m) : after_m_(after_m) {}

  // What is to be matched: the scan without what moves, and without what is not judged yet unless
  // that is half of what is seen; mostly the scan itself. Of frames that have one, in the order of
  // time, with SLAM's pose; nothing is compared from one epoch to another (SlamEpochs).
  std::shared_ptr<const Scan> ToMatch(const std::shared_ptr<const Scan>& scan,
                                      const Pose2& slam_from_base, int epoch);

 private:
  enum class Verdict { kNone, kStands, kMoves };
  struct Object {
    std::size_t begin = 0, end = 0;  // its beams of the last scan
    Eigen::Vector2d at_m = Eigen::Vector2d::Zero();
    // Since it is being judged.
    Eigen::Vector2d began_at_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d would_be_m = Eigen::Vector2d::Zero();  // by now, if it stood
    Verdict verdict = Verdict::kNone;
    int unseen_scans = 0;
  };
  static std::optional<Object> ObjectOf(const Scan& scan, std::size_t begin, std::size_t end);
  void Find(const Scan& scan);
  void Carry(const Pose2& base_from_before);
  void Recognise(Object& object);
  void Judge(Object& object) const;
  static bool IsLeftOut(const Object& object, bool unjudged_too);
  std::shared_ptr<const Scan> Rest(const std::shared_ptr<const Scan>& scan);

  double after_m_;
  std::optional<Pose2> slam_from_before_;
  int epoch_ = 0;
  std::vector<Object> objects_;  // of the last scan, by bearing
  std::vector<Object> before_;   // known before it, and not recognised in it
  ScanPool pool_;
};

}  // namespace depthgrid
