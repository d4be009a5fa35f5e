// report.html of a sweep (docs/report.md).
#pragma once

#include <string>

#include "eval/report/report_place.h"

namespace depthgrid {

// Writes the page from the sweep's database, and experiment.yaml with the keys common to all runs,
// so that the commands on the page can be run in the folder. Throws InputError when the folder is
// not a sweep's or none of its runs is finished.
void WriteSweepReport(const std::string& folder, const ReportPlace& place);

}  // namespace depthgrid
