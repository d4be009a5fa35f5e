// The output folder of a command. Files are written to a sibling folder first, which replaces the
// output folder when the command is done, so that an error leaves nothing behind and nobody reads a
// partial result. For a mount point, whose siblings are on another file system, or a folder whose
// parent is not writable, to a folder inside it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "eval/output/result_files.h"
#include "mapper/io/end_task.h"

namespace depthgrid {

// Throws InputError when `path` is a dangling link, or it or its parent is inaccessible to this
// user. Call it first: other accesses to such a folder fail with the name of a file that the user
// did not give.
void RequireReachable(const std::string& path);
// Throws InputError when `path` is the current folder or a parent of it. These are not searched for
// files either, because they may be as large as a disk.
void RequireNotCurrent(const std::string& path);

class OutputFolder {
 public:
  // Throws InputError for what RequireReachable() rejects, and when `path` is a file, a folder that
  // is not empty (unless `force`), the current folder or a parent of it, or a folder that another
  // program is writing. `superseded`: files of an earlier result; those that are not written again
  // are removed, so that results are not mixed. `what`: the result, as marks name it
  // (eval/files/one_result.h).
  OutputFolder(const std::string& path, bool force, FileRule superseded = {},
               std::string what = "result");
  // Removes all written files unless Commit() was called.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  // Where to write until Commit().
  const std::filesystem::path& work() const { return work_; }
  std::string File(const std::string& name) const { return (work_ / name).string(); }

  // Moves the written files into place. In a folder that already has files (only with `force`, even
  // if they appeared meanwhile), files of the same name are replaced, superseded ones are removed
  // and all others remain: a user's own files are never deleted. A program that is killed, or
  // fails, when it has replaced some leaves a folder that RequireOneResult() rejects. Throws
  // std::runtime_error on failure; files not yet in place then remain where they are, and the
  // message says where.
  void Commit();

 private:
  void Take(const std::string& shown);
  void Clean() const;
  bool TakeName() const;
  void PutInPlace();
  void ReplaceFiles() const;
  void RemoveSuperseded(bool& any_replaced) const;

  std::filesystem::path target_;
  std::filesystem::path work_;
  bool force_;
  std::filesystem::path first_created_parent_;  // removed again on failure; empty if none
  int lock_ = -1;  // descriptor of work_, locked; the lock ends with the process
  bool committed_ = false;
  bool kept_ = false;  // files that could not be committed are not removed
  FileRule superseded_;
  std::string what_;
  std::optional<EndTask> clean_;
};

}  // namespace depthgrid
