#include "mapper/graph/relocation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/graph/old_views.h"
#include "mapper/graph/place_search.h"

namespace depthgrid {
namespace {

// Frames in the mean of usual_share_. With ten, a new room entered just before the loss would lower
// it to nearly nothing, and any guess would pass.
constexpr int kUsualFrames = 1000;
// Rate of the running mean recent_share_: about ten frames.
constexpr double kNewShare = 0.1;
// Frames between two judgements of the guess by them.
constexpr int kFramesToJudge = 15;
// Most points of the search; more give the same result.
constexpr std::size_t kMostPoints = 400;

std::vector<Eigen::Vector2d> Thinned(const std::vector<Eigen::Vector2d>& points) {
  const std::size_t stride = points.size() / kMostPoints + 1;
  std::vector<Eigen::Vector2d> thinned;
  for (std::size_t k = 0; k < points.size(); k += stride) thinned.push_back(points[k]);
  return thinned;
}

// Steps larger than this, plus what can be walked and turned during the loss, mean that SLAM
// restarted. Chosen, not measured: SLAM relocalises in its own map to 0.1 m and 3 degrees
// (docs/results.md, "Short losses").
constexpr double kStepM = 0.5;
constexpr double kStepRad = 0.5;
constexpr double kTurnRadps = 2.0;

// A camera that was carried may be as far away as after so long without a pose. Chosen: at 1 m/s
// that is beyond max_window_m.
constexpr double kCarriedS = 60.0;
// What a map usually explains, at least, where it never explained anything: with min_share that is
// what a right place does (kLeastOnMap).
constexpr double kLeastUsual = 0.35;

// Growth of the interval with each of the rarer searches that finds nothing, and its largest turn.
// Chosen: 30 m of path are searched 30 times, each further 30 m ten times.
constexpr double kRarer = 1.1;
constexpr double kRarestRad = kPi;
// How far around the newest frame, and with how many scans at most, the new part is compared with
// what was seen before: grids of 30 MB with a laser that reaches 12 m.
constexpr double kPartM = 30.0;
constexpr int kMostOfPart = 100;
// How far back along the way the scans of the last search reach, besides place.reach_m: where the
// camera came back through what it had not seen, most of 3 m lies on nothing.
constexpr double kLastReachM = 1.0;
// The share of min_agreement that the whole part must reach then and where the guess is right, as
// matches at the guess have bent it (docs/tried.md, "Lost and found").
constexpr double kBentAgreement = 0.985;

}  // namespace

void RelocationOptions::Visit(OptionsVisitor& v) {
  v.Flag("use", use, "whether the camera's pose is searched for after SLAM was lost");
  v.Number("slip_deg", slip_deg, {0.0, 180.0},
           "when the map suddenly explains little of a scan, headings up to this far off are "
           "tried; 0: none");
  v.Number("min_lost_s", min_lost_s, {0.0, 1e6},
           "shortest time without a pose after which it is searched for");
  v.Number("min_lost_epoch_s", min_lost_epoch_s, {0.0, 1e6},
           "the same where SLAM's poses go on elsewhere");
  v.Number("min_share", min_share, {0.0, 1.0},
           "a guess is right if the map explains this share of what it explained before the loss");
  v.Number("window_m", window_m, {0.1, 1e3}, "half width of the search, metres");
  v.Number("speed_mps", speed_mps, {0.0, 100.0}, "window_m grows by this for each second lost");
  v.Number("max_window_m", max_window_m, {0.1, 1e3}, "half width of the search, at most, metres");
  v.NotMore("window_m", window_m, "max_window_m", max_window_m);
  v.Number("every_m", every_m, {0.01, 100.0}, "distance travelled between two searches");
  v.Number("every_deg", every_deg, {1.0, 360.0}, "or turn between two searches");
  v.Number("most_searches", most_searches, {1, 1e6}, "searches before they become rarer");
  v.Group("place", place, "what is searched for together");
  v.Number("min_score", min_score, {0.01, 1.0}, "share of the points that must lie on walls");
  v.Number("max_second_score", max_second_score, {0.01, 1.0},
           "a pose elsewhere with more than this share of the score makes it ambiguous");
  v.Number("min_agreement", min_agreement, {0.0, 1.0},
           "share of what was seen both before and since that must agree");
  v.Number("consenting", consenting, {1, 1000}, "searches in a row that must find the same pose");
  v.Number("consent_m", consent_m, {0.0, 10.0}, "poses within this of each other are the same");
  v.Number("consent_deg", consent_deg, {0.0, 90.0}, "and within this in heading");
}

void Relocation::Explained(double share) {
  if (doubts()) return;
  explained_frames_ = std::min(explained_frames_ + 1, kUsualFrames);
  usual_share_ += (share - usual_share_) / explained_frames_;
}

void Relocation::Lost(double duration_s, const std::optional<Pose2>& step) {
  unjudged_s_ = std::max(unjudged_s_, duration_s);
  const bool elsewhere = step && IsElsewhere(duration_s, *step);
  unjudged_ =
      unjudged_ || duration_s >= (elsewhere ? options_.min_lost_epoch_s : options_.min_lost_s);
}

void Relocation::Restarted(double duration_s) {
  unjudged_s_ = std::max(unjudged_s_, duration_s);
  unjudged_restart_ = true;
}

void Relocation::Carried() {
  unjudged_s_ = std::max(unjudged_s_, kCarriedS);
  unjudged_ = unjudged_carried_ = true;
  usual_share_ = std::max(usual_share_, kLeastUsual);
}

void Relocation::Paused(double duration_s, const Pose2& step) {
  if (IsElsewhere(duration_s, step)) Lost(duration_s, step);
}

// SLAM that relocalises in its own map makes no such step.
bool Relocation::IsElsewhere(double duration_s, const Pose2& step) const {
  return step.translation().norm() > kStepM + options_.speed_mps * duration_s ||
         std::abs(step.yaw_rad) > kStepRad + kTurnRadps * duration_s;
}

bool Relocation::BeginIfDoubtful(double share, int next_frame) {
  const double lost_s = std::exchange(unjudged_s_, 0.0);
  const bool doubted = std::exchange(unjudged_, false);
  const bool restarted = std::exchange(unjudged_restart_, false);
  const bool carried = std::exchange(unjudged_carried_, false);
  if (!(doubted || restarted) || !options_.use || next_frame == 0) return false;
  // Lost again during the search: both losses form one new part. Not where the camera was carried,
  // as its motion is not known then.
  if (active_ && !carried && (doubts() || !doubted)) {
    lost_s_ += lost_s;
    return false;
  }
  // A loop reported with this frame already determines its place.
  if ((IsUsual(share) && !carried) || IsJoinedAt(next_frame)) return false;
  const bool is_forgotten = unsettled() && first_frame_ == next_frame;  // the part before this loss
  if (unsettled() && !is_forgotten) left_.push_back({first_frame_, next_frame});
  // Then last_known_ is from before that part.
  lost_s_ = lost_s + (is_forgotten ? lost_s_ : 0.0);
  if (!is_forgotten) way_before_m_ = 0.0;
  way_before_m_ += is_forgotten ? way_m_ : 0.0;
  active_ = true;
  believes_ = !doubted;
  rare_ = false;
  first_frame_ = next_frame;
  way_m_ = turn_rad_ = 0.0;
  next_m_ = options_.every_m;
  next_rad_ = RadFromDeg(options_.every_deg);
  searches_ = 0;
  rarity_ = 1.0;
  recent_share_ = 0.0;
  waiting_.reset();
  agreed_ = 0;
  return true;
}

bool Relocation::IsJoinedAt(int frame) const {
  return std::any_of(held_.begin(), held_.end(), [&](const PlanarLoop& loop) {
    const auto [earlier, later] = std::minmax(loop.first, loop.second);
    return earlier < frame && later >= frame;
  });
}

void Relocation::Joined(const std::vector<PlanarLoop>& loops) {
  held_ = loops;
  if (IsJoinedAt(first_frame_)) active_ = rare_ = false;
  std::erase_if(left_, [&](const GuessedPart& part) { return IsLeftByAny(part, loops); });
}

std::vector<GuessedPart> Relocation::GuessedParts(int mapped_frames) const {
  std::vector<GuessedPart> parts = left_;
  if (unsettled() && first_frame_ < mapped_frames) parts.push_back({first_frame_, mapped_frames});
  return parts;
}

void Relocation::GuessMoved() {
  recent_share_ = 0.0;
  waiting_.reset();
  agreed_ = 0;
}

bool Relocation::GuessIsRight(const std::vector<MappedFrame>& frames,
                              const std::shared_ptr<const Scan>& newest, ReferenceMap& reference) {
  const double share = reference.ShareSeenBefore(newest, frames.back().map_from_base, first_frame_);
  recent_share_ += kNewShare * (share - recent_share_);
  const int since = static_cast<int>(frames.size()) - first_frame_;
  return since % kFramesToJudge == 0 && IsUsual(recent_share_) &&
         WholePartAgrees(frames, {}, kBentAgreement * options_.min_agreement);
}

// Whether both corrections move the frame to the same pose.
bool Relocation::IsSame(const Pose2& a, const Pose2& b, const Pose2& map_from_base) const {
  const Pose2 off = Between(a * map_from_base, b * map_from_base);
  return off.translation().norm() < options_.consent_m &&
         std::abs(off.yaw_rad) < RadFromDeg(options_.consent_deg);
}

bool Relocation::IsDue(const std::vector<MappedFrame>& frames) {
  const int last = static_cast<int>(frames.size()) - 1;
  if (last > first_frame_) {
    const Pose2 step = Between(PoseAt(frames, last - 1), PoseAt(frames, last));
    way_m_ += step.translation().norm();
    turn_rad_ += std::abs(step.yaw_rad);
  }
  return way_m_ >= next_m_ || turn_rad_ >= next_rad_;
}

void Relocation::SetNext() {
  if (rare_ && agreed_ == 0) rarity_ *= kRarer;
  const double rarest_m = std::max(options_.every_m, options_.place.reach_m);
  const double rarest_rad = std::max(RadFromDeg(options_.every_deg), kRarestRad);
  next_m_ = way_m_ + std::min(rarity_ * options_.every_m, rarest_m);
  next_rad_ = turn_rad_ + std::min(rarity_ * RadFromDeg(options_.every_deg), rarest_rad);
}

// The more is searched, the likelier a false place is found.
bool Relocation::IsAgreed() const {
  const double least_m = rare_ ? options_.place.reach_m : 0.0;
  return agreed_ >= options_.consenting && way_m_ - agreed_from_m_ >= least_m;
}

std::optional<Pose2> Relocation::Find(const std::vector<MappedFrame>& frames,
                                      const std::shared_ptr<const Scan>& newest,
                                      ReferenceMap& reference) {
  if (active_ && GuessIsRight(frames, newest, reference)) {
    active_ = false;
    return std::nullopt;
  }
  if (!IsDue(frames)) return std::nullopt;
  const std::optional<Pose2> found =
      Search(frames, static_cast<int>(frames.size()) - 1, options_.place.reach_m);
  const bool same = found && waiting_ && IsSame(*waiting_, *found, frames.back().map_from_base);
  agreed_ = found ? (same ? agreed_ + 1 : 1) : 0;
  if (!same) agreed_from_m_ = way_m_;
  waiting_ = found;
  if (IsAgreed() && WholePartAgrees(frames, *found, options_.min_agreement)) {
    active_ = rare_ = false;
    return found;
  }
  rare_ = ++searches_ >= options_.most_searches;
  active_ = !rare_;
  SetNext();
  return std::nullopt;
}

bool Relocation::WholePartAgrees(const std::vector<MappedFrame>& frames, const Pose2& shift,
                                 double least) const {
  const int end = static_cast<int>(frames.size());
  const Pose2& newest = PoseAt(frames, end - 1);
  const std::vector<int> part =
      EvenlySpread(ViewsWithin(frames, first_frame_, end, newest, kPartM), kMostOfPart);
  const std::vector<int> old = OldFrames(frames, first_frame_, shift * newest, kPartM + kSightM);
  if (part.empty() || old.empty()) return false;
  const std::vector<int> near = SeenFromNear(frames, old, part, shift);
  PlanarLoop loop;
  loop.first = near.front();
  loop.second = part.back();
  loop.first_from_second = Between(PoseAt(frames, loop.first), shift * PoseAt(frames, loop.second));
  const Overlap overlap = OverlapOf(frames, near, part, loop, overlap_);
  return Agrees(overlap, overlap_) && overlap.agreement() >= least;
}

std::optional<int> Relocation::OneBefore(const std::vector<MappedFrame>& frames, int last) const {
  for (int i = last - 1; i >= first_frame_; --i) {
    if (AreApart(PoseAt(frames, i), PoseAt(frames, last), options_.every_m,
                 RadFromDeg(options_.every_deg))) {
      return i;
    }
  }
  return std::nullopt;
}

std::optional<Pose2> Relocation::FindAtLast(const std::vector<MappedFrame>& frames) {
  const int last = static_cast<int>(frames.size()) - 1;
  const std::optional<int> before = OneBefore(frames, last);
  if (!unsettled() || !before) return std::nullopt;
  for (const double reach_m : {options_.place.reach_m, kLastReachM}) {
    const std::optional<Pose2> found = Search(frames, last, reach_m);
    if (!found) continue;
    const std::optional<Pose2> again = Search(frames, *before, reach_m);
    if (again && IsSame(*found, *again, PoseAt(frames, last)) &&
        WholePartAgrees(frames, *found, kBentAgreement * options_.min_agreement)) {
      active_ = rare_ = false;
      return found;
    }
  }
  return std::nullopt;
}

std::optional<Pose2> Relocation::Search(const std::vector<MappedFrame>& frames, int last,
                                        double reach_m) const {
  const Pose2& origin = PoseAt(frames, first_frame_ - 1);
  const Pose2 last_known = last_known_.value_or(origin);
  const double half_m =
      std::min(options_.window_m + options_.speed_mps * lost_s_ + way_before_m_ + way_m_,
               options_.max_window_m);
  const std::vector<int> old = OldFrames(frames, first_frame_, last_known, half_m + kSightM);
  PlaceOptions place = options_.place;
  place.reach_m = reach_m;
  const std::vector<int> members = FramesAround(frames, last, place, first_frame_, last + 1);
  if (old.empty() || members.empty()) return std::nullopt;
  const int middle = members[members.size() / 2];
  const std::optional<Pose2> guess =
      ConfirmedAt(guess_matcher_, frames, old, members, middle, PoseAt(frames, middle));
  if (guess && IsSame(*guess, {}, PoseAt(frames, last))) return guess;
  const double resolution_m = options_.place.resolution_m;
  const WallPyramid walls(DrawPlace(frames, old, first_frame_ - 1, resolution_m));
  const std::vector<Eigen::Vector2d> points =
      Thinned(PointsOfPlace(frames, members, middle, resolution_m));
  const PlaceWindow window{Between(origin, last_known), half_m, kPi};
  const PlaceMatch best = SearchPlace(walls, points, window, options_.min_score);
  if (!best.found) return std::nullopt;
  const NotNear elsewhere{best.place_from_query};
  if (SearchPlace(walls, points, window, options_.max_second_score * best.score, elsewhere).found) {
    return std::nullopt;
  }
  return ConfirmedAt(matcher_, frames, old, members, middle, origin * best.place_from_query);
}

// Of the guess less must be seen again than of a place that is searched for: nothing else competes.
LoopSearchOptions Relocation::ForGuess(LoopSearchOptions gates) {
  gates.min_explained = 0.0;
  return gates;
}

// The correction of the part once its frame `middle` is matched near this pose with what was seen
// before; empty if the two do not agree.
std::optional<Pose2> Relocation::ConfirmedAt(const PlaceMatcher& matcher,
                                             const std::vector<MappedFrame>& frames,
                                             const std::vector<int>& old,
                                             const std::vector<int>& members, int middle,
                                             const Pose2& map_from_middle) const {
  const Pose2 shift = map_from_middle * Inverse(PoseAt(frames, middle));
  const std::vector<int> near = SeenFromNear(frames, old, members, shift);
  const int first = *std::min_element(near.begin(), near.end(), [&](int a, int b) {
    return Separation(PoseAt(frames, a), map_from_middle) <
           Separation(PoseAt(frames, b), map_from_middle);
  });
  PlanarLoop loop;
  loop.first = first;
  loop.second = middle;
  loop.first_from_second = Between(PoseAt(frames, first), map_from_middle);
  const std::optional<PlanarLoop> confirmed =
      matcher.Confirmed(frames, near, members, loop, options_.min_agreement);
  if (!confirmed) return std::nullopt;
  return PoseAt(frames, first) * confirmed->first_from_second * Inverse(PoseAt(frames, middle));
}

}  // namespace depthgrid
