// The scores of a run as columns: named numbers.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace depthgrid {

// The numbers of a metrics.json with their paths, NaN for null, without those for which
// IsBreakdown(). `place` names the text in errors.
std::vector<std::pair<std::string, double>> MetricColumns(const std::string& metrics_json,
                                                          const std::string& place);

// "|NAME - 1|": name of the distance of a score from its target.
std::string DistanceName(const std::string& metric, double target);

}  // namespace depthgrid
