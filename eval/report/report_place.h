// Where a report page is written: usually into the folder that it describes.
#pragma once

#include <string>

namespace depthgrid {

struct ReportPlace {
  std::string into;  // a folder
  // Relative path from the page to the folder that it describes, for links: empty, or ends in '/'.
  std::string back = {};
};

}  // namespace depthgrid
