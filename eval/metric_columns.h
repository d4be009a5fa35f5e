// The scores of a run as named numbers, one column each.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace depthgrid {

// The figures of a metrics.json under their paths there, NaN for null, less what only breaks a
// figure down: full statistics of an error, other tolerances, confusion, reliability and counts.
// `place` names the text in errors.
std::vector<std::pair<std::string, double>> MetricColumns(const std::string& metrics_json,
                                                          const std::string& place);

}  // namespace depthgrid
