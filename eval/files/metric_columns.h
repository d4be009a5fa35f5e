// The scores of a run as named numbers, one column each.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace depthgrid {

// The figures of a metrics.json under their paths there, NaN for null, less what IsBreakdown().
// `place` names the text in errors.
std::vector<std::pair<std::string, double>> MetricColumns(const std::string& metrics_json,
                                                          const std::string& place);

// "|NAME - 1|": how far a score is from the value it should have.
std::string DistanceName(const std::string& metric, double target);

}  // namespace depthgrid
