#include "mapper/torn_map.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "mapper/core/symmetric_eigen.h"
#include "mapper/graph/old_views.h"
#include "mapper/graph/part_search.h"
#include "mapper/graph/place.h"
#include "mapper/graph/place_matcher.h"

namespace depthgrid {
namespace {

// The map may be torn where a match tells a position no better than to this standard deviation
// (SlideSearchOptions::unsure_m), on the way of at least one of these.
constexpr double kTearUnsureM = 0.06;
constexpr double kTearWayM = 0.1;
constexpr double kTearTurnRad = RadFromDeg(3.0);
constexpr double kTearStepS = 0.2;  // without a frame
// Sigma where a match tells nothing.
constexpr double kMostUnsureM = 1.0;
// Of each part, what lies within this distance of the tear, seen from so many frames at most.
constexpr double kPartReachM = 15.0;
constexpr int kMostPartViews = 100;
// Parts of which less agrees contradict each other.
constexpr double kTornAgreement = 0.9;
// Tears that are examined, those with most way on which nothing told the position, and of these
// those that are searched, across which most is contradicted.
constexpr std::size_t kMostExamined = 100;
constexpr std::size_t kMostTears = 6;
// Path between any two of them: their parts are nearly the same otherwise.
constexpr double kTearsApartM = 1.5;
// A view of one part shows that the other one belongs there if that part saw half of what it
// shows, of which so much agrees there, and no more than this agrees as it is.
constexpr double kAgreesThere = 0.9;
constexpr double kAgreesHere = 0.8;
constexpr std::size_t kMostWitnesses = 24;
// For a loop that no precise match confirms.
constexpr double kRoughM = 0.1;
constexpr double kRoughRad = RadFromDeg(1.5);
constexpr double kRoughAgreement = 0.9;
constexpr double kPreciseAgreement = 0.95;

// The last frame before it and the first one after it.
struct Tear {
  int last = 0;
  int first = 0;
};

struct TornParts {
  Tear tear;
  std::vector<int> old_views, new_views;
  SeenPlace first, second;  // in axes of the tear's frames
  int contradicted = 0;     // points
};

// Largest standard deviation of the position that the match tells.
double UnsureM(const MappedFrame& frame) {
  if (!frame.match.found) return kMostUnsureM;
  const auto covariance = InverseIfPositive(frame.match.information);
  if (!covariance) return kMostUnsureM;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(covariance->topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly);
  return std::min(kMostUnsureM, std::sqrt(std::max(0.0, axes.eigenvalues()[1])));
}

// Those with most way first.
std::vector<Tear> TearsOf(const std::vector<MappedFrame>& frames) {
  std::vector<Tear> tears;
  int last = -1;
  for (int i = 0; i < static_cast<int>(frames.size()); ++i) {
    if (FrameAt(frames, i).of_prior_map()) {
      last = i;
      continue;
    }
    if (UnsureM(FrameAt(frames, i)) > kTearUnsureM) continue;
    if (last >= 0) {
      const double step_s = FrameAt(frames, i).stamp_s - FrameAt(frames, last).stamp_s;
      const bool blind = i > last + 1 || step_s > kTearStepS;
      const bool moved = AreApart(PoseAt(frames, last), PoseAt(frames, i), kTearWayM, kTearTurnRad);
      if (blind && moved) tears.push_back({last, i});
    }
    last = i;
  }
  const auto way = [&](const Tear& tear) {
    return Separation(PoseAt(frames, tear.last), PoseAt(frames, tear.first));
  };
  std::stable_sort(tears.begin(), tears.end(),
                   [&](const Tear& a, const Tear& b) { return way(a) > way(b); });
  if (tears.size() > kMostExamined) tears.resize(kMostExamined);
  return tears;
}

std::optional<TornParts> TornPartsAt(const std::vector<MappedFrame>& frames, const Tear& tear,
                                     const OverlapOptions& overlap) {
  const Pose2& before = PoseAt(frames, tear.last);
  const Pose2& after = PoseAt(frames, tear.first);
  const int end = static_cast<int>(frames.size());
  TornParts parts;
  parts.tear = tear;
  parts.old_views =
      EvenlySpread(OldFrames(frames, tear.last + 1, before, kPartReachM), kMostPartViews);
  parts.new_views =
      EvenlySpread(ViewsWithin(frames, tear.first, end, after, kPartReachM), kMostPartViews);
  if (parts.old_views.empty() || parts.new_views.empty()) return std::nullopt;
  parts.first = SeenFrom(frames, parts.old_views, tear.last, overlap);
  parts.second = SeenFrom(frames, parts.new_views, tear.first, overlap);
  const Overlap now = OverlapOf(parts.first, parts.second, Between(before, after));
  if (now.compared < overlap.min_points || now.agreement() > kTornAgreement) return std::nullopt;
  parts.contradicted = now.compared - now.agreeing;
  return parts;
}

// The tears across which most is contradicted, the worst first.
std::vector<Tear> WorstTears(const std::vector<MappedFrame>& frames, const OverlapOptions& overlap,
                             const std::vector<GuessedPart>& guessed) {
  struct Ranked {
    Tear tear;
    int contradicted = 0;
  };
  std::vector<Ranked> ranked;
  for (const Tear& tear : TearsOf(frames)) {
    const bool leaves_guess = std::any_of(
        guessed.begin(), guessed.end(),
        [&](const GuessedPart& part) { return part.IsLeftBetween(tear.last, tear.first); });
    if (leaves_guess) continue;
    const std::optional<TornParts> parts = TornPartsAt(frames, tear, overlap);
    if (parts) ranked.push_back({tear, parts->contradicted});
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    return a.contradicted > b.contradicted;
  });
  const std::vector<double> way_m = WaysTo(frames);
  const auto way = [&](const Ranked& r) { return way_m[static_cast<std::size_t>(r.tear.first)]; };
  std::vector<Ranked> worst;
  for (const Ranked& next : ranked) {
    const bool is_apart = std::all_of(worst.begin(), worst.end(), [&](const Ranked& other) {
      return std::abs(way(next) - way(other)) >= kTearsApartM;
    });
    if (is_apart && worst.size() < kMostTears) worst.push_back(next);
  }
  std::vector<Tear> tears;
  for (const Ranked& r : worst) tears.push_back(r.tear);
  return tears;
}

struct Witness {
  int view = 0;
  double share = 0.0;  // of what it shows, what the other part saw
};

// The views of one part that show where it belongs, those of which the other part saw most first.
// `other_from_map`: as it is, and with the part moved.
std::vector<Witness> WitnessesOf(const std::vector<MappedFrame>& frames,
                                 const std::vector<int>& views, const SeenPlace& other,
                                 const Pose2& here, const Pose2& there,
                                 const OverlapOptions& overlap) {
  std::vector<Witness> witnesses;
  for (const int view : views) {
    const std::vector<Eigen::Vector2d> points = PointsSeenBy(FrameAt(frames, view), overlap);
    const auto enough = static_cast<int>(points.size() / 2);
    const Overlap moved = PointsIn(other, points, there * PoseAt(frames, view));
    if (moved.compared <= enough || moved.agreement() < kAgreesThere) continue;
    const Overlap as_it_is = PointsIn(other, points, here * PoseAt(frames, view));
    if (as_it_is.compared > enough && as_it_is.agreement() > kAgreesHere) continue;
    witnesses.push_back(
        {view, static_cast<double>(moved.compared) / static_cast<double>(points.size())});
  }
  std::stable_sort(witnesses.begin(), witnesses.end(),
                   [](const Witness& a, const Witness& b) { return a.share > b.share; });
  if (witnesses.size() > kMostWitnesses) witnesses.resize(kMostWitnesses);
  return witnesses;
}

// All frames' poses once those from `second` on are moved by `shift` (map axes). Those between
// `first` and it move in part, most where least tells the position.
std::vector<Pose2> MovedFrom(const std::vector<MappedFrame>& frames, int first, int second,
                             const Pose2& shift) {
  std::vector<double> so_far(frames.size(), 0.0);
  double sum = 0.0;
  for (int i = first + 1; i <= second; ++i) {
    const double unsure_m = UnsureM(FrameAt(frames, i));
    sum += unsure_m * unsure_m * Separation(PoseAt(frames, i - 1), PoseAt(frames, i));
    so_far[static_cast<std::size_t>(i)] = sum;
  }
  const Pose2& at = PoseAt(frames, second);
  const Eigen::Vector3d motion = Between(at, shift * at).vector();
  std::vector<Pose2> moved;
  for (int i = 0; i < static_cast<int>(frames.size()); ++i) {
    const double between = sum > 0.0 ? so_far[static_cast<std::size_t>(i)] / sum : 0.0;
    const double share = i >= second ? 1.0 : between;
    moved.push_back(at * Pose2::FromVector(share * motion) * Inverse(at) * PoseAt(frames, i));
  }
  return moved;
}

std::vector<int> InOrderOfTime(const std::vector<Witness>& witnesses) {
  std::vector<int> views;
  for (const Witness& witness : witnesses) views.push_back(witness.view);
  std::sort(views.begin(), views.end());
  return views;
}

// The last frame before `end` that a prior map has; -1: none.
int LastOfPrior(const std::vector<MappedFrame>& frames, int end) {
  int i = end - 1;
  while (i >= 0 && !FrameAt(frames, i).of_prior_map()) --i;
  return i;
}

// With the later part moved by `shift` (map axes), or by what a precise match makes of it.
std::optional<Mending> MendingBy(const std::vector<MappedFrame>& frames, const TornParts& parts,
                                 const Pose2& shift, const PlaceMatcher& matcher,
                                 const OverlapOptions& overlap) {
  const Pose2 first_from_map = Inverse(PoseAt(frames, parts.tear.last));
  const Pose2 second_from_map = Inverse(PoseAt(frames, parts.tear.first));
  const std::vector<Witness> new_ones = WitnessesOf(
      frames, parts.new_views, parts.first, first_from_map, first_from_map * shift, overlap);
  const std::vector<Witness> old_ones =
      WitnessesOf(frames, parts.old_views, parts.second, second_from_map,
                  second_from_map * Inverse(shift), overlap);
  if (old_ones.empty() || new_ones.empty()) return std::nullopt;
  const std::vector<int> members = InOrderOfTime(new_ones);
  const std::vector<int> near = SeenFromNear(frames, InOrderOfTime(old_ones), members, shift);
  PlanarLoop loop;
  loop.second = new_ones.front().view;
  const Pose2 there = shift * PoseAt(frames, loop.second);
  loop.first = *std::min_element(near.begin(), near.end(), [&](int a, int b) {
    return Separation(PoseAt(frames, a), there) < Separation(PoseAt(frames, b), there);
  });
  loop.first_from_second = Between(PoseAt(frames, loop.first), there);
  loop.sigma_translation_m = kRoughM;
  loop.sigma_yaw_rad = kRoughRad;
  if (const auto precise = matcher.Confirmed(frames, near, members, loop, kPreciseAgreement)) {
    loop = *precise;
  } else {
    const Overlap rough = OverlapOf(frames, near, members, loop, overlap);
    if (rough.compared < overlap.min_points || rough.agreement() < kRoughAgreement) return {};
  }
  const Pose2 moved = PoseAt(frames, loop.first) * loop.first_from_second;
  const int from = std::max(near.back(), LastOfPrior(frames, parts.tear.first));
  return Mending{
      loop, MovedFrom(frames, from, members.front(), moved * Inverse(PoseAt(frames, loop.second)))};
}

std::optional<Mending> MendingAt(const std::vector<MappedFrame>& frames, const Tear& tear,
                                 const PlaceMatcher& matcher, const OverlapOptions& overlap) {
  const std::optional<TornParts> parts = TornPartsAt(frames, tear, overlap);
  if (!parts) return std::nullopt;
  const Pose2& before = PoseAt(frames, tear.last);
  const Pose2& after = PoseAt(frames, tear.first);
  const auto found = SearchPart(parts->first, parts->second, Between(before, after));
  if (!found) return std::nullopt;
  return MendingBy(frames, *parts, before * *found * Inverse(after), matcher, overlap);
}

}  // namespace

std::vector<Mending> MendingsOf(const std::vector<MappedFrame>& frames,
                                const LoopSearchOptions& search, const OverlapOptions& overlap,
                                const std::vector<GuessedPart>& guessed) {
  const PlaceMatcher matcher(search, overlap);
  std::vector<Mending> mendings;
  for (const Tear& tear : WorstTears(frames, overlap, guessed)) {
    std::optional<Mending> mending = MendingAt(frames, tear, matcher, overlap);
    if (mending) mendings.push_back(std::move(*mending));
  }
  return mendings;
}

}  // namespace depthgrid
