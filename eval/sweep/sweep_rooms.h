// The rooms and paths of a sweep's runs.
#pragma once

#include <string>
#include <vector>

#include "eval/sweep/sweep_plan.h"

namespace depthgrid {

// One line for each, with a hash of its files' content, so that a sweep cannot be resumed with a
// changed room.
std::string RoomsText(const SweepPlan& plan);

struct SweptRoom {
  std::string line;       // of RoomsText()
  std::string names;      // of its files, in the line
  std::vector<int> runs;  // of the plan that are in it, ascending
};

// The rooms of `text`, the plan's RoomsText(), in its order.
std::vector<SweptRoom> RoomsIn(const std::string& text, const SweepPlan& plan);
std::vector<std::string> LinesOfRooms(const std::string& text);

// "VALUE = NAME" for each scene by the value of its key: the name that its file gives it. Scenes
// that cannot be read are left out.
std::string SceneNamesText(const SweepPlan& plan);

// Throws InputError for a scene that cannot be read, and for a path or movers that none of their
// scenes has, or whose file is missing: every run of them must fail. A combination that does not
// fit is a failed run instead.
void RequireRooms(const SweepPlan& plan);

// Warnings about the paths, one line each. Rooms that cannot be read are skipped, because their
// runs fail with the reason.
std::vector<std::string> DoubtsOfPaths(const SweepPlan& plan, int threads);

}  // namespace depthgrid
