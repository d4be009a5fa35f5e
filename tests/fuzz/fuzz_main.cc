// One executable for all targets: `fuzz_parsers TARGET [libFuzzer's arguments]`.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "tests/fuzz/targets.h"

namespace {

const depthgrid::FuzzTarget* chosen = nullptr;

}  // namespace

// The target's name comes first and is taken away, as libFuzzer takes bare words for corpora.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  if (*argc < 2) {
    std::fprintf(stderr, "usage: fuzz_parsers TARGET [libFuzzer's arguments]; targets:");
    for (const auto& target : depthgrid::FuzzTargets()) {
      std::fprintf(stderr, " %s", target.name.c_str());
    }
    std::fprintf(stderr, "\n");
    std::exit(2);
  }
  try {
    chosen = &depthgrid::FuzzTargetNamed((*argv)[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::exit(2);
  }
  for (int i = 1; i + 1 < *argc; ++i) (*argv)[i] = (*argv)[i + 1];
  --*argc;
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->accepts({reinterpret_cast<const char*>(data), size});
  return 0;
}
