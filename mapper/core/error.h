// The two kinds of failure that are not results (docs/conventions.md, "Errors"): bad input, which
// is the user's to mend, and a broken precondition, which is a bug. An ordinary algorithmic failure
// is a field of a result instead.
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

// A setting that does not fit what it is used on: the key is the place, until who knows where it
// was set names that (NamingPlaces).
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

// Throws std::logic_error: where a precondition of the calling code did not hold. Behind a switch
// over all values of an enum it says that there are no others (the compiler asks for all).
[[noreturn]] inline void Broken(const char* rule) {
  throw std::logic_error(std::string("broken precondition: ") + rule);
}

// Throws it when the precondition does not hold.
inline void Require(bool condition, const char* rule) {
  if (!condition) Broken(rule);
}

}  // namespace depthgrid
