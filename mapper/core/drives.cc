#include "mapper/core/drives.h"

namespace depthgrid {

std::vector<int> PriorNumbers(const std::vector<int>& frames) {
  std::vector<int> numbers(frames.size());
  int next = -1;
  for (std::size_t i = frames.size(); i-- > 0;) {
    numbers[i] = next--;
    if (i > 0 && BeginsDrive(frames[i - 1], frames[i])) --next;
  }
  return numbers;
}

}  // namespace depthgrid
