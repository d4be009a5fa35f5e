// Whole files in and out. Readers of formats take the text from here, so that a missing, unreadable
// or absurdly large file is reported in one way.
#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

namespace depthgrid {

// Larger than any file the program reads whole (a laser log of hours is about 500 MB).
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30U;

// Throws InputError when the file is missing, a folder, or no regular file.
void RequireFile(const std::string& path);

// Throws InputError when the file is missing, is no regular file, cannot be read or is larger than
// `max_bytes`.
std::string ReadFile(const std::string& path, std::size_t max_bytes = kMaxFileBytes);

// Throws InputError, with what to do, for a file that begins as one of a program that compresses.
// Readers of text that take it line by line ask before they begin.
void RequireUncompressed(const std::string& path);

// ReadFile() for text: throws InputError for a compressed file as well.
std::string ReadTextFile(const std::string& path, std::size_t max_bytes = kMaxFileBytes);

// Writes beside `path` and renames, so that a reader sees the old file or the whole new one, never
// a part. Throws std::runtime_error (a failure while running, not bad input) and leaves nothing
// behind.
void WriteFile(const std::string& path, std::string_view content);
// The same of what `write` puts into the stream, so that a large file need not be held whole.
void WriteFile(const std::string& path, const std::function<void(std::ostream&)>& write);

}  // namespace depthgrid
