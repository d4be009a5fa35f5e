#include "eval/sweep/sweep_progress.h"

#include <fmt/format.h>

#include <filesystem>

#include "eval/sweep/sweep_axes.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

std::string PathIn(const std::string& folder) { return folder + "/progress.txt"; }

}  // namespace

std::optional<SweepProgress> ReadProgress(const std::string& folder) {
  if (!std::filesystem::exists(PathIn(folder))) return std::nullopt;
  try {
    const std::string text = ReadFile(PathIn(folder));
    const auto rows = SplitRows(text);
    if (rows.size() != 1) return std::nullopt;
    const auto numbers = NumbersIn(rows[0], 2, PathIn(folder));
    if (numbers[0] < 0.0 || numbers[1] < numbers[0] || numbers[1] > kMostSweepRuns) {
      return std::nullopt;
    }
    return SweepProgress{static_cast<int>(numbers[0]), static_cast<int>(numbers[1])};
  } catch (const InputError&) {  // removed or damaged meanwhile
    return std::nullopt;
  }
}

void ProgressFile::Note(const SweepProgress& progress) {
  constexpr std::chrono::seconds kInterval{1};
  if (progress.Finished()) return;
  if (std::chrono::steady_clock::now() - last_ > kInterval) NoteNow(progress);
}

void ProgressFile::NoteNow(const SweepProgress& progress) {
  WriteFile(PathIn(folder_), fmt::format("{} {}\n", progress.done, progress.total));
  last_ = std::chrono::steady_clock::now();
}

}  // namespace depthgrid
