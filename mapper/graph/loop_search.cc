#include "mapper/graph/loop_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace depthgrid {
namespace {

// Largest difference in heading: with a narrow view, more differing views have little in common.
constexpr double kMaxTurnDeg = 60.0;
// Added to the window, so that places beside the path count.
constexpr double kBesideM = 1.0;
// No search if this share of the scan lies on old surfels: the adjustment associates them anyway.
constexpr double kKnownShare = 0.5;

bool IsSmall(const Pose2& pose, double within_m, double within_deg) {
  return pose.translation().norm() < within_m && std::abs(pose.yaw_rad) < RadFromDeg(within_deg);
}

}  // namespace

void LoopSearchOptions::Visit(OptionsVisitor& v) {
  v.Choice(
      "use", use,
      {{LoopSearchUse::kAuto, "auto"}, {LoopSearchUse::kOn, "on"}, {LoopSearchUse::kOff, "off"}},
      "whether the mapper looks for loops itself; auto: with method surfel");
  v.Number("every_m", every_m, {0.05, 1000.0}, "distance travelled between two searches");
  v.Number("min_way_m", min_way_m, {0.1, 1e6},
           "shortest distance travelled from a place to its revisit");
  v.Number("drift_share", drift_share, {0.0, 1.0},
           "drift that the search allows for, share of the distance travelled");
  v.Number("turn_deg_per_m", turn_deg_per_m, {0.0, 90.0},
           "drift of the heading that it allows for, per metre travelled");
  v.Number("min_window_m", min_window_m, {0.0, 100.0}, "half width of the search, at least");
  v.Number("max_window_m", max_window_m, {0.0, 100.0}, "half width of the search, at most");
  v.Number("min_window_deg", min_window_deg, {0.0, 180.0}, "half angle of the search, at least");
  v.Number("max_window_deg", max_window_deg, {0.0, 180.0}, "half angle of the search, at most");
  v.NotMore("min_window_m", min_window_m, "max_window_m", max_window_m);
  v.NotMore("min_window_deg", min_window_deg, "max_window_deg", max_window_deg);
  v.Number("candidates", candidates, {1, 1000}, "places that one search tries, at most");
  v.Group("place", place, "which scans are searched together");
  v.Number("min_score", min_score, {0.01, 1.0}, "share of the points that must lie on walls");
  v.Number("max_second_score", max_second_score, {0.01, 1.0},
           "a pose elsewhere with more than this share of the score makes it ambiguous");
  v.Number("min_explained", min_explained, {0.0, 1.0},
           "share of the scans that must be explained once matched precisely");
  v.Number("max_sigma_m", max_sigma_m, {0.0, 10.0},
           "sigma of that match in its worst direction, at most");
  v.Number("max_sigma_deg", max_sigma_deg, {0.0, 90.0}, "sigma of that match's heading, at most");
  v.Number("min_agreement", min_agreement, {0.0, 1.0},
           "share of what both places saw that must agree");
  v.Number("min_correction_m", min_correction_m, {0.0, 10.0},
           "no loop is made of a correction below this and below min_correction_deg");
  v.Number("min_correction_deg", min_correction_deg, {0.0, 90.0}, "see min_correction_m");
  v.Number("consenting", consenting, {1, 1000},
           "loops in a row that must ask for the same correction");
  v.Number("consent_ways", consent_ways, {0.0, 1000.0},
           "they must span this many times the sum of the correction and the likely drift");
  v.Number("likely_drift_share", likely_drift_share, {0.0, 1.0},
           "the likely drift, share of the distance travelled");
  v.Number("idle_searches", idle_searches, {1, 1000},
           "while no loop awaits consent, only one of this many searches is made; if it finds a "
           "place, the others follow");
  v.Number("most_unanswered", most_unanswered, {0, 1000},
           "searches that may find nothing while loops await consent");
  v.Number("consent_m", consent_m, {0.0, 10.0},
           "corrections within this of each other are the same");
  v.Number("consent_deg", consent_deg, {0.0, 90.0}, "and within this in heading");
}

// Path length over which two frames' estimates drifted apart: along the poses, or via one known
// loop.
double LoopSearch::DriftingM(const std::vector<PlanarLoop>& known, int first, int second) const {
  const auto along = [&](int a, int b) {
    return std::abs(way_m_[static_cast<std::size_t>(a)] - way_m_[static_cast<std::size_t>(b)]);
  };
  double shortest_m = along(first, second);
  for (const PlanarLoop& loop : known) {
    const auto [earlier, later] = std::minmax(loop.first, loop.second);
    shortest_m = std::min(shortest_m, along(first, earlier) + along(later, second));
  }
  return shortest_m;
}

double LoopSearch::WindowM(double way_m) const {
  return std::clamp(options_.drift_share * way_m, options_.min_window_m, options_.max_window_m);
}

double LoopSearch::WindowRad(double way_m) const {
  return RadFromDeg(std::clamp(options_.turn_deg_per_m * way_m, options_.min_window_deg,
                               options_.max_window_deg));
}

void LoopSearch::Walk(const std::vector<MappedFrame>& frames) {
  while (way_m_.size() < frames.size()) {
    const int i = static_cast<int>(way_m_.size());
    const double way_m =
        i == 0 ? 0.0
               : way_m_.back() +
                     Between(PoseAt(frames, i - 1), PoseAt(frames, i)).translation().norm();
    way_m_.push_back(way_m);
    if (!frames[static_cast<std::size_t>(i)].kept()) continue;
    if (keyframes_.empty() ||
        way_m - way_m_[static_cast<std::size_t>(keyframes_.back())] >= options_.every_m) {
      keyframes_.push_back(i);
    }
  }
}

// Old places where the query may be, nearest first.
std::vector<int> LoopSearch::Candidates(const std::vector<MappedFrame>& frames,
                                        const std::vector<PlanarLoop>& known, int query) const {
  struct Ranked {
    double cost = 0.0;
    int frame = 0;
  };
  std::vector<Ranked> ranked;
  const double farthest_m = options_.max_window_m + kBesideM;
  const Eigen::Vector2d here = PoseAt(frames, query).translation();
  for (const int k : keyframes_) {
    const double way_m =
        way_m_[static_cast<std::size_t>(query)] - way_m_[static_cast<std::size_t>(k)];
    if (way_m < options_.min_way_m) break;
    const double distance_m = (PoseAt(frames, k).translation() - here).norm();
    if (distance_m > farthest_m) continue;
    const Pose2 off = Between(PoseAt(frames, k), PoseAt(frames, query));
    if (std::abs(off.yaw_rad) > RadFromDeg(kMaxTurnDeg)) continue;
    if (distance_m > WindowM(DriftingM(known, k, query)) + kBesideM) continue;
    ranked.push_back({Separation(PoseAt(frames, k), PoseAt(frames, query)), k});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.cost < b.cost; });
  std::vector<int> candidates;
  for (const Ranked& r : ranked) {
    if (static_cast<int>(candidates.size()) == options_.candidates) break;
    candidates.push_back(r.frame);
  }
  return candidates;
}

// Whether both loops imply the same correction.
bool LoopSearch::Consents(const std::vector<MappedFrame>& frames, const PlanarLoop& a,
                          const PlanarLoop& b) const {
  const Pose2 by_a = PoseAt(frames, a.first) * a.first_from_second;
  const Pose2 by_b = PoseAt(frames, b.first) * b.first_from_second *
                     Between(PoseAt(frames, b.second), PoseAt(frames, a.second));
  return IsSmall(Between(by_a, by_b), options_.consent_m, options_.consent_deg);
}

// An unsuccessful search: with the right correction, an old place nearby should have been found.
void LoopSearch::Unanswered() {
  if (waiting_.empty() || ++unanswered_ <= options_.most_unanswered) return;
  waiting_.clear();
}

bool LoopSearch::Suffices(double correction_m, double way_m) const {
  const auto places = static_cast<double>(waiting_.size());
  const double off_m = std::min(correction_m + options_.likely_drift_share * way_m, WindowM(way_m));
  return places >= options_.consenting &&
         places * options_.every_m >= options_.consent_ways * off_m;
}

std::vector<PlanarLoop> LoopSearch::Find(const std::vector<MappedFrame>& frames,
                                         const std::shared_ptr<const Scan>& newest,
                                         const std::vector<PlanarLoop>& known,
                                         ReferenceMap& reference) {
  Walk(frames);
  if (way_m_.back() < next_search_m_) return {};
  next_search_m_ = way_m_.back() + options_.every_m;
  // The query lies back by reach_m, so that its place has frames on both sides.
  const double query_way_m = way_m_.back() - options_.place.reach_m;
  const auto at = [&](double way_m) {
    return static_cast<int>(std::lower_bound(way_m_.begin(), way_m_.end(), way_m) - way_m_.begin());
  };
  if (query_way_m < options_.min_way_m) return {};
  const Query query{at(query_way_m), static_cast<int>(frames.size())};
  if (Candidates(frames, known, query.frame).empty()) return {};
  if (reference.ShareSeenBefore(newest, frames.back().map_from_base,
                                at(query_way_m - options_.min_way_m)) > kKnownShare) {
    return {};
  }
  if (waiting_.empty() && static_cast<int>(put_off_.size()) + 1 < options_.idle_searches) {
    put_off_.push_back(query);
    return {};
  }
  const Answer answer = AnswerTo(frames, known, query);
  const std::vector<Query> before = std::exchange(put_off_, {});
  if (answer.loop) {
    for (const Query& earlier : before) AddAnswer(frames, AnswerTo(frames, known, earlier));
  }
  return AddAnswer(frames, answer) ? waiting_ : std::vector<PlanarLoop>{};
}

LoopSearch::Answer LoopSearch::AnswerTo(const std::vector<MappedFrame>& frames,
                                        const std::vector<PlanarLoop>& known, const Query& query) {
  KnownPlace query_place(frames, query.frame, options_.place, overlap_, query.end);
  for (const int candidate : Candidates(frames, known, query.frame)) {
    const double way_m = DriftingM(known, candidate, query.frame);
    KnownPlace& place = places_.Of({frames, candidate, options_.place, overlap_});
    const std::optional<PlanarLoop> loop =
        matcher_.LoopBetween(frames, place, query_place, WindowM(way_m), WindowRad(way_m));
    if (loop) return {loop, way_m};
  }
  return {};
}

// Adds the answer; returns whether enough loops agree now.
bool LoopSearch::AddAnswer(const std::vector<MappedFrame>& frames, const Answer& answer) {
  if (!answer.loop) {
    Unanswered();
    return false;
  }
  const PlanarLoop& loop = *answer.loop;
  const Pose2 correction = Between(Between(PoseAt(frames, loop.first), PoseAt(frames, loop.second)),
                                   loop.first_from_second);
  if (IsSmall(correction, options_.min_correction_m, options_.min_correction_deg)) {
    waiting_.clear();  // this place contradicts their correction
    return false;
  }
  if (!waiting_.empty() && !Consents(frames, waiting_.back(), loop)) waiting_.clear();
  if (waiting_.empty()) unanswered_ = 0;
  waiting_.push_back(loop);
  return Suffices(correction.translation().norm(), answer.way_m);
}

void LoopSearch::Forget() {
  waiting_.clear();
  put_off_.clear();
}

}  // namespace depthgrid
