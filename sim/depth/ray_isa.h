// The instruction set of the ray kernels.
#pragma once

namespace depthgrid {

// Chosen, not detected: AVX2 and AVX-512 differ on a tenth of all pixels by up to a micrometre, so
// results are the same bytes only on one of them.
enum class RayIsa {
  kAvx2,    // packets of 8
  kAvx512,  // packets of 16, about a third faster; InputError on a machine without it
};

}  // namespace depthgrid
