// report.html of a run's folder, made from the files in it.
#pragma once

#include <string>

#include "eval/report/report_place.h"

namespace depthgrid {

// timing.js is written beside it. Throws InputError when the folder holds no run. Stage times
// are not in the page: it is the same bytes for the same run.yaml.
void WriteRunReport(const std::string& folder, const ReportPlace& place);

}  // namespace depthgrid
