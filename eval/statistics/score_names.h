// Scores by name, which is their path in metrics.json (docs/metrics.md, "Scores as columns"): which
// are columns, and which are shown where all would be too many. Which direction is better is in
// metric_direction.h.
#pragma once

#include <span>
#include <string_view>

namespace depthgrid {

// Whether the number or group at `path` is only the detail of a score and is not a column: full
// statistics of an error, other tolerances, confusion, counts of cells and poses, the interval of a
// consistency.
bool IsBreakdown(std::string_view path);

// Whether `path` is a group of scores that is null as a whole where they are undefined, as for an
// empty map or trajectory: that null is not a score.
bool IsGroupOfScores(std::string_view path);

// A sweep's page initially shows the first of these that the sweep has.
std::span<const std::string_view> ScoresOfASweepsPage();
// Compared by default: one or two scores of each kind. The first ones are tested where there are
// enough pairs for a few tests only.
std::span<const std::string_view> ScoresToCompare();
std::span<const std::string_view> ScoresOfAnAblation();

}  // namespace depthgrid
