// Every parser of the program as a function of bytes: any input must either be read or be refused
// with an InputError. Fuzzed with libFuzzer (./dev fuzz) and run over the seeds by the tests.
#pragma once

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace depthgrid {

struct FuzzTarget {
  std::string name;  // of its folder in tests/fuzz/seeds
  // False if the parser throws InputError. Faults of the parser abort (by a sanitizer or another
  // exception).
  bool (*accepts)(std::string_view bytes);
};

// Shown by a test in place of the parameter's bytes.
inline void PrintTo(const FuzzTarget& target, std::ostream* out) { *out << target.name; }

const std::vector<FuzzTarget>& FuzzTargets();
// Throws std::out_of_range.
const FuzzTarget& FuzzTargetNamed(const std::string& name);

}  // namespace depthgrid
