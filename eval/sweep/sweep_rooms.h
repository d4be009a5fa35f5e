// The rooms and paths that a sweep's runs are in.
#pragma once

#include <string>
#include <vector>

#include "eval/sweep/sweep_plan.h"

namespace depthgrid {

// A line for each of them, with a hash of what its files hold: a sweep that goes on after one was
// changed would mix two rooms.
std::string RoomsText(const SweepPlan& plan);

// Throws InputError for a scene, path or movers with which every run must fail, as the name has a
// slip in it or the file is not there. A pair that does not go together is a failed run instead.
void RequireRooms(const SweepPlan& plan);

// What is amiss with the paths, a line each: of those in rooms that can be read, for the runs of
// the others fail and say why.
std::vector<std::string> DoubtsOfPaths(const SweepPlan& plan, int threads);

}  // namespace depthgrid
