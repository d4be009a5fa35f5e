// What SQLite fails with, as errors that name the file.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <stdexcept>
#include <string>

#include "mapper/core/error.h"

namespace depthgrid {

// What `work` gives. Damage may lie anywhere in the file, and show when that is read.
template <typename Work>
auto Reading(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const SQLite::Exception& error) {
    throw InputError(path, std::string("cannot be read: ") + error.what());
  }
}

// A full disk, a folder that may not be written: no bad input, unless the file is damaged.
template <typename Work>
void Writing(const std::string& path, const Work& work) {
  try {
    work();
  } catch (const SQLite::Exception& error) {
    if (error.getErrorCode() == SQLITE_CORRUPT || error.getErrorCode() == SQLITE_NOTADB) {
      throw InputError(path, std::string("cannot be read: ") + error.what());
    }
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", path, error.what()));
  }
}

}  // namespace depthgrid
