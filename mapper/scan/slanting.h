// Surfaces that are seen at a slant: the top of a kerb, of a bed, of a step. Neighbouring rows meet
// them so far apart in range that no noise window holds enough, and what is low shows only a row or
// two of its front.
#pragma once

#include <span>
#include <vector>

#include "mapper/scan/bearing_lines.h"
#include "mapper/scan/bearing_returns.h"
#include "mapper/scan/noise_window.h"

namespace depthgrid {

// The smallest sample of min_returns rows or more, one after the other, that are all nearer than
// `nearer_than_m` and lie on one surface: from row to row their ranges change no more than on the
// steepest surface that anything comes back from, and a noise window. kPassing when there are none.
// Rows that are not usable are passed over. `samples` are the line's, one a row from `first_row`
// on. Wrong pixels and those between two surfaces hardly ever follow on each other like this.
float NearestSlanting(std::span<const float> samples, int first_row, const BearingLine& line,
                      const ReturnLimits& limits, const NoiseWindow& window, float nearer_than_m);

// FindNearest, or where there is such a surface before that, this one: at the mean over the noise
// window above its smallest sample.
float FindNearestOrSlanting(std::span<const float> samples, int first_row, const BearingLine& line,
                            const ReturnLimits& limits, const NoiseWindow& window,
                            std::vector<float>& sorted, BearingReturns& returns);

}  // namespace depthgrid
