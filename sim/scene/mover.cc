#include "sim/scene/mover.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "sim/scene/mover_path.h"
#include "sim/shapes/item_options.h"

namespace depthgrid {
namespace {

constexpr double kLatestS = 1e5;  // more than a day

// Keys of a mover that keeps ahead of the camera.
struct AheadOptions {
  MoverOptions& options;

  void Visit(OptionsVisitor& v) const {
    v.Number("ahead_m", options.ahead_m, {0.1, 100.0}, "how far ahead of the camera it keeps");
    v.Number("from_s", options.from_s, {0.0, kLatestS}, "when it comes");
  }
};

void ReadAhead(const Config& spec, MoverOptions& options) {
  for (const ConfigEntry& entry : spec.Entries()) {
    if (entry.key == "ahead_m" || entry.key == "from_s") continue;
    throw InputError(spec.PlaceOfKey(entry.key),
                     fmt::format("{} is not for a mover with ahead_m, which goes "
                                 "where the camera looks",
                                 entry.key));
  }
  AheadOptions ahead{options};
  spec.Read(ahead);
}

std::vector<MoverWaypoint> ReadWaypoints(const std::vector<Config>& entries,
                                         const std::string& place) {
  std::vector<MoverWaypoint> waypoints;
  for (const Config& entry : entries) {
    if (!entry.Has("at")) throw InputError(entry.Place(), "at is missing, must be 2 numbers");
    MoverWaypoint waypoint;
    entry.Read(waypoint);
    waypoints.push_back(waypoint);
  }
  if (waypoints.size() < 2) {
    throw InputError(place, fmt::format("has {}, must have at least 2, or ahead_m",
                                        Counted(waypoints.size(), "waypoint")));
  }
  return waypoints;
}

void RequireOneWay(const MoverOptions& options) {
  if (options.closed && options.there_and_back) {
    throw InputError(options.place, "closed and there_and_back are both true, must be one of them");
  }
  if (options.closed && options.waypoints.size() < 3) {
    throw InputError(options.place,
                     "closed has 2 waypoints, must have at least 3; there_and_back needs no more");
  }
  if (options.laps > 0.0 && !options.closed && !options.there_and_back) {
    throw InputError(options.place, "laps needs closed: true or there_and_back: true");
  }
}

std::vector<std::string> NamesIn(const std::string& chosen) {
  std::vector<std::string> names;
  std::istringstream parts(chosen);
  for (std::string name; std::getline(parts, name, '+');) names.push_back(name);
  if (chosen.empty() || chosen.ends_with('+')) names.emplace_back();
  return names;
}

void RequireMover(const std::string& name, const std::string& chosen,
                  const std::vector<Mover>& movers) {
  std::vector<std::string> known;
  known.reserve(movers.size());
  for (const Mover& mover : movers) known.push_back(mover.name);
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  if (known.empty()) {
    throw SettingError(
        "movers", fmt::format("is '{}', must be {}: the scene has no movers", chosen, kNoMovers));
  }
  const std::string near = DidYouMean(name, known);
  known.insert(known.end(), {kAllMovers, kNoMovers});
  throw SettingError("movers", fmt::format("is '{}', must be one of {}, or names joined by +{}",
                                           chosen, fmt::join(known, ", "), near));
}

}  // namespace

void MoverWaypoint::Visit(OptionsVisitor& v) {
  v.Tuple("at", at, kCoordinate, "x y in world, metres");
  v.Number("wait_s", wait_s, {0.0, kLatestS}, "how long it waits here");
}

void MoverOptions::Visit(OptionsVisitor& v) {
  v.Number("speed_mps", speed_mps, {0.001, 10.0}, "its speed, slower in sharp bends");
  v.Number("turn_rate_dps", turn_rate_dps, {1.0, 360.0}, "how fast it turns, deg/s");
  v.Flag("closed", closed, "it goes round, back to its first waypoint");
  v.Flag("there_and_back", there_and_back, "it turns at its last waypoint and goes back");
  v.Number("laps", laps, {0.0, 1e6}, "how often; 0 is without end");
  v.Number("from_s", from_s, {0.0, kLatestS}, "when it sets out");
  v.Flag("stays", stays, "it stands there before it sets out and after it arrived");
}

MoverOptions ReadMoverOptions(Config spec) {
  MoverOptions options;
  options.place = spec.Place();
  if (spec.Has("ahead_m")) {
    ReadAhead(spec, options);
    return options;
  }
  const std::vector<Config> waypoints = spec.TakeMaps("waypoints");
  spec.Read(options);
  options.waypoints = ReadWaypoints(waypoints, options.place);
  RequireOneWay(options);
  const MoverPath checked(options);
  return options;
}

void KeepMovers(const std::string& chosen, std::vector<Mover>& movers) {
  if (chosen == kNoMovers) return movers.clear();
  if (chosen == kAllMovers && !movers.empty()) return;
  const std::vector<std::string> names = NamesIn(chosen);
  for (auto name = names.begin(); name != names.end(); ++name) {
    RequireMover(*name, chosen, movers);
    if (std::find(names.begin(), name, *name) == name) continue;
    throw SettingError("movers", fmt::format("is '{}', must name '{}' once", chosen, *name));
  }
  std::erase_if(movers, [&](const Mover& mover) {
    return std::find(names.begin(), names.end(), mover.name) == names.end();
  });
}

}  // namespace depthgrid
