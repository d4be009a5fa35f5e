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
  // Nothing is wanted of an adjustment that does not accept it: it may end there.
  bool on_trial = false;
};

struct Adjustment {
  std::vector<Pose2> map_from_base;  // one a mapped frame; the first is unchanged
  std::vector<bool> loop_accepted;   // one a loop given
  // How SLAM's motion errs, as the adjusted poses tell; empty where they are too few.
  std::optional<MotionSpread> motion_spread;
  // Of the errors that the frames asked for have left, as they go together: three rows a frame, in
  // map axes (true pose = Exp(error) * adjusted pose). Empty where nothing was solved for them.
  Eigen::MatrixXd covariance;
};

// How much an adjustment may cost, and what for.
enum class AdjustEffort {
  kRefine,      // during the run: poses are nearly right
  kBend,        // during a long run: only what loops ask for, without looking at what was seen
  kCloseLoops,  // during the run: loops may bend them
  kFinish,      // once: each single frame as well as it can be known
};

// A part of the map that a scan was matched against.
struct MapPart {
  double mapped = 0.0;  // the mean position, among the mapped frames, of those that drew it
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // what the match has from it, base axes
  double noise_share = 0.0;  // of this information's variance, how much is the part's own noise
};

// How well it is guessed where a new epoch of SLAM's poses begins, from SLAM's own word or from the
// motion before: m, m, rad (docs/math.md, "Epochs").
inline const Eigen::Vector3d kEpochSigma(0.1, 0.1, 0.05);

enum class PartPlace { kKnown, kGuessed };

class ReferenceMap {
 public:
  virtual ~ReferenceMap() = default;

  // Matches around the prediction. Called for every frame once something is mapped. The covariance
  // may bound or steady the search; the result must not contain it.
  virtual MatchResult Match(const std::shared_ptr<const Scan>& scan,
                            const Prediction& prediction) = 0;
  // What the last match was made against; good until the next call of anything.
  virtual std::span<const MapPart> MatchedParts() const = 0;
  // Where the frame to be inserted next was predicted, from the one before, and where it is but for
  // what SLAM is off by in it alone.
  virtual void Corrected(const Pose2& /*predicted_map_from_base*/, const Pose2& /*map_from_base*/) {
  }
  // Adds the scan at its fused pose. `covariance` is that of the pose in base axes, zero if not
  // tracked.
  virtual void Insert(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
                      const Eigen::Matrix3d& covariance) = 0;
  // A frame that only moves with the kept one at this position: its place is well seen.
  virtual void InsertTied(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
                          int tied_to) = 0;
  // The share of a scan at a pose that lies on what was inserted before the frame at this position;
  // 0 where that is not known.
  virtual double ShareSeenBefore(const std::shared_ptr<const Scan>& scan,
                                 const Pose2& map_from_base, int frame) = 0;
  // Corrects all poses at once, given loops (possibly none), and tells how well those of the frames
  // at the positions `asked` are known then. Does not change the map; see Rebuild.
  virtual Adjustment Adjust(const std::vector<MappedFrame>& frames,
                            const std::vector<PlanarLoop>& loops, AdjustEffort effort,
                            std::span<const int> asked) = 0;
  // Forgets everything and inserts the frames again at their (corrected) poses.
  virtual void Rebuild(const std::vector<MappedFrame>& frames) = 0;
  // How the next frame and the one before lie to each other is not known: nothing is measured
  // between them. kGuessed: neither is where it lies in the map.
  virtual void BeginPart(PartPlace) {}
  // As Rebuild, after the frames from this position on were moved as one.
  virtual void RebuildMoved(const std::vector<MappedFrame>& frames, int) { Rebuild(frames); }
};

}  // namespace depthgrid
