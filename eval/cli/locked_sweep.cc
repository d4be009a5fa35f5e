#include "eval/cli/locked_sweep.h"

#include <filesystem>
#include <system_error>

#include "eval/output/output_folder.h"
#include "eval/sweep/slurm.h"
#include "eval/sweep/sweep_database.h"
#include "mapper/core/error.h"

namespace depthgrid::cli {

namespace fs = std::filesystem;

LockedSweep::LockedSweep(const std::string& path, bool force) : path_(path) {
  RequireReachable(path);
  if (fs::exists(path) && !fs::is_directory(path)) {
    throw InputError(path, "is a file, the output must be a folder");
  }
  if (!force && fs::exists(path) && !fs::is_empty(path) && !IsSweep()) {
    throw InputError(path, "is not empty and holds no sweep; choose another folder, or --force");
  }
  if (!SweepDatabase::Exists(path)) RequireSweepNamesFree(path);
  std::error_code error;
  const bool created = fs::create_directories(path, error);
  if (error) throw InputError(path, "cannot be created: " + error.message());
  // If another program has the lock, the folder is its own, even if it was created here.
  lock_.emplace(path);
  created_ = created;
}

bool LockedSweep::IsThere() const { return fs::exists(path_ + "/.lock"); }

// A sweep killed before its plan was written has only the lock.
bool LockedSweep::IsSweep() const { return SweepDatabase::Exists(path_) || IsThere(); }

void LockedSweep::RemoveIfUnused() const {
  std::error_code ignored;
  if (created_ && IsThere() && !SweepDatabase::Exists(path_) && !HasSlurmJobs(path_)) {
    fs::remove_all(path_, ignored);
  }
}

}  // namespace depthgrid::cli
