// How far a sweep's folder is, in a small text file beside the database: a database in use is not
// to be opened from another machine.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>

namespace depthgrid {

struct SweepProgress {
  int done = 0;
  int total = 0;

  bool Finished() const { return done == total; }
};

// Nothing when the folder says nothing.
std::optional<SweepProgress> ReadProgress(const std::string& folder);

class ProgressFile {
 public:
  explicit ProgressFile(std::string folder) : folder_(std::move(folder)) {}

  // At most once a second, and never the end: whoever reads that goes to the database.
  void Note(const SweepProgress& progress);
  // Of the end: when the database is closed.
  void NoteNow(const SweepProgress& progress);

 private:
  std::string folder_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace depthgrid
