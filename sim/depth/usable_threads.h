// How many threads this process may really run on.
#pragma once

namespace depthgrid {

// The cores that the process's affinity allows, which may be fewer than the machine has (taskset,
// containers): oneTBB warns on standard error when asked for more.
int UsableThreads();

// `requested` limited to these, at least 1.
int UsableThreads(int requested);

}  // namespace depthgrid
