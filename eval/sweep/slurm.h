// Runs the parts of a sweep as tasks of Slurm array jobs (docs/sweeps.md, "Slurm"). Whether a part
// is done is read from its folder, never from Slurm's accounting.
#pragma once

#include <functional>
#include <set>
#include <string>

namespace depthgrid {

struct SlurmJob {
  std::string title;
  std::string folder;   // of the whole sweep, absolute; parts go to folder/shards/I
  int parts = 1;        // tasks 1 .. parts
  std::string command;  // shell words of one part; $SLURM_ARRAY_TASK_ID is its number
  std::string options;  // for sbatch
  int cpus_per_task = 1;
  std::function<void(int done, int total)> progress;  // of runs; may throw to stop
};

// The folder of a part.
std::string PartFolder(const std::string& folder, int part);

// Writes the job script, submits the unfinished parts, waits, resubmits those that ended
// unfinished, and returns when all are finished. Throws std::runtime_error when sbatch fails, when
// squeue fails the first time or for five minutes, or when a part ends three times without
// progress.
void RunOnSlurm(const SlurmJob& job);

// Whether jobs were submitted from the folder of a sweep; they may still be running.
bool HasSlurmJobs(const std::string& folder);

// "1-3,7" for {1, 2, 3, 7}.
std::string ArrayText(const std::set<int>& parts);

}  // namespace depthgrid
