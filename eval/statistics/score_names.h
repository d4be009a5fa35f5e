// Scores by their names, which are paths in metrics.json (docs/metrics.md, "Scores as columns"):
// which of them are columns, and which come first where all would be too many. What is wanted of a
// score is in metric_direction.h.
#pragma once

#include <span>
#include <string_view>

namespace depthgrid {

// Whether what stands there, a number or a group of them, only breaks a figure down and is no
// column: full statistics of an error, other tolerances, confusion, counts of cells and poses, the
// band of a consistency.
bool IsBreakdown(std::string_view path);

// Whether what stands there is a group of scores, of which a map or a trajectory that shows nothing
// has none: null in the place of the group is no score.
bool IsGroupOfScores(std::string_view path);

// The first of them that a sweep has is what its page opens with.
std::span<const std::string_view> ScoresOfASweepsPage();
// What is compared when nothing is asked for: one or two figures of each kind, those first that
// should be tested where there are pairs for a few only.
std::span<const std::string_view> ScoresToCompare();
std::span<const std::string_view> ScoresOfAnAblation();

}  // namespace depthgrid
