#include "mapper/fuse/fusion_options.h"

namespace depthgrid {

void FusionOptions::Visit(OptionsVisitor& v) {
  v.PerAxis("gain", gain, {0.0, 1.0}, "K of Eq. 3: 0 takes SLAM's poses, 1 the matched ones");
}

}  // namespace depthgrid
