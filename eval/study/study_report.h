// report.html of a study's folder, made from the files in it.
#pragma once

#include <string>

#include "eval/report/report_place.h"

namespace depthgrid {

bool IsStudyFolder(const std::string& folder);

// Throws InputError when the folder is not a study's or a case's folder is missing.
void WriteStudyReport(const std::string& folder, const ReportPlace& place);

}  // namespace depthgrid
