// The stamps of a log's scans as they are taken: read through once, they are mended where they fall
// (StampOrder), which only those after them can tell.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "mapper/io/stamp_order.h"

namespace depthgrid {

class ScanClock {
 public:
  // Begins at the first scan again.
  void Rewind() { next_ = 0; }
  // What the next scan's stamp is taken as; empty for one that is ahead of all after it. Until
  // Mend() each is taken as it is stated.
  std::optional<double> Take(double stated_s, int line);
  // Once all were taken. Whether some fall: then they are others from now on.
  bool Mend();

  // Whether the clock was set back just before the scan taken last.
  bool IsSetBack() const;
  // Where it was, in seconds before the stamp `end_s` as it is taken.
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
