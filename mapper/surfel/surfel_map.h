// The reference map of surfels: everything seen so far, matched point to line, and corrected by a
// joint adjustment of poses and surfels (docs/math.md, "Surfels").
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/surfel/joint_adjustment.h"
#include "mapper/surfel/range_noise.h"
#include "mapper/surfel/scan_surfels.h"
#include "mapper/surfel/surfel_groups.h"
#include "mapper/surfel/surfel_matcher.h"
#include "mapper/surfel/surfel_store.h"

namespace depthgrid {

struct SurfelOptions {
  ScanSurfelOptions scan;
  SurfelMatchOptions match;
  JointOptions joint;
  // Spacing of the map's surfels along a wall.
  double spacing_m = 0.05;
  // A piece is merged into a surfel within this distance along the normal plus this many sigmas of
  // the piece.
  double merge_gate_m = 0.02;
  double merge_gate_sigmas = 3.0;
  // A match that moves the pose of the frame before, or points 3 m from it, by more than this also
  // moves the newest group (docs/math.md, "Joint adjustment").
  double jump_m = 0.02;
  // Standard deviation by which Smoothed() holds final poses to those of the joint adjustment.
  double stay_m = 0.3;
  // MovingObjects: a free-standing object is matched once it stood still while the camera moved
  // this far. Objects drawn before that turn out to move are removed from the first frames, which
  // are mapped again.
  double moving_m = 0.12;

  void Visit(OptionsVisitor& v);
};

class SurfelMap : public ReferenceMap {
 public:
  explicit SurfelMap(const SurfelOptions& options);

  std::unique_ptr<ReferenceMap> Clone() const override {
    return std::make_unique<SurfelMap>(*this);
  }
  MatchResult Match(const std::shared_ptr<const Scan>& scan, const Prediction& prediction) override;
  std::span<const MapPart> MatchedParts() const override { return parts_; }
  void Corrected(const Pose2& map_from_previous, const Pose2& corrected) override;
  void Insert(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
              const Eigen::Matrix3d& covariance) override;
  void InsertTied(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
                  int tied_to) override;
  double ShareSeenBefore(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
                         int frame) override;
  Adjustment Adjust(const std::vector<MappedFrame>& frames, const std::vector<PlanarLoop>& loops,
                    AdjustEffort effort, std::span<const int> asked) override;
  void Rebuild(const std::vector<MappedFrame>& frames) override;
  void BeginPart(PartPlace) override { groups_.BeginPart(); }

  // The pieces that Match() and Insert() use, for a scan that is matched repeatedly.
  std::vector<Surfel> Cut(const Scan& scan);
  // Insert() for a map that is never adjusted.
  void InsertCut(const std::vector<Surfel>& pieces, const Pose2& map_from_base) {
    InsertInto(map_, pieces, map_from_base, 0.0);
  }
  MatchResult MatchCut(const std::vector<Surfel>& pieces, const Prediction& prediction) {
    return matcher_.Match(pieces, map_, prediction);
  }

  const SurfelStore& surfels() const { return map_; }

 private:
  void InsertInto(SurfelStore& map, const std::vector<Surfel>& surfels,
                  const Pose2& map_from_surfels, double frame) const;
  // Whether bending the poses to the loops moves all of them by little.
  bool MoveLittle(const std::vector<PlanarLoop>& loops, const std::vector<MappedFrame>& frames);
  // The frames' groups, joined as the adjustment requires.
  SurfelGroups GroupsOf(const std::vector<MappedFrame>& frames, AdjustEffort effort);
  JointOptions JointOptionsFor(AdjustEffort effort) const;
  std::vector<Pose2> SmoothedOver(const std::vector<MappedFrame>& frames,
                                  const SurfelGroups& groups,
                                  const std::vector<Pose2>& map_from_group,
                                  const std::optional<MotionSpread>& spread,
                                  const std::vector<Eigen::Vector3d>& growth);
  // Learns the sensor's noise from a scan.
  void Learn(const Scan& scan);
  const std::vector<Surfel>& PiecesOf(const std::shared_ptr<const Scan>& scan);

  SurfelOptions options_;
  RangeNoise noise_;
  ScanSurfelMaker maker_;
  SurfelMatcher matcher_;
  SurfelStore map_;
  std::vector<int> surfels_before_;  // map_.size() when each frame was inserted
  SurfelGroups groups_;
  // The last scan used and its pieces: Match() and Insert() need the same ones.
  std::shared_ptr<const Scan> scan_;
  std::vector<Surfel> pieces_;
  std::vector<Surfel> other_pieces_;  // memory for another scan used in between
  std::vector<Surfel> all_pieces_;    // with a stride above 1: pieces of all beams
  std::vector<MapPart> parts_;
};

}  // namespace depthgrid
