// Reads and writes whole files. All format readers use this, so that missing, unreadable or too
// large files are reported uniformly.
#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <string_view>

namespace depthgrid {

// Larger than any file the program reads whole (a laser log of hours is about 500 MB).
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30U;

// A file could not be written because the disk, or the user's share of it, is full.
class DiskFullError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
// Whether an error number (errno) says so.
bool IsDiskFull(int error_number);

// Throws InputError when the file is missing, a folder, or no regular file.
void RequireFile(const std::string& path);

// Throws InputError when the file is missing, is no regular file, cannot be read or is larger than
// `max_bytes`.
std::string ReadFile(const std::string& path, std::size_t max_bytes = kMaxFileBytes);

// Throws InputError, with advice, for a compressed file (by its first bytes). For readers that read
// line by line.
void RequireUncompressed(const std::string& path);

// ReadFile() for text: throws InputError for a compressed file as well.
std::string ReadTextFile(const std::string& path, std::size_t max_bytes = kMaxFileBytes);

// Writes beside `path` and renames, so that a reader sees the old file or the whole new one, never
// a part. Throws std::runtime_error (a failure while running, not bad input), DiskFullError where
// there is no room; then the old file is there and nothing beside it.
void WriteFile(const std::string& path, std::string_view content);
// The same for what `write` puts into the stream, so that a large file need not be in memory.
void WriteFile(const std::string& path, const std::function<void(std::ostream&)>& write);

// WriteFile() for what must survive a power cut: returns when the file is on the disk. Without
// this, a file system may store the new name before the content, and leave an empty file in place
// of the old one. Where only the name could not be stored, it throws though the new file is there.
// Takes 4 ms more on an SSD (ext4; 60 files of 30 kB: 0.22 s instead of 0.005).
void WriteFileToDisk(const std::string& path, std::string_view content);
void WriteFileToDisk(const std::string& path, const std::function<void(std::ostream&)>& write);
// Returns when the content of a file or the names in a folder are on the disk. Throws
// std::runtime_error where they are lost: the disk is full or defective. Every other failure is
// passed over: a file system that cannot do that, and what cannot be opened to be read.
void SyncToDisk(const std::string& path);

// Removes what killed programs left of writing files of `folder` whose names `is_target` holds for:
// those beside them, once they are an hour old. WriteFileToDisk() does so for its own file.
void RemoveHalves(const std::string& folder,
                  const std::function<bool(const std::string& name)>& is_target);

}  // namespace depthgrid
