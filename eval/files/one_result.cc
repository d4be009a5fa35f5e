#include "eval/files/one_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "mapper/core/error.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMarkName = ".depthgrid-replacing";

fs::path MarkIn(const fs::path& folder) { return folder / kMarkName; }

// The results that the folder's mark is of.
std::set<std::string> MarksIn(const fs::path& folder) {
  std::error_code unknown;
  if (!fs::exists(MarkIn(folder), unknown)) return {};
  std::set<std::string> marks;
  std::istringstream lines(ReadFile(MarkIn(folder).string()));
  for (std::string line; std::getline(lines, line);) marks.insert(line);
  return marks;
}

void WriteMarks(const fs::path& folder, const std::set<std::string>& marks) {
  if (marks.empty()) {
    fs::remove(MarkIn(folder));
  } else {
    // Before anything is replaced, whatever happens.
    WriteFileToDisk(MarkIn(folder).string(), fmt::format("{}\n", fmt::join(marks, "\n")));
  }
}

}  // namespace

void MarkAsReplaced(const std::string& folder, const std::string& what) {
  std::set<std::string> marks = MarksIn(folder);
  if (marks.insert(what).second) WriteMarks(folder, marks);
}

void UnmarkAsReplaced(const std::string& folder, const std::string& what) {
  std::set<std::string> marks = MarksIn(folder);
  if (marks.erase(what) > 0) WriteMarks(folder, marks);
}

bool IsMarkedAsReplaced(const std::string& folder, const std::string& what) {
  return MarksIn(folder).contains(what);
}

void RemoveMarks(const std::string& folder) { fs::remove(MarkIn(folder)); }

bool IsMark(const fs::path& file) { return file.filename() == kMarkName; }

void RequireOneResult(const std::string& folder, const std::vector<std::string>& of) {
  const std::set<std::string> marks = MarksIn(folder);
  const bool is_marked = std::any_of(marks.begin(), marks.end(), [&](const std::string& what) {
    return of.empty() || std::find(of.begin(), of.end(), what) != of.end();
  });
  std::error_code unknown;  // without links, to find what it lies in
  const fs::path study = fs::weakly_canonical(fs::absolute(folder), unknown).parent_path();
  const bool is_case = of.empty() && MarksIn(study).contains(kMarkOfStudy);
  if (!is_marked && !is_case) return;
  throw InputError(
      folder, fmt::format("holds files of two results: a command that replaced one was killed or "
                          "failed, as {} says; --force writes it again",
                          (is_marked ? MarkIn(folder) : MarkIn(study)).string()));
}

void RequireOneResultAround(const std::string& file, const std::vector<std::string>& of) {
  if (file.empty()) return;
  const fs::path folder = fs::path(file).parent_path();
  RequireOneResult(folder.empty() ? "." : folder.string(), of);
}

}  // namespace depthgrid
