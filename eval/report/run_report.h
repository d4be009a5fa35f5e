// Writes report.html of a run's folder from the files in it.
#pragma once

#include <string>

#include "eval/report/report_place.h"

namespace depthgrid {

// timing.js is written beside it. Throws InputError when the folder holds no run. The page has no
// run times itself, so its bytes are the same for the same run.yaml.
void WriteRunReport(const std::string& folder, const ReportPlace& place);

}  // namespace depthgrid
