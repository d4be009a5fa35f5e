// The number of cores that this process may use.
#pragma once

namespace depthgrid {

// The number of cores in the affinity mask of the process's first thread, which may be fewer than
// the machine has (taskset, containers). As oneTBB counts them, which warns on standard error when
// asked for more threads.
int UsableThreads();

// `requested` limited to that number, at least 1.
int UsableThreads(int requested);

}  // namespace depthgrid
