// Repairs stamps that do not increase from line to line: finds which are wrong and where the clock
// was set back (docs/formats.md, "Laser logs").
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace depthgrid {

struct StampOrder {
  // From index `at` on the clock is behind by `by_s`, measured against the usual step.
  struct SetBack {
    std::size_t at = 0;
    double by_s = 0.0;
  };
  // Each stamp corrected for the clock being set back before it. Empty for a glitch: a stamp ahead
  // of all later ones, which increase normally. A corrected stamp that is still not later than its
  // predecessors belongs to a repeated or late scan.
  std::vector<std::optional<double>> stamps_s;
  std::vector<SetBack> set_back;
};

// `stamps_s` are in order of recording. If three or fewer stamps disagree with the others, these
// are wrong. Stamps that decrease from line to line are from no clock and all kept.
StampOrder OrderOf(const std::vector<double>& stamps_s);

// A warning for rows that will be sorted by stamp if the clock was set back, else nothing. The
// stamps are not corrected, as rows of other files are paired by them. `lines` are the stamps' line
// numbers.
std::optional<std::string> DoubtOfSorted(const std::vector<double>& stamps_s,
                                         const std::vector<int>& lines, const std::string& place);

}  // namespace depthgrid
