// The error messages for rejected input.
#pragma once

#include <string>

#include "mapper/core/error.h"

namespace depthgrid {

// The message of the InputError that `action` throws, or "no error".
template <typename Action>
std::string RefusalOf(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace depthgrid
