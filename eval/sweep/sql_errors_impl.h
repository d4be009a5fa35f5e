// Converts SQLite's exceptions to errors that name the file.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <stdexcept>
#include <string>

#include "mapper/core/error.h"
#include "mapper/io/file.h"

namespace depthgrid {

// Returns the result of `work`. Damage may be anywhere in the file and is found only when read.
template <typename Work>
auto Reading(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const SQLite::Exception& error) {
    throw InputError(path, std::string("cannot be read: ") + error.what());
  }
}

// SQLite has a code of its own for the failure to enlarge the file that its readers share.
inline bool IsDiskFull(const SQLite::Exception& error) {
  return error.getErrorCode() == SQLITE_FULL ||
         error.getExtendedErrorCode() == SQLITE_IOERR_SHMSIZE;
}

// Failures such as a full disk (DiskFullError) or a read-only folder are not bad input, except a
// damaged file.
template <typename Work>
void Writing(const std::string& path, const Work& work) {
  try {
    work();
  } catch (const SQLite::Exception& error) {
    if (error.getErrorCode() == SQLITE_CORRUPT || error.getErrorCode() == SQLITE_NOTADB) {
      throw InputError(path, std::string("cannot be read: ") + error.what());
    }
    const std::string message = fmt::format("{}: cannot be written: {}", path, error.what());
    if (IsDiskFull(error)) throw DiskFullError(message);
    throw std::runtime_error(message);
  }
}

}  // namespace depthgrid
