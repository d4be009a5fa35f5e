// Detects that the estimate slid along a wall. While a scan shows a single wall, the position along
// it is not observed and follows SLAM's motion alone. Walls seen afterwards may then lie beyond the
// reach of a match from where the map has them and would be drawn a second time. So the scan is
// matched from poses along that direction too (docs/math.md, "After a blind stretch").
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/core/reference_map.h"
#include "mapper/graph/place_matcher.h"

namespace depthgrid {

struct SlideSearchOptions {
  bool use = true;
  // A blind stretch begins where the sigma of a position reaches this in some direction, and the
  // pose is known again at half of it. Chosen so that 2.5 sigmas are the reach of a match, 0.15 m
  // (SurfelMatchOptions::gate_m).
  double unsure_m = 0.06;
  // Half width of the search, in sigmas of the stretch. Slides found beyond it need more evidence.
  double window_sigmas = 3.0;

  void Visit(OptionsVisitor& v);
};

class SlideSearch {
 public:
  // `gates`: how well two places must fit, as for loops.
  SlideSearch(const SlideSearchOptions& options, const LoopSearchOptions& gates,
              const OverlapOptions& overlap)
      : options_(options), overlap_(overlap), matcher_(gates, overlap) {}

  // Whether Look() is to be called for a frame that was matched at this pose.
  bool Wants(const Pose2& map_from_base) const;
  // Matches the frame's scan from poses along the stretch's direction. `usual_share`: share of a
  // scan that the map usually explains. Replaces the reference's last match: match again after it.
  void Look(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base, double usual_share,
            ReferenceMap& reference);
  // Call after each mapped frame, the last of `frames`, with the covariance of its pose (base
  // axes). Returns a loop from a frame before the stretch to this one once a slide is confirmed.
  std::optional<PlanarLoop> Mapped(const std::vector<MappedFrame>& frames,
                                   const Eigen::Matrix3d& covariance);
  // Call when the newest frames were moved as one or their place became unknown.
  void Forget();

 private:
  struct Slide {
    double off_m = 0.0;   // along the stretch's direction, from the matched pose
    Pose2 map_from_base;  // at which the map from before the stretch explains the scan
  };
  struct Stretch {
    int begin = 0;         // mapped frames up to the last known pose: the map to return to
    int seen_from = 0;     // position of the first mapped frame whose pose is known again
    double sigma_m = 0.0;  // largest of a position, and its direction
    Eigen::Vector2d along_in_map = Eigen::Vector2d::Zero();
    double way_m = 0.0;           // path length since then
    Pose2 last;                   // map from base of the last frame
    std::optional<Pose2> looked;  // and of the last search
    std::optional<Slide> slide;   // found by that search
    int consenting = 0;           // consecutive searches that found it
  };
  void Follow(const std::vector<MappedFrame>& frames, const Eigen::Matrix3d& covariance);
  std::optional<Slide> Found(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
                             double usual_share, ReferenceMap& reference) const;
  std::optional<PlanarLoop> Confirmed(const std::vector<MappedFrame>& frames,
                                      const Slide& slide) const;

  SlideSearchOptions options_;
  OverlapOptions overlap_;
  PlaceMatcher matcher_;
  int known_frames_ = 0;  // number of mapped frames when a pose was last known
  bool is_sure_ = false;  // whether the last frame's pose is known
  std::optional<Stretch> stretch_;
};

}  // namespace depthgrid
