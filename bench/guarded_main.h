// The main function of a measuring program: bad input gives one line and exit code 2, a failure
// while running one line and exit code 1, as with depthgrid itself.
#pragma once

#include <cstdio>
#include <exception>

#include "mapper/core/error.h"

namespace depthgrid {

template <typename Program>
int GuardedMain(Program program, int argc, char** argv) {
  try {
    return program(argc, argv);
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}

}  // namespace depthgrid
