#include "mapper/graph/slide_search.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "mapper/core/symmetric_eigen.h"
#include "mapper/fuse/fusion.h"
#include "mapper/graph/old_views.h"
#include "mapper/graph/place.h"

namespace depthgrid {
namespace {

// The limits were chosen together; what loosening those of the acceptance costs is in
// docs/tried.md, "After a blind stretch".

// Share of unsure_m at which a pose is known again.
constexpr double kSureShare = 0.5;
// Fewest mapped frames before a stretch: there must be a map to return to.
constexpr int kFewestFrames = 30;
// Path length after the largest sigma at which the search is given up.
constexpr double kLongestWayM = 3.0;
// Spacing of searches along the path.
constexpr double kLookEveryM = 0.05;
constexpr double kLookEveryRad = 0.05;
// Spacing of the start poses, within the reach of a match (SurfelMatchOptions::gate_m), and the
// largest offset of one.
constexpr double kTryEveryM = 0.1;
constexpr double kFarthestM = 1.5;
constexpr auto kMostTries = static_cast<std::size_t>(2.0 * kFarthestM / kTryEveryM + 1.5);
// Prior of the match from a start pose: m, m, rad.
const Eigen::Vector3d kTrySigma(0.05, 0.05, 0.02);
// Largest sigma of a position by the match alone.
constexpr double kKnownM = 0.03;
// Smaller offsets are within reach of an ordinary match.
constexpr double kLeastOffM = 0.08;
// Share of a scan that the map from before the stretch must explain at the slide, relative to the
// usual share; and the most it may explain where the frame was matched, relative to that.
constexpr double kExplainedThere = 0.9;
constexpr double kExplainedHere = 0.6;
// Share of it that a pose farther than kElsewhereM from the slide may reach.
constexpr double kExplainedElsewhere = 0.85;
constexpr double kElsewhereM = 0.15;
// Consecutive searches that must find the slide, within kConsentM.
constexpr int kConsenting = 2;
constexpr double kConsentM = 0.05;
// Most scans since the stretch that are compared with old ones.
constexpr int kMostScans = 16;
// Least agreement of what old and new scans both saw.
constexpr double kAgreement = 0.98;
// For slides beyond the window: largest agreement of what both saw at the estimate as it is.
constexpr double kContradicted = 0.9;

struct Try {
  double off_m = 0.0;
  double share = 0.0;  // of the scan, explained by the map from before the stretch
  Pose2 map_from_base;
};

struct Tries {
  std::array<Try, kMostTries> all;
  std::size_t count = 0;

  const Try* Best() const {
    const Try* best = nullptr;
    for (std::size_t i = 0; i < count; ++i) {
      if (std::abs(all[i].off_m) <= kLeastOffM) continue;
      if (best == nullptr || all[i].share > best->share) best = &all[i];
    }
    return best;
  }
  double MostElsewhere(double off_m) const {
    double most = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      if (std::abs(all[i].off_m - off_m) > kElsewhereM) most = std::max(most, all[i].share);
    }
    return most;
  }
};

bool KnowsPosition(const Eigen::Matrix3d& information) {
  const auto covariance = InverseIfPositive(information);
  return covariance && std::sqrt(std::max((*covariance)(0, 0), (*covariance)(1, 1))) <= kKnownM;
}

// Frames from `begin` on whose scans are stored, evenly spread.
std::vector<int> ScansFrom(const std::vector<MappedFrame>& frames, int begin) {
  std::vector<int> with_scan;
  for (int i = begin; i < static_cast<int>(frames.size()); ++i) {
    if (FrameAt(frames, i).scan) with_scan.push_back(i);
  }
  return EvenlySpread(with_scan, kMostScans);
}

}  // namespace

void SlideSearchOptions::Visit(OptionsVisitor& v) {
  v.Flag("use", use, "whether the mapper looks along a wall that it slid along");
  v.Number("unsure_m", unsure_m, {0.01, 10.0},
           "it may have slid where a position is known no better than to this standard deviation");
  v.Number("window_sigmas", window_sigmas, {0.5, 10.0},
           "half of the way along the wall that is searched, in standard deviations");
}

bool SlideSearch::Wants(const Pose2& map_from_base) const {
  if (!stretch_ || !is_sure_) return false;
  return !stretch_->looked ||
         AreApart(*stretch_->looked, map_from_base, kLookEveryM, kLookEveryRad);
}

void SlideSearch::Look(const std::shared_ptr<const Scan>& scan, const Pose2& map_from_base,
                       double usual_share, ReferenceMap& reference) {
  Stretch& stretch = *stretch_;
  stretch.looked = map_from_base;
  const std::optional<Slide> found = Found(scan, map_from_base, usual_share, reference);
  if (!found) {
    stretch.slide.reset();
    stretch.consenting = 0;
    return;
  }
  const bool same = stretch.slide && std::abs(stretch.slide->off_m - found->off_m) <= kConsentM;
  stretch.consenting = same ? stretch.consenting + 1 : 1;
  stretch.slide = found;
}

std::optional<SlideSearch::Slide> SlideSearch::Found(const std::shared_ptr<const Scan>& scan,
                                                     const Pose2& map_from_base, double usual_share,
                                                     ReferenceMap& reference) const {
  const Stretch& stretch = *stretch_;
  const double here = reference.ShareSeenBefore(scan, map_from_base, stretch.begin);
  if (here > kExplainedHere) return std::nullopt;  // no pose explains more than 1
  const double half_m = std::min(options_.window_sigmas * stretch.sigma_m, kFarthestM);
  const Eigen::Matrix3d covariance = Squared(kTrySigma);
  Tries tries;
  for (int k = 0; k < static_cast<int>(kMostTries); ++k) {
    const double off_m = -half_m + k * kTryEveryM;
    if (off_m > half_m) break;
    const Eigen::Vector2d at = map_from_base.translation() + off_m * stretch.along_in_map;
    const Pose2 start{at.x(), at.y(), map_from_base.yaw_rad};
    const MatchResult match = reference.Match(scan, {start, covariance});
    if (!match.found || !KnowsPosition(match.information)) continue;
    const Eigen::Vector2d moved = match.map_from_base.translation() - map_from_base.translation();
    tries.all[tries.count++] = {moved.dot(stretch.along_in_map),
                                reference.ShareSeenBefore(scan, match.map_from_base, stretch.begin),
                                match.map_from_base};
  }
  const Try* best = tries.Best();
  if (best == nullptr || best->share < kExplainedThere * usual_share ||
      here > kExplainedHere * best->share ||
      tries.MostElsewhere(best->off_m) > kExplainedElsewhere * best->share) {
    return std::nullopt;
  }
  return Slide{best->off_m, best->map_from_base};
}

// Begins, continues or ends the stretch by the covariance of the newest pose.
void SlideSearch::Follow(const std::vector<MappedFrame>& frames,
                         const Eigen::Matrix3d& covariance) {
  const Pose2& pose = frames.back().map_from_base;
  const int mapped = static_cast<int>(frames.size());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(covariance.topLeftCorner<2, 2>());
  const double sigma_m = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
  is_sure_ = sigma_m <= kSureShare * options_.unsure_m;
  if (!stretch_) {
    if (is_sure_) known_frames_ = mapped;
    if (sigma_m < options_.unsure_m || known_frames_ < kFewestFrames) return;
    stretch_.emplace();
    stretch_->begin = known_frames_;
    stretch_->last = pose;
  }
  Stretch& stretch = *stretch_;
  stretch.way_m += (pose.translation() - stretch.last.translation()).norm();
  stretch.last = pose;
  if (!is_sure_) stretch.seen_from = mapped;
  if (sigma_m > stretch.sigma_m) {
    stretch.sigma_m = sigma_m;
    stretch.along_in_map = Eigen::Rotation2Dd(pose.yaw_rad) * axes.eigenvectors().col(1);
    stretch.way_m = 0.0;
  }
  if (stretch.way_m > kLongestWayM) stretch_.reset();
}

std::optional<PlanarLoop> SlideSearch::Mapped(const std::vector<MappedFrame>& frames,
                                              const Eigen::Matrix3d& covariance) {
  Follow(frames, covariance);
  if (!stretch_ || stretch_->consenting < kConsenting) return std::nullopt;
  stretch_->consenting = 0;  // if refused, the searches start over
  const std::optional<PlanarLoop> loop = Confirmed(frames, *stretch_->slide);
  stretch_->slide.reset();
  if (loop) Forget();
  return loop;
}

std::optional<PlanarLoop> SlideSearch::Confirmed(const std::vector<MappedFrame>& frames,
                                                 const Slide& slide) const {
  const int newest = static_cast<int>(frames.size()) - 1;
  const Pose2& here = PoseAt(frames, newest);
  const std::vector<int> members = ScansFrom(frames, stretch_->seen_from);
  const std::vector<int> old = OldFrames(frames, stretch_->begin, slide.map_from_base, kSightM);
  if (members.empty() || old.empty()) return std::nullopt;
  const Pose2 shift = slide.map_from_base * Inverse(here);
  const std::vector<int> near = SeenFromNear(frames, old, members, shift);
  PlanarLoop loop;
  loop.first = *std::min_element(near.begin(), near.end(), [&](int a, int b) {
    return Separation(PoseAt(frames, a), slide.map_from_base) <
           Separation(PoseAt(frames, b), slide.map_from_base);
  });
  loop.second = newest;
  loop.first_from_second = Between(PoseAt(frames, loop.first), slide.map_from_base);
  const Overlap there = OverlapOf(frames, near, members, loop, overlap_);
  if (!Agrees(there, overlap_) || there.agreement() < kAgreement) return std::nullopt;
  const std::optional<PlanarLoop> precise =
      matcher_.Confirmed(frames, near, members, loop, kAgreement);
  if (precise) loop = *precise;
  if (std::abs(slide.off_m) <= options_.window_sigmas * stretch_->sigma_m) return loop;
  PlanarLoop as_it_is = loop;
  as_it_is.first_from_second = Between(PoseAt(frames, loop.first), here);
  const Overlap overlap = OverlapOf(frames, near, members, as_it_is, overlap_);
  const bool contradicted =
      overlap.compared >= overlap_.min_points && overlap.agreement() < kContradicted;
  return precise && contradicted ? precise : std::nullopt;
}

void SlideSearch::Forget() {
  stretch_.reset();
  is_sure_ = false;
}

}  // namespace depthgrid
