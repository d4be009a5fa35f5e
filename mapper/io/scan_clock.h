// The stamps of a log's scans. Decreasing stamps are repaired (StampOrder), which depends on later
// ones and so needs a first pass over all of them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "mapper/io/stamp_order.h"

namespace depthgrid {

class ScanClock {
 public:
  // Restarts at the first scan.
  void Rewind() { next_ = 0; }
  // The stamp to use for the next scan; empty for a glitch that is ahead of all later stamps.
  // Before Mend() each is used as stated.
  std::optional<double> Take(double stated_s, int line);
  // Call after taking all. Whether some decrease; Take() then gives repaired stamps.
  bool Mend();

  // Whether the clock was set back just before the last scan taken.
  bool IsSetBack() const;
  // The places where it was set back, in seconds before the stamp `end_s` (as used).
  std::vector<std::string> Warnings(const std::string& path, double end_s) const;

 private:
  std::vector<double> stated_s_;
  std::vector<int> lines_;
  bool falls_ = false;
  bool mended_ = false;
  StampOrder order_;  // empty unless they fall
  std::size_t next_ = 0;
};

}  // namespace depthgrid
