// The two kinds of failure that are not results (docs/conventions.md, "Errors"): bad input, which
// the user can fix, and a broken precondition, which is a bug. An ordinary algorithmic failure is a
// field of a result instead.
#pragma once

#include <stdexcept>
#include <string>

namespace depthgrid {

// Bad input of any kind. `what()` is one line, "place: message", where the place is a file, a file
// and line, or a key, and the message names the value and the rule it breaks. The program prints it
// and exits with code 2.
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& place, const std::string& message)
      : std::runtime_error(place.empty() ? message : place + ": " + message) {}
};

// A setting that does not fit the data it is used on. The place is the key; NamingPlaces() replaces
// it by the file and line that set it, where known.
class SettingError : public InputError {
 public:
  SettingError(const std::string& key, const std::string& message)
      : InputError(key, message), key_(key), message_(message) {}
  const std::string& key() const { return key_; }
  const std::string& message() const { return message_; }

 private:
  std::string key_;
  std::string message_;
};

// Throws std::logic_error for a violated precondition. Also placed after a switch over all values
// of an enum, as unreachable code.
[[noreturn]] inline void Broken(const char* rule) {
  throw std::logic_error(std::string("broken precondition: ") + rule);
}

// Throws std::logic_error unless the precondition holds.
inline void Require(bool condition, const char* rule) {
  if (!condition) Broken(rule);
}

}  // namespace depthgrid
