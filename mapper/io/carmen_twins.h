// Logs that hold each scan twice: CARMEN's logger writes a scan as ROBOTLASER1, its predecessor
// wrote FLASER, and converters write both for readers of either. Only ROBOTLASER1 states angles.
#pragma once

#include <optional>

#include "mapper/io/carmen_line.h"

namespace depthgrid {

class CarmenTwins {
 public:
  // Adds a log's scan lines in their order.
  void Add(const CarmenScan& scan, int line_number);
  // The number of the first FLASER line, if nearly all of them repeat the readings of a ROBOTLASER1
  // line of the same time next to them.
  std::optional<int> FirstFlaser() const;

 private:
  std::optional<CarmenScan> last_;
  int flasers_ = 0, twins_ = 0;
  int first_flaser_line_ = 0;
};

}  // namespace depthgrid
