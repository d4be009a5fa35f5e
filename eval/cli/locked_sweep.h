// The folder of a sweep that this program works on.
#pragma once

#include <optional>
#include <string>

#include "eval/sweep/sweep_folder.h"
#include "mapper/io/end_task.h"

namespace depthgrid::cli {

// The locked folder of a sweep. If it was created here, it is removed again when neither runs here
// nor jobs of Slurm (which continue by themselves) could be started.
class LockedSweep {
 public:
  // Throws InputError when the folder holds something else (`force`: other files may stay), cannot
  // be made, or is locked by another program.
  LockedSweep(const std::string& path, bool force);
  LockedSweep(const LockedSweep&) = delete;
  LockedSweep& operator=(const LockedSweep&) = delete;

  // False if someone has removed it meanwhile.
  bool IsThere() const;

 private:
  bool IsSweep() const;
  void RemoveIfUnused() const;

  std::string path_;
  bool created_ = false;
  std::optional<SweepLock> lock_;
  EndTask clean_{[this] { RemoveIfUnused(); }};
};

}  // namespace depthgrid::cli
