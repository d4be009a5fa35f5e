// Detects people who walk ahead of the camera at its own speed: matches find them where they were
// and imply that the camera stands, which SLAM's motion contradicts (docs/math.md, "What moves").
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/scan/frame_scans.h"

namespace depthgrid {

// Tracks free-standing objects from scan to scan and compares their motion in the view with SLAM's
// motion of the camera.
class MovingObjects {
 public:
  // An object is judged once SLAM's motion would have shifted it by `after_m` in the view if it
  // stood; 0: no tracking.
  explicit MovingObjects(double after_m) : after_m_(after_m) {}

  // Where an object was in a frame's scan: bearings of its first and last beam.
  struct Sector {
    int frame = 0;
    float first_rad = 0.0F, last_rad = 0.0F;
  };

  // Call in order of time with the matched scan, if any, and SLAM's pose; nothing is compared
  // across epochs (SlamEpochs). `frame`: an increasing count of the caller's.
  void Follow(int frame, const Scan& scan, const Pose2& slam_from_base, int epoch);
  // Objects now judged to move that were assumed to stand before and so were drawn: the sectors of
  // each, over at most 300 frames. Each is returned once.
  std::vector<std::vector<Sector>> TakeMistaken();
  // Whether there may be more such objects.
  bool MayBeMistaken() const;
  // Renumbers the epoch of the last scan.
  void RenameEpoch(int epoch) { epoch_ = epoch; }
  // Removes what moves from `matched`, the scan followed last. Objects not judged yet are removed
  // from `standing`, and free-standing ones from `matched` too unless they are half of the scan. In
  // the first scan of a run or epoch, cut objects, and such a half, are taken to stand.
  void TakeOut(FrameScans& scans);

 private:
  enum class Verdict { kNone, kStands, kMoves };
  // How objects not judged yet are treated.
  enum class Unjudged { kStands, kStandsIfCut, kStandsIfAssumed, kMoves };
  struct Point {
    Eigen::Vector2d at_m;
    // Where it was when its judging began.
    Eigen::Vector2d began_at_m;
    Eigen::Vector2d would_be_m;  // where it would be now if it stood
  };
  // The middle of an object and its two ends. If the edge of the view cuts it, only the other end
  // is tracked, as the middle moves with the edge.
  using Points = std::array<std::optional<Point>, 3>;
  struct Object {
    std::size_t begin = 0, end = 0;  // its beams in the last scan
    Points points = {};
    Verdict verdict = Verdict::kNone;
    int times_moved = 0;                               // consecutive verdicts of moving
    Eigen::Vector2d step_m = Eigen::Vector2d::Zero();  // motion in the view per scan, if it moves
    int unseen_scans = 0;
    // Assumed to stand without evidence: its sectors since, until it surely stands or was returned.
    bool is_assumed = false;
    std::vector<Sector> assumed = {};

    bool is_free() const { return points[kMiddle].has_value(); }
  };
  static constexpr std::size_t kMiddle = 0, kFirstEnd = 1, kLastEnd = 2;
  static std::optional<Object> ObjectOf(const Scan& scan, std::size_t begin, std::size_t end);
  void Find(const Scan& scan);
  void Carry(const Pose2& base_from_before);
  void AssumeTheyStand(const Scan& scan);
  void Remember(const Scan& scan, Object& object) const;
  static Eigen::Vector2d OffM(const Object& known, const Object& seen);
  static const Point& FirstOf(const Points& points);
  void Recognise(Object& object);
  void Judge(Object& object);
  void FindHidden(const Scan& scan);
  static bool Moves(const Object& object, Unjudged unjudged);
  bool IsHalfUnjudged(const Scan& scan) const;
  struct BeamRange {
    std::size_t begin, end;
  };
  static BeamRange WithFringe(const Object& object, const Scan& scan);
  std::shared_ptr<const Scan> Rest(const std::shared_ptr<const Scan>& scan, Unjudged unjudged);

  double after_m_;
  std::optional<Pose2> slam_from_before_;
  int epoch_ = 0;
  int frame_ = 0;
  std::vector<Object> objects_;  // of the last scan
  std::vector<Object> before_;   // known before, not recognised in the last scan
  std::vector<std::vector<Sector>> mistaken_;
  ScanPool pool_;
};

}  // namespace depthgrid
