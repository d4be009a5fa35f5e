// What of a sweep is likely not meant, found before its first run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/sweep/sweep_plan.h"

namespace depthgrid {

// Runs that must give what an earlier one gives, as the settings in which they differ have no
// effect there: one line, nothing when all differ. Of very many runs the first ones are looked at.
std::optional<std::string> DoubtOfRepeats(const SweepPlan& plan);

// Settings that the experiment's file holds for its own slam.profile, and that stay when `fixed` or
// an axis chooses another: one line.
std::optional<std::string> DoubtOfProfiles(const std::string& name, const Config& experiment,
                                           const Config& fixed, const std::vector<SweepAxis>& axes);

}  // namespace depthgrid
