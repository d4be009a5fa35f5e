// What scans are matched against and corrected with. Two users: the paper's chain (submaps of
// probabilities, Eq. 4, pose graph of Eq. 5-6) and the surfel map (docs/math.md).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mapper/core/frame_report.h"
#include "mapper/core/mapped_frame.h"
#include "mapper/core/motion_spread.h"

namespace depthgrid {

// A loop between two mapped frames, already projected to the plane.
struct PlanarLoop {
  int first = 0;  // indices into the vector of MappedFrame
  int second = 0;
  Pose2 first_from_second;
  double sigma_translation_m = 0.02;
  double sigma_yaw_rad = 0.01;
  // The caller discards an adjustment that rejects this loop, so the adjustment may stop there.
  bool on_trial = false;
};

struct Adjustment {
  std::vector<Pose2> map_from_base;  // one a mapped frame; the first is unchanged
  std::vector<bool> loop_accepted;   // one a loop given
  // SLAM's motion noise estimated from the adjusted poses; empty with too few of them.
  std::optional<MotionSpread> motion_spread;
  // Joint covariance of the remaining errors of the `asked` frames: three rows a frame, in map axes
  // (true pose = Exp(error) * adjusted pose). Empty if not computed.
  Eigen::MatrixXd covariance;
};

// The purpose, and thereby the cost, of an adjustment.
enum class AdjustEffort {
  kRefine,      // during the run: poses are nearly right
  kBend,        // during a long run: loops and motions only, no surfels
  kCloseLoops,  // during the run: loops may move poses far
  kFinish,      // at the end: every frame as accurately as possible
  kFinishMoved  // the same, but from the given poses of the frames instead of those of the run
};

inline bool IsFinish(AdjustEffort effort) {
  return effort == AdjustEffort::kFinish || effort == AdjustEffort::kFinishMoved;
}

// A part of the map that a scan was matched against.
struct MapPart {
  double mapped = 0.0;  // mean index of the mapped frames that drew it
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // its share of the match, base axes
  double noise_share = 0.0;  // share of the variance that is the part's own noise
};

// Standard deviation of the guess where a new SLAM epoch begins (SLAM's own pose, or the previous
// motion continued): m, m, rad (docs/math.md, "Epochs").
inline const Eigen::Vector3d kEpochSigma(0.1, 0.1, 0.05);

enum class PartPlace { kKnown, kGuessed };

class ReferenceMap {
 public:
  virtual ~ReferenceMap() = default;

  // A copy that shares nothing with this map.
  virtual std::unique_ptr<ReferenceMap> Clone() const = 0;
  // Matches around the prediction. Called for every frame once something is mapped. The
  // prediction's covariance may limit or regularise the search, but must not enter the result.
  virtual MatchResult Match(const std::shared_ptr<const Scan>& scan,
                            const Prediction& prediction) = 0;
  // The parts used by the last match; valid until the next call of any member function.
  virtual std::span<const MapPart> MatchedParts() const = 0;
  // Called before inserting a frame: the pose of the frame before, as the filter had it and as this
  // frame's match corrects it. SLAM's jitter is left out of both.
  virtual void Corrected(const Pose2& /*map_from_previous*/, const Pose2& /*corrected*/) {}
  // Adds the scan at its fused pose. `covariance` is that of the pose in base axes, zero if not
  // tracked.
  virtual void Insert(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
                      const Eigen::Matrix3d& covariance) = 0;
  // Adds a tied frame: it only moves with the kept frame at index `tied_to`, as its place is well
  // seen.
  virtual void InsertTied(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
                          int tied_to) = 0;
  // The share of a scan at a pose that lies on surfaces inserted before mapped frame `frame`; 0
  // where unknown.
  virtual double ShareSeenBefore(const std::shared_ptr<const Scan>& scan,
                                 const Pose2& map_from_base, int frame) = 0;
  // Corrects all poses at once, given loops (possibly none), and gives the covariance of those at
  // the indices `asked`. Does not change the map; see Rebuild.
  virtual Adjustment Adjust(const std::vector<MappedFrame>& frames,
                            const std::vector<PlanarLoop>& loops, AdjustEffort effort,
                            std::span<const int> asked) = 0;
  // Forgets everything and inserts the frames again at their (corrected) poses.
  virtual void Rebuild(const std::vector<MappedFrame>& frames) = 0;
  // The relative pose of the next frame and the previous one is unknown: no motion constraint joins
  // them. kGuessed: the next frame's pose in the map is unknown as well.
  virtual void BeginPart(PartPlace) {}
  // As Rebuild, after all frames from this index on were moved rigidly.
  virtual void RebuildMoved(const std::vector<MappedFrame>& frames, int) { Rebuild(frames); }
};

}  // namespace depthgrid
