#include "mapper/io/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "mapper/core/error.h"
#include "mapper/io/end_task.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// First bytes of compressed files, and the program that decompresses each.
struct Compression {
  std::string_view begin;
  const char* name;
  const char* remedy;
};
constexpr Compression kCompressions[] = {{"\x1F\x8B", "gzip", "gunzip"},
                                         {"BZh", "bzip2", "bunzip2"},
                                         {"\xFD"
                                          "7zXZ",
                                          "xz", "unxz"},
                                         {"\x28\xB5\x2F\xFD", "zstd", "unzstd"},
                                         {"PK\x03\x04", "zip", "unzip"}};
constexpr std::size_t kLongestBegin = 5;

void RefuseCompressed(const std::string& path, std::string_view content) {
  for (const Compression& compression : kCompressions) {
    if (!content.starts_with(compression.begin)) continue;
    throw InputError(path, fmt::format("is compressed by {}: {} it first", compression.name,
                                       compression.remedy));
  }
}

// Unique among threads and processes that may write the same file at once.
std::string TemporaryName(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  return fmt::format("{}.{}.{}.tmp", path, ::getpid(), counter.fetch_add(1));
}

// The name of the file that is to be made of one with a TemporaryName(); empty for other files.
std::string TargetOf(std::string_view temporary) {
  constexpr std::string_view kEnding = ".tmp";
  if (!temporary.ends_with(kEnding)) return "";
  std::string_view name = temporary.substr(0, temporary.size() - kEnding.size());
  for (int numbers = 0; numbers < 2; ++numbers) {
    const std::size_t point = name.find_last_not_of("0123456789");
    const bool is_one = point != name.npos && name[point] == '.' && point + 1 < name.size();
    if (!is_one) return "";
    name = name.substr(0, point);
  }
  return std::string(name);
}

std::function<void(std::ostream&)> Writing(std::string_view content) {
  return [content](std::ostream& stream) {
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  };
}

[[noreturn]] void FailWriting(const std::string& path, int error) {
  const std::string message =
      fmt::format("{}: cannot be written: {}", path, error == 0 ? "failed" : std::strerror(error));
  if (IsDiskFull(error)) throw DiskFullError(message);
  throw std::runtime_error(message);
}

// The error number if something was lost, else 0; some file systems cannot sync.
int FailureToSync(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  const int failure = ::fsync(file) == 0 ? 0 : errno;
  ::close(file);
  return failure == EIO || IsDiskFull(failure) ? failure : 0;
}

enum class Until { kWritten, kOnDisk };

void WriteBesideAndRename(const std::string& path, const std::function<void(std::ostream&)>& write,
                          Until until) {
  const std::string temporary = TemporaryName(path);
  const EndTask remove_half([&temporary] {
    std::error_code ignored;
    fs::remove(temporary, ignored);
  });
  errno = 0;
  {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    write(stream);
    stream.close();
    if (!stream) FailWriting(path, errno);
  }
  if (until == Until::kOnDisk) {
    if (const int failure = FailureToSync(temporary)) FailWriting(path, failure);
  }
  std::error_code error;
  fs::rename(temporary, path, error);
  if (error) FailWriting(path, error.value());
  if (until == Until::kOnDisk) SyncToDisk(fs::absolute(path).parent_path().string());
}

}  // namespace

bool IsDiskFull(int error_number) { return error_number == ENOSPC || error_number == EDQUOT; }

void RequireFile(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  // Such as in a folder without permission.
  if (!fs::status_known(status)) throw InputError(path, "cannot be read: " + error.message());
  if (!fs::exists(status)) throw InputError(path, "no such file");
  if (fs::is_directory(status)) throw InputError(path, "is a folder, must be a file");
  if (!fs::is_regular_file(status)) throw InputError(path, "is not a regular file");
}

std::string ReadFile(const std::string& path, std::size_t max_bytes) {
  RequireFile(path);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw InputError(path, "cannot be read: " + error.message());
  if (size > max_bytes) {
    throw InputError(path, fmt::format("has {} bytes, at most {} are read", size, max_bytes));
  }
  std::ifstream stream(path, std::ios::binary);
  std::string content(static_cast<std::size_t>(size), '\0');
  if (!stream || !stream.read(content.data(), static_cast<std::streamsize>(size))) {
    throw InputError(path, "cannot be read");
  }
  return content;
}

void RequireUncompressed(const std::string& path) {
  RequireFile(path);
  std::ifstream stream(path, std::ios::binary);
  char begin[kLongestBegin] = {};
  stream.read(begin, kLongestBegin);
  RefuseCompressed(path, {begin, static_cast<std::size_t>(stream.gcount())});
}

std::string ReadTextFile(const std::string& path, std::size_t max_bytes) {
  std::string text = ReadFile(path, max_bytes);
  RefuseCompressed(path, text);
  return text;
}

void WriteFile(const std::string& path, std::string_view content) {
  WriteFile(path, Writing(content));
}

void WriteFileToDisk(const std::string& path, std::string_view content) {
  WriteFileToDisk(path, Writing(content));
}

void WriteFile(const std::string& path, const std::function<void(std::ostream&)>& write) {
  WriteBesideAndRename(path, write, Until::kWritten);
}

void WriteFileToDisk(const std::string& path, const std::function<void(std::ostream&)>& write) {
  const fs::path target = fs::absolute(path);
  RemoveHalves(target.parent_path().string(),
               [&target](const std::string& name) { return name == target.filename(); });
  WriteBesideAndRename(path, write, Until::kOnDisk);
}

void SyncToDisk(const std::string& path) {
  if (const int failure = FailureToSync(path)) FailWriting(path, failure);
}

// The number of the writer's process says nothing: it may run in another container or on another
// machine. A program that is stopped for an hour and goes on fails to write.
void RemoveHalves(const std::string& folder,
                  const std::function<bool(const std::string& name)>& is_target) {
  constexpr auto kLongestPause = std::chrono::hours(1);  // between two writes to one file
  const auto latest = fs::file_time_type::clock::now() - kLongestPause;
  std::error_code error;
  for (auto file = fs::directory_iterator(folder, error);
       !error && file != fs::directory_iterator(); file.increment(error)) {
    const std::string target = TargetOf(file->path().filename().string());
    if (target.empty() || !is_target(target)) continue;
    std::error_code vanished;
    if (!fs::is_regular_file(file->symlink_status(vanished))) continue;
    const auto written = file->last_write_time(vanished);
    if (!vanished && written < latest) fs::remove(file->path(), vanished);
  }
}

}  // namespace depthgrid
