// report.html of an ablation's folder, made from the files in it.
#pragma once

#include <string>

#include "eval/report/report_place.h"

namespace depthgrid {

bool IsAblationFolder(const std::string& folder);

// Throws InputError when the folder is not an ablation's.
void WriteAblationReport(const std::string& folder, const ReportPlace& place);

}  // namespace depthgrid
