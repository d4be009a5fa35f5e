// The paper's chain: scans are matched against the older active submap (Eq. 4), and loops are
// closed in a graph of scan and submap poses (Eq. 5-6).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/graph/scan_submap_graph.h"
#include "mapper/grid/scan_rasterizer.h"
#include "mapper/grid/submap.h"
#include "mapper/match/scan_matcher.h"

namespace depthgrid {

class PaperReference : public ReferenceMap {
 public:
  PaperReference(const GridOptions& grid, const SubmapOptions& submap,
                 const ScanMatcherOptions& match, const GraphOptions& graph);

  std::unique_ptr<ReferenceMap> Clone() const override {
    return std::make_unique<PaperReference>(*this);
  }
  MatchResult Match(const std::shared_ptr<const Scan>& scan, const Prediction& prediction) override;
  std::span<const MapPart> MatchedParts() const override { return {&part_, 1}; }
  void Insert(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
              const Eigen::Matrix3d& covariance) override;
  // Submaps hold the newest scans, tied or not.
  void InsertTied(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
                  int) override {
    Insert(scan, map_from_base, Eigen::Matrix3d::Zero());
  }
  double ShareSeenBefore(const std::shared_ptr<const Scan>&, const Pose2&, int) override {
    return 0.0;
  }
  Adjustment Adjust(const std::vector<MappedFrame>& frames, const std::vector<PlanarLoop>& loops,
                    AdjustEffort effort, std::span<const int> asked) override;
  void Rebuild(const std::vector<MappedFrame>& frames) override;
  // Matches at a guessed place would distort the new part: none are made until a submap holds only
  // new scans.
  void BeginPart(PartPlace place) override {
    if (place == PartPlace::kGuessed) part_begin_ = static_cast<int>(map_from_base_.size());
  }
  void RebuildMoved(const std::vector<MappedFrame>& frames, int first_moved) override;

 private:
  void Draw(const Scan& scan, const Pose2& map_from_base);

  double resolution_m_;
  int scans_per_submap_;
  GraphOptions graph_options_;
  ScanMatcher matcher_;
  ScanRasterizer rasterizer_;
  ActiveSubmaps submaps_;
  int part_begin_ = 0;                // submaps with scans before this index are not matched
  MapPart part_;                      // all of the submap
  std::vector<Pose2> map_from_base_;  // current poses of all scans inserted
  std::vector<ScanMeasurement> measurements_;
};

}  // namespace depthgrid
