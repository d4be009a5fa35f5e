// The instruction set of the ray kernels.
#pragma once

namespace depthgrid {

// A setting rather than detected: AVX2 and AVX-512 differ in a tenth of all pixels by up to a
// micrometre, so results are reproducible to the byte only with the same one.
enum class RayIsa {
  kAvx2,    // packets of 8
  kAvx512,  // packets of 16, about a third faster; InputError on a machine without it
};

}  // namespace depthgrid
