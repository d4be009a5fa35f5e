// A moving object of a scene: its shape and its motion over the floor (docs/scenes.md, "Movers").
#pragma once

#include <array>
#include <string>
#include <vector>

#include "mapper/io/config.h"
#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// Values of an experiment's `movers` other than names joined by plus signs.
constexpr const char* kAllMovers = "all";
constexpr const char* kNoMovers = "none";

struct MoverWaypoint {
  std::array<double, 2> at = {0, 0};  // world, metres
  double wait_s = 0.0;                // it stops here, turns and waits this long

  void Visit(OptionsVisitor& v);
};

struct MoverOptions {
  double ahead_m = 0.0;          // above 0: keeps this far ahead of the camera, no waypoints
  double speed_mps = 1.2;        // walking speed of people indoors
  double turn_rate_dps = 120.0;  // deg/s, while walking and on the spot
  bool closed = false;           // returns to its first waypoint
  bool there_and_back = false;   // turns round at its last waypoint and walks back
  double laps = 0.0;             // number of rounds, or of trips there and back; 0: endless
  double from_s = 0.0;           // when it starts or appears; 0 is the first frame
  bool stays = true;             // present before it starts and after it arrives
  std::vector<MoverWaypoint> waypoints;
  std::string place;  // file and line, for errors

  void Visit(OptionsVisitor& v);
};

struct Mover {
  std::string name;
  TriangleMesh mesh;  // in its own axes: x forward, z up, the floor under it is z = 0
  MoverOptions options;
};

// Reads and checks one entry of a scene file's `movers`, without its shapes (already read). Throws
// InputError, also for an impossible path.
MoverOptions ReadMoverOptions(Config spec);

// Removes the movers that an experiment does not name with its `movers`: `all`, `none`, or names
// joined by a plus sign. Throws SettingError for an unknown or repeated name, and for `all` in a
// scene without movers.
void KeepMovers(const std::string& chosen, std::vector<Mover>& movers);

}  // namespace depthgrid
