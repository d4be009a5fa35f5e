// Who walks on before a camera as fast as it moves: each match finds them where they were, and says
// that the camera stands. SLAM says that it does not (docs/math.md, "What moves").
#pragma once

#include <array>
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

  // Where in the scan of a frame something was: the bearings of its first and its last beam.
  struct Sector {
    int frame = 0;
    float first_rad = 0.0F, last_rad = 0.0F;
  };

  // The matched scans of frames that have one, in the order of time, with SLAM's pose; nothing is
  // compared from one epoch to another (SlamEpochs). Frames are counted by the caller, upwards.
  void Follow(int frame, const Scan& scan, const Pose2& slam_from_base, int epoch);
  // What moves, as the scan that was followed last shows, but was taken to stand before anything
  // showed how it moves, and so was drawn: each object's way, of 300 frames at most. Told once.
  std::vector<std::vector<Sector>> TakeMistaken();
  // Whether there may be more to tell.
  bool MayBeMistaken() const;
  // The epoch of the last scan is called so from now on.
  void RenameEpoch(int epoch) { epoch_ = epoch; }
  // Of the scan that was followed last, as `matched`, what moves. What is not judged yet is not
  // `standing`; where it stands free it is matched only if all such is half of what is seen. Of
  // the first scan, and the first of an epoch, what is cut stands, and so does that half.
  void TakeOut(FrameScans& scans);

 private:
  enum class Verdict { kNone, kStands, kMoves };
  // How what is not judged yet is taken.
  enum class Unjudged { kStands, kStandsIfCut, kStandsIfAssumed, kMoves };
  struct Point {
    Eigen::Vector2d at_m;
    // Since it is being judged.
    Eigen::Vector2d began_at_m;
    Eigen::Vector2d would_be_m;  // by now, if it stood
  };
  // The middle of what is seen of an object, and its two ends. Of what the edge of the view cuts
  // the other end alone is followed: the middle goes along with the edge.
  using Points = std::array<std::optional<Point>, 3>;
  struct Object {
    std::size_t begin = 0, end = 0;  // its beams of the last scan
    Points points = {};
    Verdict verdict = Verdict::kNone;
    int times_moved = 0;  // judged so, one after the other
    Eigen::Vector2d step_m =
        Eigen::Vector2d::Zero();  // of what moves, from scan to scan in the view
    int unseen_scans = 0;
    // Taken to stand while nothing showed how it moves: where it was since, until it surely stands
    // or was told.
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
  std::vector<Object> before_;   // known before it, and not recognised in it
  std::vector<std::vector<Sector>> mistaken_;
  ScanPool pool_;
};

}  // namespace depthgrid
