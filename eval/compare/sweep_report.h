// report.html of a sweep (docs/report.md).
#pragma once

#include <string>

#include "eval/report/report_place.h"

namespace depthgrid {

// From the sweep's database. Also writes experiment.yaml, the keys that each run started from, so
// that the commands the page shows can be run in the folder. Throws InputError when the folder is
// no sweep's or none of its runs is finished yet.
void WriteSweepReport(const std::string& folder, const ReportPlace& place);

}  // namespace depthgrid
