// Did the estimate slide along a wall? While a scan shows one wall alone, nothing tells the way
// along it, and SLAM's motion alone carries the pose on. What is seen after that may lie farther
// from where the map has it than a match looks, and would be drawn a second time beside it. So the
// scan is tried along that way (docs/math.md, "After a blind stretch").
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
  // The stretch is blind once a pose is known no better than this in some direction, and over when
  // it is known to half of it again. A match looks 0.15 m far (SurfelMatchOptions::gate_m).
  double unsure_m = 0.06;
  // The scan is tried up to so many standard deviations away. Farther off, more is asked for.
  double window_sigmas = 3.0;

  void Visit(OptionsVisitor& v);
};

class SlideSearch {
 public:
  // `gates` are those of loops: how well two places must fit.
  SlideSearch(const SlideSearchOptions& options, const LoopSearchOptions& gates,
              const OverlapOptions& overlap)
      : options_(options), overlap_(overlap), matcher_(gates, overlap) {}

  // Whether Look() has to be called for a frame that was matched there.
  bool Wants(const Pose2& map_from_base) const;
  // Tries the frame's scan along the way. `usual_share` of a scan is explained in ordinary times.
  // Ends with another match standing: match again.
  void Look(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base, double usual_share,
            ReferenceMap& reference);
  // After each mapped frame, the last of `frames`, with the covariance of its pose (base axes): a
  // loop from a frame before the stretch to this one, where it is plain that the estimate slid.
  std::optional<PlanarLoop> Mapped(const std::vector<MappedFrame>& frames,
                                   const Eigen::Matrix3d& covariance);
  // The frames were moved, or where the newest lie is not known.
  void Forget();

 private:
  // A pose at which what was mapped before the stretch explains the scan, and how far off that is.
  struct Slide {
    double off_m = 0.0;
    Pose2 map_from_base;
  };
  struct Stretch {
    int begin = 0;      // position among the mapped frames: how it lies to those before may be off
    int seen_from = 0;  // the first frame whose pose is known again
    double sigma_m = 0.0;  // the worst that a pose was known to, and in which direction
    Eigen::Vector2d along = Eigen::Vector2d::Zero();
    double way_m = 0.0;  // since then
    Pose2 last;          // the last frame's
    std::optional<Pose2> looked;
    std::optional<Slide> slide;  // found by the last look
    int consenting = 0;          // looks in a row that found it
  };
  void Follow(const std::vector<MappedFrame>& frames, const Eigen::Matrix3d& covariance);
  std::optional<Slide> Found(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
                             double usual_share, ReferenceMap& reference) const;
  std::optional<PlanarLoop> Confirmed(const std::vector<MappedFrame>& frames,
                                      const Slide& slide) const;

  SlideSearchOptions options_;
  OverlapOptions overlap_;
  PlaceMatcher matcher_;
  int known_frames_ = 0;  // mapped when a pose was last well known
  bool is_sure_ = false;  // the last frame's is
  std::optional<Stretch> stretch_;
};

}  // namespace depthgrid
