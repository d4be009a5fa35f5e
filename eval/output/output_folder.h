// The folder a command writes. Everything goes to a sibling first and takes its place when the
// command is done, so that an error leaves nothing behind, and nobody reads half a result. Of a
// mount point, whose siblings are on another file system, or of a folder beside which this user may
// not write, to a folder inside it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "eval/output/result_files.h"
#include "mapper/io/end_task.h"

namespace depthgrid {

// Throws InputError when `path` is a link to nothing, or lies or is where this user may not write.
// To be asked first: whoever looks into such a folder fails on a file that no user has named.
void RequireReachable(const std::string& path);
// Throws InputError when `path` is the current folder or one around it, which are not looked into
// either: they may be as large as a disk.
void RequireNotCurrent(const std::string& path);

class OutputFolder {
 public:
  // Throws InputError for what RequireReachable() refuses, and when `path` is a file, a folder that
  // is not empty unless `force`, the current folder or one around it, or one that another program
  // is about to write. `superseded`: which files there an earlier result left; those go that are
  // not written again, so that no two results are mixed.
  OutputFolder(const std::string& path, bool force, FileRule superseded = {});
  // Removes everything again unless Commit() was called.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  // Where to write until Commit().
  const std::filesystem::path& work() const { return work_; }
  std::string File(const std::string& name) const { return (work_ / name).string(); }

  // Puts the written files in place. In a folder that has files already (with `force` only, also
  // where they came there meanwhile), files of the same name are replaced, superseded ones go and
  // all others stay: what a user put there is never deleted. Throws std::runtime_error when that
  // cannot be done; the files that are not in place then stay where they are, and the message says
  // where.
  void Commit();

 private:
  void Take(const std::string& shown);
  void Clean() const;
  void PutInPlace() const;
  void RemoveSuperseded() const;

  std::filesystem::path target_;
  std::filesystem::path work_;
  bool force_;
  std::filesystem::path first_created_parent_;  // removed again on failure; empty if none
  int lock_ = -1;  // the open work_, locked: whoever dies leaves nothing locked
  bool committed_ = false;
  bool kept_ = false;  // what could not be committed is not removed
  FileRule superseded_;
  std::optional<EndTask> clean_;
};

}  // namespace depthgrid
