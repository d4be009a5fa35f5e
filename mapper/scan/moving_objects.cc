#include "mapper/scan/moving_objects.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

// Neighbouring beams whose ranges differ by more lie on two objects: what a person stands out from
// a wall behind, and 4 sigmas of both at 1 % noise.
constexpr double kJumpM = 0.15;
constexpr double kJumpShare = 0.05;
// A person, not a table; near and large enough to carry a match along.
constexpr double kWidestM = 0.8;
constexpr double kFarthestM = 4.0;
constexpr double kLeastShare = 0.05;  // of a scan's beams
constexpr std::size_t kLeastBeams = 5;
// Between two scans nothing moves farther in the view.
constexpr double kFarthestStepM = 0.1;
// What noise, or somebody before it, hides for a moment is known again.
constexpr int kMostUnseenScans = 5;
// What lies off by this share of the way that it would have gone if it stood does not stand. The
// middle of what is seen of a thing that stands goes along by less, as other sides of it come into
// view (docs/tried.md, "What moves").
constexpr double kMovingShare = 0.4;
// Judging begins anew after so many times the least way: who walks does not walk evenly.
constexpr double kLongestWay = 2.5;

bool IsOnOneObject(const Beam& a, const Beam& b) {
  const double nearer_m = std::min(a.range_m, b.range_m);
  return a.hit && b.hit && std::abs(a.range_m - b.range_m) <= kJumpM + kJumpShare * nearer_m;
}

bool IsBehind(const Beam& beam, const Beam& edge) {
  return !beam.hit || beam.range_m > edge.range_m;
}

}  // namespace

// Of beams that hit one object; empty where it is none that is followed.
std::optional<MovingObjects::Object> MovingObjects::ObjectOf(const Scan& scan, std::size_t begin,
                                                             std::size_t end) {
  const std::vector<Beam>& beams = scan.beams;
  const std::size_t count = end - begin;
  const bool is_large = count >= kLeastBeams && static_cast<double>(count) >=
                                                    kLeastShare * static_cast<double>(beams.size());
  // At the edge of the view the rest of it is not seen.
  if (!is_large || begin == 0 || end == beams.size()) return {};
  if (!IsBehind(beams[begin - 1], beams[begin]) || !IsBehind(beams[end], beams[end - 1])) return {};
  if ((EndPoint(beams[end - 1]) - EndPoint(beams[begin])).norm() > kWidestM) return {};
  Object object{.begin = begin, .end = end};
  for (std::size_t i = begin; i < end; ++i) object.at_m += EndPoint(beams[i]);
  object.at_m /= static_cast<double>(count);
  object.began_at_m = object.would_be_m = object.at_m;
  return object.at_m.norm() <= kFarthestM ? std::optional(object) : std::nullopt;
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

// What was known before: where it would be, and where it is looked for.
void MovingObjects::Carry(const Pose2& base_from_before) {
  std::swap(objects_, before_);
  // What was not recognised in the last scan is still among before_, now objects_.
  for (const Object& object : objects_) {
    if (object.unseen_scans <= kMostUnseenScans) before_.push_back(object);
  }
  objects_.clear();
  for (Object& object : before_) {
    object.would_be_m = base_from_before * object.would_be_m;
    if (object.verdict != Verdict::kMoves) object.at_m = base_from_before * object.at_m;
    ++object.unseen_scans;
  }
}

void MovingObjects::Recognise(Object& object) {
  const auto off_m = [&](const Object& known) { return (known.at_m - object.at_m).norm(); };
  const auto nearest =
      std::min_element(before_.begin(), before_.end(),
                       [&](const Object& a, const Object& b) { return off_m(a) < off_m(b); });
  if (nearest == before_.end() || off_m(*nearest) > kFarthestStepM) return;
  object.began_at_m = nearest->began_at_m;
  object.would_be_m = nearest->would_be_m;
  object.verdict = nearest->verdict;
  before_.erase(nearest);
  Judge(object);
}

void MovingObjects::Judge(Object& object) const {
  const double way_m = (object.would_be_m - object.began_at_m).norm();
  if (way_m < after_m_) return;
  const bool moves = (object.at_m - object.would_be_m).norm() > kMovingShare * way_m;
  object.verdict = moves ? Verdict::kMoves : Verdict::kStands;
  if (moves || way_m > kLongestWay * after_m_) {
    object.began_at_m = object.would_be_m = object.at_m;
  }
}

bool MovingObjects::IsLeftOut(const Object& object, bool unjudged_too) {
  return object.verdict == Verdict::kMoves || (unjudged_too && object.verdict == Verdict::kNone);
}

std::shared_ptr<const Scan> MovingObjects::Rest(const std::shared_ptr<const Scan>& scan) {
  const std::vector<Beam>& beams = scan->beams;
  std::size_t unjudged = 0;
  for (const Object& object : objects_) {
    if (object.verdict == Verdict::kNone) unjudged += object.end - object.begin;
  }
  const auto hits = static_cast<std::size_t>(
      std::count_if(beams.begin(), beams.end(), [](const Beam& beam) { return beam.hit; }));
  const bool unjudged_too = 2 * unjudged < hits;
  const bool any = std::any_of(objects_.begin(), objects_.end(), [&](const Object& object) {
    return IsLeftOut(object, unjudged_too);
  });
  if (!any) return scan;
  const std::shared_ptr<Scan> rest = pool_.Take();
  rest->max_range_m = scan->max_range_m;
  rest->beams.clear();
  auto next = beams.begin();
  for (const Object& object : objects_) {
    if (!IsLeftOut(object, unjudged_too)) continue;
    const auto first = beams.begin() + static_cast<std::ptrdiff_t>(object.begin);
    rest->beams.insert(rest->beams.end(), next, first);
    next = beams.begin() + static_cast<std::ptrdiff_t>(object.end);
  }
  rest->beams.insert(rest->beams.end(), next, beams.end());
  return rest;
}

std::shared_ptr<const Scan> MovingObjects::ToMatch(const std::shared_ptr<const Scan>& scan,
                                                   const Pose2& slam_from_base, int epoch) {
  if (after_m_ <= 0.0) return scan;
  if (!slam_from_before_ || epoch_ != epoch) {
    objects_.clear();
    before_.clear();
    slam_from_before_ = slam_from_base;
  }
  epoch_ = epoch;
  Carry(Between(slam_from_base, *slam_from_before_));
  slam_from_before_ = slam_from_base;
  Find(*scan);
  for (Object& object : objects_) Recognise(object);
  return Rest(scan);
}

}  // namespace depthgrid
