// The progress of a sweep, in a small text file beside the database, because a database in use must
// not be opened from another machine.
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

// Empty when the file is missing or damaged.
std::optional<SweepProgress> ReadProgress(const std::string& folder);

class ProgressFile {
 public:
  explicit ProgressFile(std::string folder) : folder_(std::move(folder)) {}

  // Writes at most once a second, and never the end, because a reader that sees the end opens the
  // database.
  void Note(const SweepProgress& progress);
  // For the end, after the database is closed.
  void NoteNow(const SweepProgress& progress);

 private:
  std::string folder_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace depthgrid
