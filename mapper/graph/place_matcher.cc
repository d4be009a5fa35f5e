#include "mapper/graph/place_matcher.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "mapper/fuse/fusion.h"
#include "mapper/graph/place_search.h"
#include "mapper/surfel/surfel_map.h"

namespace depthgrid {
namespace {

// What the search leaves to the precise match.
const Eigen::Vector3d kSearchSigma(0.05, 0.05, 0.02);
constexpr int kIterations = 4;
// The scans of a place are matched against the same noisy map: their information is worth so much
// less (docs/math.md, "Fusion": 2-4).
constexpr double kOverconfidence = 4.0;
// A loop is never believed beyond this.
constexpr double kLeastSigmaM = 0.02;
constexpr double kLeastSigmaRad = 0.005;

const MappedFrame& FrameAt(const std::vector<MappedFrame>& frames, int i) {
  return frames[static_cast<std::size_t>(i)];
}

struct JointMatch {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  double explained = 0.0;
};

// A scan of a place, cut once for all matches.
struct CutScan {
  Pose2 place_from_base;
  std::vector<Surfel> pieces;
};

std::vector<CutScan> CutScans(SurfelMap& map, const std::vector<MappedFrame>& frames,
                              const std::vector<int>& members, int middle) {
  const Pose2 place_from_map = Inverse(FrameAt(frames, middle).map_from_base);
  std::vector<CutScan> scans;
  for (const int i : members) {
    const MappedFrame& frame = FrameAt(frames, i);
    scans.push_back({place_from_map * frame.map_from_base, map.Cut(*frame.scan)});
  }
  return scans;
}

// All scans of `second`'s place against the map of `first`'s, as one small motion of it.
JointMatch MatchTogether(SurfelMap& first_map, const std::vector<CutScan>& scans,
                         const Pose2& first_from_second) {
  JointMatch joint;
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  const Eigen::Matrix3d covariance = kSearchSigma.cwiseProduct(kSearchSigma).asDiagonal();
  for (const CutScan& scan : scans) {
    const Prediction prediction{first_from_second * scan.place_from_base, covariance};
    const MatchResult match = first_map.MatchCut(scan.pieces, prediction);
    if (!match.found) continue;
    const Eigen::Matrix3d to_base = AdjointOf(Inverse(scan.place_from_base));
    const Eigen::Matrix3d weighted = to_base.transpose() * match.information;
    joint.information += weighted * to_base;
    g += weighted * InnovationOf(prediction.map_from_base, match.map_from_base);
    joint.explained += match.score / static_cast<double>(scans.size());
  }
  const Eigen::Matrix3d ridge = kSearchSigma.cwiseProduct(kSearchSigma).cwiseInverse().asDiagonal();
  joint.step = (joint.information + ridge).ldlt().solve(g);
  return joint;
}

}  // namespace

std::optional<PlanarLoop> PlaceMatcher::LoopBetween(const std::vector<MappedFrame>& frames,
                                                    int first, int second, double half_m,
                                                    double half_rad) const {
  const PlaceOptions& place = options_.place;
  const std::vector<int> first_members = FramesAround(frames, first, place);
  const std::vector<int> second_members = FramesAround(frames, second, place);
  if (first_members.empty() || second_members.empty()) return std::nullopt;
  const WallPyramid walls(DrawPlace(frames, first_members, first, place.resolution_m));
  const std::vector<Eigen::Vector2d> points =
      PointsOfPlace(frames, second_members, second, place.resolution_m);
  const PlaceWindow window{
      Between(FrameAt(frames, first).map_from_base, FrameAt(frames, second).map_from_base), half_m,
      half_rad};
  const PlaceMatch best = SearchPlace(walls, points, window, options_.min_score);
  if (!best.found) return std::nullopt;
  const NotNear elsewhere{best.place_from_query};
  if (SearchPlace(walls, points, window, options_.max_second_score * best.score, elsewhere).found) {
    return std::nullopt;
  }
  PlanarLoop loop;
  loop.first = first;
  loop.second = second;
  loop.first_from_second = best.place_from_query;
  if (!Refine(frames, first_members, second_members, loop)) return std::nullopt;
  const Overlap overlap = OverlapOf(frames, loop, overlap_);
  if (!Agrees(overlap, overlap_)) return std::nullopt;
  const double possible = std::min(OverlapWithItself(frames, first, overlap_).agreement(),
                                   OverlapWithItself(frames, second, overlap_).agreement());
  if (overlap.agreement() < options_.min_agreement * possible) return std::nullopt;
  return loop;
}

std::optional<PlanarLoop> PlaceMatcher::Confirmed(const std::vector<MappedFrame>& frames,
                                                  const std::vector<int>& first_members,
                                                  const std::vector<int>& second_members,
                                                  PlanarLoop loop, double min_agreement) const {
  if (!Refine(frames, first_members, second_members, loop)) return std::nullopt;
  const Overlap overlap = OverlapOf(frames, first_members, second_members, loop, overlap_);
  if (!Agrees(overlap, overlap_) || overlap.agreement() < min_agreement) {
    return std::nullopt;
  }
  return loop;
}

bool PlaceMatcher::Refine(const std::vector<MappedFrame>& frames,
                          const std::vector<int>& first_members,
                          const std::vector<int>& second_members, PlanarLoop& loop) const {
  SurfelMap first_map(SurfelOptions{});
  for (const CutScan& scan : CutScans(first_map, frames, first_members, loop.first)) {
    first_map.InsertCut(scan.pieces, scan.place_from_base);
  }
  const std::vector<CutScan> scans = CutScans(first_map, frames, second_members, loop.second);
  JointMatch match;
  for (int i = 0; i < kIterations; ++i) {
    match = MatchTogether(first_map, scans, loop.first_from_second);
    loop.first_from_second = loop.first_from_second * Pose2::FromVector(match.step);
  }
  if (match.explained < options_.min_explained) return false;
  // A direction that nothing is seen of has an infinite one.
  const Eigen::Matrix3d information = match.information / kOverconfidence;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  if (eigen.eigenvalues()[0] <= 0.0) return false;
  const Eigen::Matrix3d covariance = information.inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> planar(covariance.topLeftCorner<2, 2>());
  const double sigma_m = std::sqrt(planar.eigenvalues()[1]);
  const double sigma_rad = std::sqrt(covariance(2, 2));
  if (sigma_m > options_.max_sigma_m || sigma_rad > RadFromDeg(options_.max_sigma_deg)) {
    return false;
  }
  loop.sigma_translation_m = std::max(sigma_m, kLeastSigmaM);
  loop.sigma_yaw_rad = std::max(sigma_rad, kLeastSigmaRad);
  return true;
}

}  // namespace depthgrid
