#include "mapper/scan/moving_objects.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// Neighbouring beams whose ranges differ by more are on two objects: the distance of a person from
// the wall behind, and 4 sigma of both ranges at 1 % noise.
constexpr double kJumpM = 0.15;
constexpr double kJumpShare = 0.05;
// Limits of a followed object: a person, not a table; near and large enough to affect a match.
constexpr double kWidestM = 0.8;
constexpr double kFarthestM = 4.0;
constexpr double kLeastShare = 0.05;  // of a scan's beams
constexpr std::size_t kLeastBeams = 5;
// The largest motion in the view between two scans.
constexpr double kFarthestStepM = 0.1;
// Objects hidden for this many scans, by noise or by somebody in front, are still recognised.
constexpr int kMostUnseenScans = 5;
// A person walking along a wall may be merged with it for up to 27 scans in simulated logs
// (docs/tried.md, "What moves"); objects judged moving this often are then searched for. Once is
// not enough: spurious objects made by noise would each cost a part of the view.
constexpr int kSurelyMoved = 3;
constexpr int kMostHiddenScans = 30;
// Judged moving this often, it is not SLAM's error: with odometry that drifts by 1.875 m, walls
// seemed to move up to four times (docs/tried.md, "What moves").
constexpr int kNoErrorOfSlam = 5;
// Returns this near to the followed point of a moving object may belong to it: half a person's
// width.
constexpr double kBesideM = 0.2;
// Nothing can be judged while a robot stands. After this many scans the first frames are gone
// (Beginning).
constexpr std::size_t kMostAssumed = 300;
// Half a person's width plus the error of the predicted step.
constexpr double kHiddenRadiusM = 0.3;
// A wider object surrounds the base or is split between both ends of a 360 degree scan.
constexpr auto kWidestHiddenRad = static_cast<float>(RadFromDeg(120.0));
// Chosen: the step is averaged over about five scans and decays as fast while hidden, as a person
// who reaches a wall goes no farther towards it (0.7 to 0.9 make no difference).
constexpr double kNewStepShare = 0.2;
constexpr double kKeptStepShare = 0.8;
// An object moves if it is off its predicted place by this share of the motion in the view that a
// standing object would have had. The visible middle of a standing object shifts by less as other
// sides come into view (docs/tried.md, "What moves").
constexpr double kMovingShare = 0.4;
// Judging restarts after this many times the least distance, as people do not walk evenly.
constexpr double kLongestWay = 2.5;

bool SaysSomething(const Beam& beam) { return beam.hit || beam.clear_to_m > beam.clear_from_m; }

double JumpM(double nearer_m) { return kJumpM + kJumpShare * nearer_m; }

bool IsOnOneObject(const Beam& a, const Beam& b) {
  const double nearer_m = std::min(a.range_m, b.range_m);
  return a.hit && b.hit && std::abs(a.range_m - b.range_m) <= JumpM(nearer_m);
}

Eigen::Vector2d MeanEndPoint(const std::vector<Beam>& beams, std::size_t begin, std::size_t end) {
  Eigen::Vector2d sum_m = Eigen::Vector2d::Zero();
  for (std::size_t i = begin; i < end; ++i) sum_m += EndPoint(beams[i]);
  return sum_m / static_cast<double>(end - begin);
}

bool IsBehind(const Beam& beam, const Beam& edge) {
  return !beam.hit || beam.range_m > edge.range_m;
}

// Whether the beams `begin` to `end` are the true end of an object: of the kLeastBeams beams
// beyond, from `next` on by `step`, all but one lie behind it (noise may affect one).
bool IsAnEnd(const std::vector<Beam>& beams, std::size_t begin, std::size_t end, std::size_t next,
             int step) {
  double range_m = 0.0;
  for (std::size_t i = begin; i < end; ++i) range_m += beams[i].range_m;
  range_m /= static_cast<double>(end - begin);
  std::size_t behind = 0;
  for (std::size_t i = 0; i < kLeastBeams && next < beams.size(); ++i, next += step) {
    behind += !beams[next].hit || beams[next].range_m > range_m + JumpM(range_m) ? 1 : 0;
  }
  return behind + 1 >= kLeastBeams;
}

}  // namespace

// The object of beams `begin` to `end`; empty if it is not to be followed.
std::optional<MovingObjects::Object> MovingObjects::ObjectOf(const Scan& scan, std::size_t begin,
                                                             std::size_t end) {
  const std::vector<Beam>& beams = scan.beams;
  const std::size_t count = end - begin;
  const bool is_large = count >= kLeastBeams && static_cast<double>(count) >=
                                                    kLeastShare * static_cast<double>(beams.size());
  if (!is_large) return {};
  // The view ends at the last beam with data: some cameras have margins without depth.
  const auto at = [&](std::size_t i) { return beams.begin() + static_cast<std::ptrdiff_t>(i); };
  const bool has_first = std::any_of(beams.begin(), at(begin), SaysSomething);
  const bool has_last = std::any_of(at(end), beams.end(), SaysSomething);
  if (!has_first && !has_last) return {};
  if (has_first && !IsBehind(beams[begin - 1], beams[begin])) return {};
  if (has_last && !IsBehind(beams[end], beams[end - 1])) return {};
  const bool is_cut = !has_first || !has_last;
  if (is_cut && has_first && !IsAnEnd(beams, begin, begin + kLeastBeams, begin - 1, -1)) return {};
  if (is_cut && has_last && !IsAnEnd(beams, end - kLeastBeams, end, end, 1)) return {};
  if ((EndPoint(beams[end - 1]) - EndPoint(beams[begin])).norm() > kWidestM) return {};
  const Eigen::Vector2d middle_m = MeanEndPoint(beams, begin, end);
  if (middle_m.norm() > kFarthestM) return {};
  Object object{.begin = begin, .end = end};
  const auto follow = [&](std::size_t point, const Eigen::Vector2d& at_m) {
    object.points[point] = {.at_m = at_m, .began_at_m = at_m, .would_be_m = at_m};
  };
  if (has_first && has_last) follow(kMiddle, middle_m);
  if (has_first) follow(kFirstEnd, MeanEndPoint(beams, begin, begin + kLeastBeams));
  if (has_last) follow(kLastEnd, MeanEndPoint(beams, end - kLeastBeams, end));
  return object;
}

void MovingObjects::Find(const Scan& scan) {
  const std::vector<Beam>& beams = scan.beams;
  for (std::size_t begin = 0, end = 0; begin < beams.size(); begin = end) {
    end = begin + 1;
    if (!beams[begin].hit) continue;
    while (end < beams.size() && IsOnOneObject(beams[end - 1], beams[end])) ++end;
    if (const std::optional<Object> object = ObjectOf(scan, begin, end)) {
      objects_.push_back(*object);
    }
  }
}

// Predicts the known objects' places: `would_be_m` if standing, `at_m` where they are searched for.
void MovingObjects::Carry(const Pose2& base_from_before) {
  std::swap(objects_, before_);
  // Objects not recognised in the last scan are still in the old before_, which is now objects_.
  for (Object& object : objects_) {
    if (object.unseen_scans <= kMostUnseenScans) before_.push_back(std::move(object));
  }
  objects_.clear();
  for (Object& object : before_) {
    for (std::optional<Point>& point : object.points) {
      if (!point) continue;
      point->would_be_m = base_from_before * point->would_be_m;
      if (object.verdict == Verdict::kMoves) {
        point->at_m += object.step_m;
      } else {
        point->at_m = base_from_before * point->at_m;
      }
    }
    ++object.unseen_scans;
  }
}

// The offset between the middles, or between ends if one of the two objects is cut; infinite if
// they are cut at opposite sides.
Eigen::Vector2d MovingObjects::OffM(const Object& known, const Object& seen) {
  for (std::size_t i = 0; i < known.points.size(); ++i) {
    if (known.points[i] && seen.points[i]) return seen.points[i]->at_m - known.points[i]->at_m;
  }
  return Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
}

// The middle if known, else an end.
const MovingObjects::Point& MovingObjects::FirstOf(const Points& points) {
  return **std::find_if(points.begin(), points.end(),
                        [](const auto& point) { return point.has_value(); });
}

void MovingObjects::Recognise(Object& object) {
  const auto nearest =
      std::min_element(before_.begin(), before_.end(), [&](const Object& a, const Object& b) {
        return OffM(a, object).norm() < OffM(b, object).norm();
      });
  if (nearest == before_.end()) return;
  const bool was_hidden = nearest->times_moved >= kSurelyMoved && nearest->unseen_scans > 1;
  const double farthest_m = was_hidden ? kHiddenRadiusM : kFarthestStepM;
  if (OffM(*nearest, object).norm() > farthest_m) return;
  for (std::size_t i = 0; i < object.points.size(); ++i) {
    if (!object.points[i] || !nearest->points[i]) continue;
    object.points[i]->began_at_m = nearest->points[i]->began_at_m;
    object.points[i]->would_be_m = nearest->points[i]->would_be_m;
  }
  object.verdict = nearest->verdict;
  object.step_m = nearest->step_m;
  object.times_moved = nearest->times_moved;
  object.is_assumed = nearest->is_assumed;
  object.assumed = std::move(nearest->assumed);
  if (object.verdict == Verdict::kMoves && !was_hidden) {
    object.step_m += kNewStepShare * OffM(*nearest, object);
  }
  before_.erase(nearest);
  Judge(object);
}

void MovingObjects::Judge(Object& object) {
  const Point& judged = FirstOf(object.points);
  const double way_m = (judged.would_be_m - judged.began_at_m).norm();
  if (way_m < after_m_) return;
  const bool moves = (judged.at_m - judged.would_be_m).norm() > kMovingShare * way_m;
  object.verdict = moves ? Verdict::kMoves : Verdict::kStands;
  object.times_moved = moves ? object.times_moved + 1 : 0;
  if (!moves) object.step_m.setZero();
  if (!moves && way_m <= kLongestWay * after_m_) return;
  if (!moves || object.times_moved >= kNoErrorOfSlam) {
    if (moves && object.is_assumed) mistaken_.push_back(std::move(object.assumed));
    object.is_assumed = false;
    object.assumed = {};
  }
  for (std::optional<Point>& point : object.points) {
    if (point) point->began_at_m = point->would_be_m = point->at_m;
  }
}

// For objects that moved and are not found in this scan, the returns at the predicted place are
// taken as the object. The prediction is not verified, so only for a while.
void MovingObjects::FindHidden(const Scan& scan) {
  const auto is_hidden = [&](const Object& known) {
    if (known.times_moved < kSurelyMoved || known.unseen_scans > kMostHiddenScans) return false;
    const Eigen::Vector2d& at_m = FirstOf(known.points).at_m;
    BeamRange hidden{scan.beams.size(), 0};
    for (std::size_t i = 0; i < scan.beams.size(); ++i) {
      const Beam& beam = scan.beams[i];
      if (!beam.hit || (EndPoint(beam) - at_m).norm() > kHiddenRadiusM) continue;
      hidden.begin = std::min(hidden.begin, i);
      hidden.end = i + 1;
    }
    if (hidden.begin == scan.beams.size()) return false;
    const float across_rad =
        scan.beams[hidden.end - 1].bearing_rad - scan.beams[hidden.begin].bearing_rad;
    if (across_rad > kWidestHiddenRad) return false;
    Object object = known;
    object.begin = hidden.begin;
    object.end = hidden.end;
    object.step_m *= kKeptStepShare;
    objects_.push_back(std::move(object));
    return true;
  };
  std::erase_if(before_, is_hidden);
}

bool MovingObjects::Moves(const Object& object, Unjudged unjudged) {
  if (object.verdict != Verdict::kNone) return object.verdict == Verdict::kMoves;
  switch (unjudged) {
    case Unjudged::kStands:
      return false;
    case Unjudged::kStandsIfCut:
      return object.is_free();
    case Unjudged::kStandsIfAssumed:
      return !object.is_assumed;
    case Unjudged::kMoves:
      break;
  }
  return true;
}

bool MovingObjects::IsHalfUnjudged(const Scan& scan) const {
  std::size_t unjudged = 0;
  for (const Object& object : objects_) {
    if (object.verdict == Verdict::kNone) unjudged += object.end - object.begin;
  }
  const auto hits = static_cast<std::size_t>(std::count_if(
      scan.beams.begin(), scan.beams.end(), [](const Beam& beam) { return beam.hit; }));
  return 2 * unjudged >= hits;
}

// Includes isolated returns beside the object, separated by beams without data: the sensor's
// minimum range may cut off part of a near person.
MovingObjects::BeamRange MovingObjects::WithFringe(const Object& object, const Scan& scan) {
  const std::vector<Beam>& beams = scan.beams;
  const Eigen::Vector2d& at_m = FirstOf(object.points).at_m;
  const auto farthest = [&](std::size_t last, std::size_t step) {
    std::size_t found = last;
    bool beyond = false;
    for (std::size_t i = last + step; i < beams.size(); i += step) {  // 0 - 1 wraps
      if (!SaysSomething(beams[i])) {
        beyond = true;
      } else if (!beams[i].hit || (EndPoint(beams[i]) - at_m).norm() > kBesideM) {
        break;
      } else if (beyond) {
        found = i;
      }
    }
    return found;
  };
  return {farthest(object.begin, static_cast<std::size_t>(-1)), farthest(object.end - 1, 1) + 1};
}

// The scan without its moving objects; the scan itself if there are none.
std::shared_ptr<const Scan> MovingObjects::Rest(const std::shared_ptr<const Scan>& scan,
                                                Unjudged unjudged) {
  const bool any = std::any_of(objects_.begin(), objects_.end(),
                               [&](const Object& object) { return Moves(object, unjudged); });
  if (!any) return scan;
  const std::shared_ptr<Scan> rest = pool_.Take();
  *rest = *scan;
  for (const Object& object : objects_) {
    if (!Moves(object, unjudged)) continue;
    const BeamRange beams = object.verdict == Verdict::kMoves ? WithFringe(object, *scan)
                                                              : BeamRange{object.begin, object.end};
    for (std::size_t i = beams.begin; i < beams.end; ++i) rest->beams[i] = Silent(scan->beams[i]);
  }
  return rest;
}

// The first scan defines where the map, or the epoch, lies. So cut objects, mostly walls, are
// assumed to stand, and the others too if they are half of the view.
void MovingObjects::AssumeTheyStand(const Scan& scan) {
  for (Object& object : objects_) {
    if (object.is_free()) continue;
    object.verdict = Verdict::kStands;
    object.is_assumed = true;
  }
  if (!IsHalfUnjudged(scan)) return;
  for (Object& object : objects_) object.is_assumed = true;
}

void MovingObjects::Remember(const Scan& scan, Object& object) const {
  if (!object.is_assumed || object.assumed.size() == kMostAssumed) return;
  const BeamRange beams = WithFringe(object, scan);
  object.assumed.push_back({.frame = frame_,
                            .first_rad = scan.beams[beams.begin].bearing_rad,
                            .last_rad = scan.beams[beams.end - 1].bearing_rad});
}

void MovingObjects::Follow(int frame, const Scan& scan, const Pose2& slam_from_base, int epoch) {
  if (after_m_ <= 0.0) return;
  frame_ = frame;
  const bool begins = !slam_from_before_ || epoch_ != epoch;
  if (begins) {
    objects_.clear();
    before_.clear();
    slam_from_before_ = slam_from_base;
  }
  epoch_ = epoch;
  Carry(Between(slam_from_base, *slam_from_before_));
  slam_from_before_ = slam_from_base;
  Find(scan);
  for (Object& object : objects_) {
    Recognise(object);
  }
  if (begins) AssumeTheyStand(scan);
  FindHidden(scan);
}

void MovingObjects::TakeOut(FrameScans& scans) {
  const std::shared_ptr<const Scan> all = scans.matched;
  const bool half_unjudged = IsHalfUnjudged(*all);
  for (Object& object : objects_) Remember(*all, object);
  const Unjudged matched = half_unjudged ? Unjudged::kStands : Unjudged::kStandsIfCut;
  const Unjudged drawn = half_unjudged ? Unjudged::kStandsIfAssumed : Unjudged::kMoves;
  scans.matched = Rest(all, matched);
  const bool differ = std::any_of(objects_.begin(), objects_.end(), [&](const Object& object) {
    return Moves(object, matched) != Moves(object, drawn);
  });
  scans.standing = differ ? Rest(all, drawn) : nullptr;
}

std::vector<std::vector<MovingObjects::Sector>> MovingObjects::TakeMistaken() {
  return std::exchange(mistaken_, {});
}

bool MovingObjects::MayBeMistaken() const {
  const auto is_assumed = [](const Object& object) {
    return object.is_assumed && object.assumed.size() < kMostAssumed;
  };
  if (after_m_ <= 0.0) return false;
  return !slam_from_before_ || std::any_of(objects_.begin(), objects_.end(), is_assumed) ||
         std::any_of(before_.begin(), before_.end(), is_assumed);
}

}  // namespace depthgrid
