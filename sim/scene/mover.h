// What moves in a scene: a shape of its own and how it goes over the floor. docs/scenes.md,
// "Movers".
#pragma once

#include <array>
#include <string>
#include <vector>

#include "mapper/io/config.h"
#include "sim/mesh/triangle_mesh.h"

namespace depthgrid {

// What an experiment's `movers` may be beside names, which are joined by a plus sign.
constexpr const char* kAllMovers = "all";
constexpr const char* kNoMovers = "none";

struct MoverWaypoint {
  std::array<double, 2> at = {0, 0};  // world, metres
  double wait_s = 0.0;                // it stops here, turns and waits so long

  void Visit(OptionsVisitor& v);
};

struct MoverOptions {
  double ahead_m = 0.0;          // above 0 it keeps so far ahead of the camera and has no waypoints
  double speed_mps = 1.2;        // people indoors
  double turn_rate_dps = 120.0;  // deg/s, in bends and on the spot
  bool closed = false;           // it goes round, back to its first waypoint
  bool there_and_back = false;   // it turns at its last waypoint and goes back
  double laps = 0.0;             // how often it goes round, or there and back; 0 is without end
  double from_s = 0.0;           // when it sets out, or comes; the first frame is at 0
  bool stays = true;  // it stands there before it sets out and after it arrived, else is not there
  std::vector<MoverWaypoint> waypoints;
  std::string place;  // where this was written, for errors

  void Visit(OptionsVisitor& v);
};

struct Mover {
  std::string name;
  TriangleMesh mesh;  // in its own axes: x forward, z up, the floor under it is z = 0
  MoverOptions options;
};

// Reads and checks one entry of a scene file's `movers`, whose shapes are taken already. Throws
// InputError, also for a path that nobody can walk.
MoverOptions ReadMoverOptions(Config spec);

// Removes the movers that an experiment does not name with its `movers`: `all`, `none`, or names
// joined by a plus sign. Throws SettingError for a name that none has or that comes twice, and for
// `all` where there is none.
void KeepMovers(const std::string& chosen, std::vector<Mover>& movers);

}  // namespace depthgrid
