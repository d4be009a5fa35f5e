#include "eval/output/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <future>
#include <stdexcept>
#include <utility>
#include <vector>

#include "eval/files/one_result.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// Resolves links and removes a trailing slash, so that a sibling's path can be formed.
fs::path Resolved(const std::string& path) {
  if (path.empty()) throw InputError("-o", "must name a folder");
  RequireReachable(path);
  fs::path resolved = fs::weakly_canonical(fs::absolute(path));
  return resolved.has_filename() ? resolved : resolved.parent_path();
}

// Whether files in it cannot be renamed to siblings of it: it is a mount point, such as a folder
// shared with a container, or a subvolume.
bool IsOnItsOwn(const fs::path& folder) {
  struct statx inside {};
  struct statx around {};
  const auto about = [](const fs::path& path, struct statx& known) {
    return ::statx(AT_FDCWD, path.c_str(), 0, STATX_BASIC_STATS, &known) == 0;
  };
  if (!about(folder, inside) || !about(folder.parent_path(), around)) return false;
  // A folder of the same disk may also be a mount point (bind mount).
  if ((inside.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0) return true;
  return inside.stx_dev_major != around.stx_dev_major ||
         inside.stx_dev_minor != around.stx_dev_minor;
}

fs::path WorkOf(const fs::path& target) {
  const std::string name = fmt::format(".{}.partial", target.filename().string());
  const fs::path around = target.parent_path();
  const bool inside = IsOnItsOwn(target) ||
                      (fs::is_directory(target) && ::access(around.c_str(), W_OK | X_OK) != 0);
  return (inside ? target : around) / name;
}

// Ignores the work folder and the mark of a killed program, which are hidden: a user who has
// removed all files that are listed sees an empty folder.
bool IsEmpty(const fs::path& target, const fs::path& work) {
  return std::all_of(fs::directory_iterator(target), fs::directory_iterator(),
                     [&](const fs::directory_entry& entry) {
                       return entry.path() == work || IsMark(entry.path());
                     });
}

void RequireUsable(const fs::path& target, const fs::path& work, const std::string& shown,
                   bool force) {
  if (!fs::exists(target)) return;
  if (!fs::is_directory(target)) throw InputError(shown, "is a file, the output must be a folder");
  if (!force && !IsEmpty(target, work)) {
    throw InputError(shown, "is not empty; choose another folder, or --force to write into it");
  }
}

// Rejects files and links in the work folder's place, which no killed program left there.
void RequireFolderOrNothing(const fs::path& work) {
  std::error_code error;
  const fs::file_status there = fs::symlink_status(work, error);
  if (!fs::exists(there) || fs::is_directory(there)) return;
  throw InputError(work.string(),
                   fmt::format("is a {}, must be a folder or not be there: it is written first",
                               fs::is_symlink(there) ? "link" : "file"));
}

// The topmost folder that create_directories(parent) would create.
fs::path FirstMissing(const fs::path& parent) {
  fs::path missing;
  for (fs::path p = parent; !p.empty() && !fs::exists(p); p = p.parent_path()) missing = p;
  return missing;
}

// Checked before anything is moved or removed: a file must not replace a folder, nor a folder a
// file or a link, whose target is not part of the output.
void RequireSameKinds(const fs::path& from, const fs::path& to) {
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path destination = to / entry.path().filename();
    const fs::file_status there = fs::symlink_status(destination);
    if (!fs::exists(there)) continue;
    if (entry.is_directory() && !fs::is_directory(there)) {
      throw std::runtime_error(fmt::format("{}: is a {}, must be a folder", destination.string(),
                                           fs::is_symlink(there) ? "link" : "file"));
    }
    if (!entry.is_directory() && fs::is_directory(there)) {
      throw std::runtime_error(destination.string() + ": is a folder, must be a file");
    }
    if (entry.is_directory()) RequireSameKinds(entry.path(), destination);
  }
}

void MoveInto(const fs::path& from, const fs::path& to, bool& any_replaced) {
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path destination = to / entry.path().filename();
    if (entry.is_directory() && fs::is_directory(fs::symlink_status(destination))) {
      MoveInto(entry.path(), destination, any_replaced);
    } else {
      fs::rename(entry.path(), destination);
      any_replaced = true;
    }
  }
}

// Several files at once, which a disk stores together: 10,000 small images take 36 s instead of 70
// on a busy disk (ext4), 11 s on one that is less so.
void SyncFilesToDisk(const fs::path& folder) {
  constexpr int kAtOnce = 8;
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path().string());
  }
  std::atomic<std::size_t> next = 0;
  const auto sync = [&] {
    for (std::size_t i = next++; i < files.size(); i = next++) {
      { const EndDelay goes_on; }  // blocks when the program ends: then the files are removed
      SyncToDisk(files[i]);
    }
  };
  std::vector<std::future<void>> syncing;
  for (int i = 0; i < kAtOnce; ++i) syncing.push_back(std::async(sync));
  for (std::future<void>& one : syncing) one.get();
}

void RemoveContents(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) fs::remove_all(entry.path());
}

// Whether the open folder still has this name.
bool IsNamed(int folder, const fs::path& name) {
  struct stat open_one {};
  struct stat named {};
  return ::fstat(folder, &open_one) == 0 && ::lstat(name.c_str(), &named) == 0 &&
         open_one.st_ino == named.st_ino && open_one.st_dev == named.st_dev;
}

}  // namespace

// If it is empty it would be replaced, and the shell would be left in a removed folder.
void RequireNotCurrent(const std::string& path) {
  const fs::path target = Resolved(path);
  std::error_code gone;
  const fs::path current = fs::canonical(".", gone);
  if (gone) return;
  const auto [rest, inside] =
      std::mismatch(target.begin(), target.end(), current.begin(), current.end());
  if (rest != target.end()) return;
  throw InputError("-o", fmt::format("{} {} the current folder, must be a folder of its own", path,
                                     inside == current.end() ? "is" : "holds"));
}

void RequireReachable(const std::string& path) {
  if (path.empty()) return;
  // With a trailing slash a link's name means its target.
  const fs::path given = path;
  const fs::path plain = given.has_filename() ? given : given.parent_path();
  std::error_code error;
  const fs::file_status there = fs::status(plain, error);
  if (there.type() == fs::file_type::not_found) {
    if (!fs::is_symlink(fs::symlink_status(plain, error))) return;
    throw InputError(path,
                     fmt::format("is a link to {}, which is not there; the output must be a folder",
                                 fs::read_symlink(plain).string()));
  }
  if (error) throw InputError(path, "cannot be created: " + error.message());
  if (fs::is_directory(there) && ::access(plain.c_str(), R_OK | W_OK | X_OK) != 0) {
    throw InputError(path, "cannot be written: " + std::generic_category().message(errno));
  }
}

OutputFolder::OutputFolder(const std::string& path, bool force, FileRule superseded,
                           std::string what)
    : target_(Resolved(path)),
      work_(WorkOf(target_)),
      force_(force),
      superseded_(std::move(superseded)),
      what_(std::move(what)) {
  RequireNotCurrent(path);
  RequireUsable(target_, work_, path, force);
  RequireFolderOrNothing(work_);
  const fs::path parent = target_.parent_path();
  first_created_parent_ = FirstMissing(parent);
  const EndDelay whole;
  try {
    fs::create_directories(parent);
    Take(path);
    RemoveContents(work_);  // left by a killed program
  } catch (const fs::filesystem_error& error) {
    throw InputError(path, "cannot be created: " + error.code().message());
  }
  try {
    // Again: another program may have written it meanwhile.
    RequireUsable(target_, work_, path, force);
  } catch (...) {
    fs::remove_all(work_);
    ::close(lock_);
    throw;
  }
  clean_.emplace([this] { Clean(); });
}

// Creates, opens and locks work_, for one program at a time.
void OutputFolder::Take(const std::string& shown) {
  while (lock_ < 0) {
    fs::create_directory(work_);
    lock_ = ::open(work_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (lock_ < 0) {
      if (errno == ENOENT) continue;  // its owner has just removed it
      throw fs::filesystem_error("open", work_, std::error_code(errno, std::generic_category()));
    }
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(lock_);
      throw InputError(shown, "is being written by another depthgrid; choose another folder");
    }
    if (IsNamed(lock_, work_)) return;
    ::close(lock_);
    lock_ = -1;
  }
}

OutputFolder::~OutputFolder() {
  clean_.reset();
  ::close(lock_);
}

void OutputFolder::Clean() const {
  if (kept_) return;
  std::error_code ignored;
  // After the commit, another program may use the name. On an immediate exit other threads may
  // still be writing, so removal is retried.
  constexpr int kMostTries = 100;
  for (int i = 0; i < kMostTries && IsNamed(lock_, work_); ++i) fs::remove_all(work_, ignored);
  if (!committed_ && !first_created_parent_.empty()) {
    // Only empty ones: another program may have written there meanwhile.
    for (fs::path p = target_.parent_path(); fs::remove(p, ignored); p = p.parent_path()) {
      if (p == first_created_parent_) break;
    }
  }
}

void OutputFolder::RemoveSuperseded(bool& any_replaced) const {
  if (!superseded_) return;
  std::vector<fs::path> superseded;
  const auto options = fs::directory_options::skip_permission_denied;
  for (auto entry = fs::recursive_directory_iterator(target_, options);
       entry != fs::recursive_directory_iterator(); ++entry) {
    if (entry->path() == work_) entry.disable_recursion_pending();
    const fs::path relative = entry->path().lexically_relative(target_);
    const bool is_file = entry->is_regular_file() && !entry->is_symlink();
    if (is_file && superseded_(relative) && !fs::exists(work_ / relative)) {
      superseded.push_back(entry->path());
    }
  }
  for (const fs::path& file : superseded) {
    fs::remove(file);
    any_replaced = true;
    std::error_code not_empty;  // parent folders are removed once they are empty
    fs::path parent = file.parent_path();
    while (parent != target_ && fs::remove(parent, not_empty)) parent = parent.parent_path();
  }
}

// Whether the work folder became the target, as it can where that is missing or an empty folder.
bool OutputFolder::TakeName() const {
  if (work_.parent_path() == target_) return false;
  std::error_code error;
  fs::rename(work_, target_, error);
  if (error && !fs::is_directory(fs::symlink_status(target_))) {
    throw fs::filesystem_error("rename", target_, error);
  }
  return !error;
}

// A mark that an earlier command left stays until one of its kind comes to the end.
void OutputFolder::ReplaceFiles() const {
  const std::string target = target_.string();
  if (IsEmpty(target_, work_)) RemoveMarks(target);
  const bool is_new_mark = !IsMarkedAsReplaced(target, what_);
  bool any_replaced = false;
  MarkAsReplaced(target, what_);
  try {
    RemoveSuperseded(any_replaced);
    MoveInto(work_, target_, any_replaced);
  } catch (...) {
    if (is_new_mark && !any_replaced) UnmarkAsReplaced(target, what_);
    throw;
  }
  UnmarkAsReplaced(target, what_);
}

void OutputFolder::PutInPlace() {
  {
    const EndDelay whole;
    committed_ = TakeName();
    if (committed_) return;
  }
  if (!force_ && !IsEmpty(target_, work_)) {
    throw std::runtime_error(target_.string() + ": is not empty any more");
  }
  RequireSameKinds(work_, target_);
  // An older result is only given up for one that a power cut cannot take. Many files take seconds,
  // in which the program may be ended.
  SyncFilesToDisk(work_);
  const EndDelay whole;
  ReplaceFiles();
  committed_ = true;
}

void OutputFolder::Commit() {
  const auto keep = [this](const std::string& why) {
    kept_ = true;
    return std::runtime_error(
        fmt::format("{}; what was to be written is in {} until the next command that writes {}",
                    why, work_.string(), target_.string()));
  };
  try {
    PutInPlace();
  } catch (const fs::filesystem_error& error) {
    const fs::path& place = error.path2().empty() ? error.path1() : error.path2();
    throw keep(place.string() + ": " + error.code().message());
  } catch (const std::runtime_error& error) {
    throw keep(error.what());
  }
}

}  // namespace depthgrid
