#include "eval/cli/sequence_argument.h"

#include "mapper/io/tum_folder.h"

namespace depthgrid::cli {

std::vector<double> FrameStamps(const std::string& folder) {
  std::vector<double> stamps_s;
  for (const RecordedImage& image : ListTumFolder(folder).images) {
    stamps_s.push_back(image.stamp_s);
  }
  return stamps_s;
}

}  // namespace depthgrid::cli
