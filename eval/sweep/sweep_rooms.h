// The rooms and paths that a sweep's runs are in.
#pragma once

#include <string>

#include "eval/sweep/sweep_plan.h"

namespace depthgrid {

// A line for each of them, with a hash of what its files hold: a sweep that goes on after one was
// changed would mix two rooms.
std::string RoomsText(const SweepPlan& plan);

}  // namespace depthgrid
