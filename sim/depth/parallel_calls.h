// Independent calls on several threads, from the pool (oneTBB) that Embree uses too.
#pragma once

#include <cstddef>
#include <functional>

namespace depthgrid {

// call(k) for each k in [0, count), on up to `threads` threads. No call may depend on another.
void CallInParallel(std::size_t count, int threads, const std::function<void(std::size_t k)>& call);

}  // namespace depthgrid
