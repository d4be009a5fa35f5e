// Stamps that do not rise from line to line: which of them is wrong, and where a clock was set back
// (docs/formats.md, "Laser logs").
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace depthgrid {

struct StampOrder {
  // From this position on the clock is so much behind: what is missing to the usual step.
  struct SetBack {
    std::size_t at = 0;
    double by_s = 0.0;
  };
  // Each stamp with what the clock was set back by before it. Empty where it is ahead of all that
  // come after it, which rise as they should: a glitch. What is still no later than those before it
  // is no scan of its own, or late itself.
  std::vector<std::optional<double>> stamps_s;
  std::vector<SetBack> set_back;
};

// In the order in which they were recorded. Of three stamps or fewer that disagree with the others
// it is these that are wrong. Stamps that fall from line to line are of no clock: all stay.
StampOrder OrderOf(const std::vector<double>& stamps_s);

// What to say of rows that are sorted by stamp: pairs with the rows of another file are found by
// it, so it is left as it is. `lines` are those of the stamps. Nothing where no clock was set back.
std::optional<std::string> DoubtOfSorted(const std::vector<double>& stamps_s,
                                         const std::vector<int>& lines, const std::string& place);

}  // namespace depthgrid
