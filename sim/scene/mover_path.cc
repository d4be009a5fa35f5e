#include "sim/scene/mover_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid {
namespace {

Pose2 Planar(const PathPose& pose) {
  return {pose.position_m.x(), pose.position_m.y(), WrapAngle(pose.yaw_rad)};
}

bool Waits(const MoverWaypoint& waypoint) { return waypoint.wait_s > 0.0; }

// The waypoints of one round in order of passing.
std::vector<std::size_t> StationsOf(const MoverOptions& options) {
  std::vector<std::size_t> stations;
  for (std::size_t i = 0; i < options.waypoints.size(); ++i) stations.push_back(i);
  if (options.closed) stations.push_back(0);
  if (options.there_and_back) {
    for (std::size_t i = options.waypoints.size() - 1; i-- > 0;) stations.push_back(i);
  }
  return stations;
}

TrajectoryOptions CurveOf(const MoverOptions& options) {
  TrajectoryOptions curve;
  curve.kind = TrajectoryKind::kPlanar;
  curve.height_m = 0.0;
  curve.speed_mps = options.speed_mps;
  curve.turn_rate_dps = options.turn_rate_dps;
  curve.place = options.place;
  return curve;
}

Waypoint CurvePoint(const MoverWaypoint& waypoint) {
  return {{waypoint.at.begin(), waypoint.at.end()}, {}};
}

}  // namespace

MoverPath::MoverPath(const MoverOptions& options)
    : options_(options), repeats_(options.closed || options.there_and_back) {
  if (options.ahead_m > 0.0) return;
  const auto& waypoints = options_.waypoints;
  const std::vector<std::size_t> stations = StationsOf(options_);
  if (options_.closed && std::none_of(waypoints.begin(), waypoints.end(), Waits)) {
    TrajectoryOptions curve = CurveOf(options_);
    curve.closed = true;
    for (const MoverWaypoint& waypoint : waypoints) curve.waypoints.push_back(CurvePoint(waypoint));
    const CameraPath path(curve);
    walks_.push_back({path, Planar(path.At(1.0))});
  } else {
    std::vector<double> waits_s;
    std::vector<std::size_t> walked = {stations.front()};
    for (std::size_t k = 1; k < stations.size(); ++k) {
      walked.push_back(stations[k]);
      const bool turns_back = options_.there_and_back && k + 1 == waypoints.size();
      const bool stops = Waits(waypoints[stations[k]]) || turns_back || k + 1 == stations.size();
      if (!stops) continue;
      AddWalk(walked);
      waits_s.push_back(waypoints[stations[k]].wait_s);
      walked = {stations[k]};
    }
    AddStands(waits_s);
  }
  for (const Walk& walk : walks_) round_s_ += walk.path.DurationS() + walk.stand_s;
}

void MoverPath::AddWalk(const std::vector<std::size_t>& stations) {
  TrajectoryOptions curve = CurveOf(options_);
  for (const std::size_t k : stations) curve.waypoints.push_back(CurvePoint(options_.waypoints[k]));
  const CameraPath path(curve);
  walks_.push_back({path, Planar(path.At(1.0))});
}

void MoverPath::AddStands(const std::vector<double>& waits_s) {
  for (std::size_t i = 0; i < walks_.size(); ++i) {
    Walk& walk = walks_[i];
    const bool is_last = i + 1 == walks_.size();
    if (!is_last || repeats_) {
      const Pose2 next = Planar(walks_[is_last ? 0 : i + 1].path.At(0.0));
      walk.turn_rad = WrapAngle(next.yaw_rad - walk.end.yaw_rad);
      walk.turn_s = DegFromRad(std::abs(walk.turn_rad)) / options_.turn_rate_dps;
    }
    walk.stand_s = std::max(waits_s[i], walk.turn_s);
  }
}

std::optional<Pose2> MoverPath::At(double time_s, const Pose2& world_from_base) const {
  const double since_s = time_s - options_.from_s;
  if (options_.ahead_m > 0.0) {
    if (since_s < 0.0) return {};
    return world_from_base * Pose2{options_.ahead_m, 0.0, 0.0};
  }
  const double rounds = repeats_ ? options_.laps : 1.0;
  const double length_s =
      rounds > 0.0 ? rounds * round_s_ : std::numeric_limits<double>::infinity();
  if (!options_.stays && (since_s < 0.0 || since_s > length_s)) return {};
  const double gone_s = std::clamp(since_s, 0.0, length_s);
  return InRound(repeats_ ? std::fmod(gone_s, round_s_) : gone_s);
}

Pose2 MoverPath::InRound(double since_s) const {
  for (const Walk& walk : walks_) {
    const double walk_s = walk.path.DurationS() + walk.stand_s;
    if (since_s <= walk_s) return PoseIn(walk, since_s);
    since_s -= walk_s;
  }
  return PoseIn(walks_.back(), walks_.back().path.DurationS() + walks_.back().stand_s);
}

Pose2 MoverPath::PoseIn(const Walk& walk, double since_s) {
  const double stood_s = since_s - walk.path.DurationS();
  if (stood_s < 0.0) return Planar(walk.path.At(since_s / walk.path.DurationS()));
  const double turned_s = stood_s - (walk.stand_s - walk.turn_s);
  const double share = walk.turn_s > 0.0 ? std::clamp(turned_s / walk.turn_s, 0.0, 1.0) : 0.0;
  return {walk.end.x_m, walk.end.y_m, WrapAngle(walk.end.yaw_rad + share * walk.turn_rad)};
}

}  // namespace depthgrid
