#include "eval/output_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// Follows links, and drops a trailing slash, so that siblings are siblings.
fs::path Resolved(const std::string& path) {
  if (path.empty()) throw InputError("-o", "must name a folder");
  fs::path resolved = fs::weakly_canonical(fs::absolute(path));
  return resolved.has_filename() ? resolved : resolved.parent_path();
}

void RequireUsable(const fs::path& target, const std::string& shown, bool force) {
  if (!fs::exists(target)) return;
  if (!fs::is_directory(target)) throw InputError(shown, "is a file, the output must be a folder");
  if (!force && !fs::is_empty(target)) {
    throw InputError(shown, "is not empty; choose another folder, or --force to write into it");
  }
}

// The topmost folder that create_directories(parent) is going to create.
fs::path FirstMissing(const fs::path& parent) {
  fs::path missing;
  for (fs::path p = parent; !p.empty() && !fs::exists(p); p = p.parent_path()) missing = p;
  return missing;
}

void MoveInto(const fs::path& from, const fs::path& to) {
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path destination = to / entry.path().filename();
    if (entry.is_directory() && fs::is_directory(destination)) {
      MoveInto(entry.path(), destination);
    } else {
      fs::rename(entry.path(), destination);
    }
  }
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path, bool force) : target_(Resolved(path)) {
  RequireUsable(target_, path, force);
  const fs::path parent = target_.parent_path();
  first_created_parent_ = FirstMissing(parent);
  std::error_code error;
  fs::create_directories(parent, error);
  work_ = parent / fmt::format(".{}.partial-{}", target_.filename().string(), ::getpid());
  if (!error) fs::remove_all(work_, error);
  if (!error) fs::create_directory(work_, error);
  if (error) throw InputError(path, "cannot be created: " + error.message());
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(work_, ignored);
  if (!committed_ && !first_created_parent_.empty()) {
    // Only what is empty: another program may have put something there meanwhile.
    for (fs::path p = target_.parent_path(); fs::remove(p, ignored); p = p.parent_path()) {
      if (p == first_created_parent_) break;
    }
  }
}

void OutputFolder::Commit() {
  std::error_code error;
  fs::rename(work_, target_, error);  // succeeds when the target is missing or an empty folder
  if (error) MoveInto(work_, target_);
  committed_ = true;
}

}  // namespace depthgrid
