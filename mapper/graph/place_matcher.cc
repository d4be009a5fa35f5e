#include "mapper/graph/place_matcher.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "mapper/core/symmetric_eigen.h"
#include "mapper/fuse/fusion.h"
#include "mapper/graph/place_search.h"
#include "mapper/surfel/surfel_map.h"

namespace depthgrid {
namespace {

// Accuracy of the search, as prior of the precise match: m, m, rad.
const Eigen::Vector3d kSearchSigma(0.05, 0.05, 0.02);
constexpr std::size_t kIterations = 4;
// Share of the final agreement that is required after 1 and 2 steps. Of 729 places in rooms that
// look alike, 247 agree in the end, none of which this rejects early; it does reject 328 others
// (docs/tried.md, "What a search costs").
constexpr std::array<double, 2> kShareAfterSteps = {0.9, 0.97};
// Divisor of the matches' information, as the scans of a place are matched against the same noisy
// map (docs/math.md, "Fusion": 2-4).
constexpr double kOverconfidence = 4.0;
// Least sigma of a loop.
constexpr double kLeastSigmaM = 0.02;
constexpr double kLeastSigmaRad = 0.005;

struct JointMatch {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  double explained = 0.0;
};

// Matches all scans of the second place against the first one's map and combines them to one small
// motion.
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
  KnownPlace first_place(frames, first, options_.place, overlap_);
  KnownPlace second_place(frames, second, options_.place, overlap_);
  return LoopBetween(frames, first_place, second_place, half_m, half_rad);
}

// The tests are independent; they are ordered by cost relative to how many places they reject.
std::optional<PlanarLoop> PlaceMatcher::LoopBetween(const std::vector<MappedFrame>& frames,
                                                    KnownPlace& first, KnownPlace& second,
                                                    double half_m, double half_rad) const {
  if (first.members().empty() || second.members().empty()) return std::nullopt;
  const WallPyramid& walls = first.Walls(frames);
  const std::vector<Eigen::Vector2d>& points = second.Points(frames);
  const PlaceWindow window{Between(FrameAt(frames, first.middle()).map_from_base,
                                   FrameAt(frames, second.middle()).map_from_base),
                           half_m, half_rad};
  const PlaceMatch best = SearchPlace(walls, points, window, options_.min_score);
  if (!best.found) return std::nullopt;
  PlanarLoop loop;
  loop.first = first.middle();
  loop.second = second.middle();
  loop.first_from_second = best.place_from_query;
  const auto agree = [&](const Pose2& first_from_second, double share) {
    return Agree(frames, first, second, first_from_second, share * options_.min_agreement);
  };
  const auto may_agree = [&](const Pose2& first_from_second, std::size_t steps) {
    return steps > kShareAfterSteps.size() || agree(first_from_second, kShareAfterSteps[steps - 1]);
  };
  SurfelMap surfels = first.Surfels(frames);  // a copy, as CutScans() updates its noise model
  if (!Refine(frames, surfels, second.members(), may_agree, loop)) return std::nullopt;
  if (!agree(loop.first_from_second, 1.0)) return std::nullopt;
  const NotNear elsewhere{best.place_from_query};
  if (SearchPlace(walls, points, window, options_.max_second_score * best.score, elsewhere).found) {
    return std::nullopt;
  }
  return loop;
}

bool PlaceMatcher::Agree(const std::vector<MappedFrame>& frames, KnownPlace& first,
                         KnownPlace& second, const Pose2& first_from_second, double share) const {
  const Overlap overlap = OverlapOf(first.Seen(frames), second.Seen(frames), first_from_second);
  if (!Agrees(overlap, overlap_)) return false;
  if (overlap.agreement() >= share) return true;
  for (KnownPlace* place : {&first, &second}) {  // relative to the lower of the two
    if (overlap.agreement() >= share * place->AgreementWithItself(frames)) return true;
  }
  return false;
}

std::optional<PlanarLoop> PlaceMatcher::Confirmed(const std::vector<MappedFrame>& frames,
                                                  const std::vector<int>& first_members,
                                                  const std::vector<int>& second_members,
                                                  PlanarLoop loop, double min_agreement) const {
  SurfelMap surfels = SurfelsOfPlace(frames, first_members, loop.first);
  const auto always = [](const Pose2&, std::size_t) { return true; };
  if (!Refine(frames, surfels, second_members, always, loop)) return std::nullopt;
  const Overlap overlap = OverlapOf(frames, first_members, second_members, loop, overlap_);
  if (!Agrees(overlap, overlap_) || overlap.agreement() < min_agreement) {
    return std::nullopt;
  }
  return loop;
}

bool PlaceMatcher::Refine(const std::vector<MappedFrame>& frames, SurfelMap& first_map,
                          const std::vector<int>& second_members, const MayStill& may_agree,
                          PlanarLoop& loop) const {
  const std::vector<CutScan> scans = CutScans(first_map, frames, second_members, loop.second);
  JointMatch match;
  for (std::size_t steps = 1; steps <= kIterations; ++steps) {
    match = MatchTogether(first_map, scans, loop.first_from_second);
    loop.first_from_second = loop.first_from_second * Pose2::FromVector(match.step);
    if (!may_agree(loop.first_from_second, steps)) return false;
  }
  if (match.explained < options_.min_explained) return false;
  // The covariance from eigenvalues: with an unobserved direction, a plain inverse may have
  // negative variances from rounding.
  const auto covariance = InverseIfPositive(match.information / kOverconfidence);
  if (!covariance) return false;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> planar;
  planar.computeDirect(covariance->topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly);
  const double sigma_m = std::sqrt(planar.eigenvalues()[1]);
  const double sigma_rad = std::sqrt((*covariance)(2, 2));
  const bool is_known =
      sigma_m <= options_.max_sigma_m && sigma_rad <= RadFromDeg(options_.max_sigma_deg);
  if (!is_known) return false;
  loop.sigma_translation_m = std::max(sigma_m, kLeastSigmaM);
  loop.sigma_yaw_rad = std::max(sigma_rad, kLeastSigmaRad);
  return true;
}

}  // namespace depthgrid
