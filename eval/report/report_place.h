// Where a report page is written: mostly into the folder that it is of.
#pragma once

#include <string>

namespace depthgrid {

struct ReportPlace {
  std::string into;  // a folder
  // From the page to the folder that it is of, for links: empty, or ends in '/'.
  std::string back = {};
};

}  // namespace depthgrid
