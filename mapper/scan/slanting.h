// Surfaces seen at a slant: the top of a kerb, a bed or a step. Neighbouring rows meet them too far
// apart in range for one noise window, and low ones show only a row or two of their front.
#pragma once

#include <span>
#include <vector>

#include "mapper/scan/bearing_lines.h"
#include "mapper/scan/bearing_returns.h"
#include "mapper/scan/noise_window.h"

namespace depthgrid {

// The smallest sample of min_returns or more consecutive rows that are all nearer than
// `nearer_than_m` and on one surface: from row to row the range changes by at most a noise window
// plus the change on the steepest surface that gives returns (kSteepestTangent). kPassing if there
// are none. Unusable rows are skipped. `samples`: the line's, one per row from `first_row` on.
// Wrong pixels and pixels between two surfaces hardly ever form such a sequence.
float NearestSlanting(std::span<const float> samples, int first_row, const BearingLine& line,
                      const ReturnLimits& limits, const NoiseWindow& window, float nearer_than_m);

// FindNearest(), or a slanting surface before its result: then the mean over the noise window from
// that surface's smallest sample.
float FindNearestOrSlanting(std::span<const float> samples, int first_row, const BearingLine& line,
                            const ReturnLimits& limits, const NoiseWindow& window,
                            std::vector<float>& sorted, BearingReturns& returns);

}  // namespace depthgrid
