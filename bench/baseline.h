// Reference ratios for the benchmarks and the machine they were measured on.
#pragma once

#include <map>
#include <string>

namespace depthgrid::bench {

// Ratios by stage and size.
using Ratios = std::map<std::string, std::map<std::string, double>>;

struct Machine {
  std::string cpu;  // as /proc/cpuinfo names it
  int cores = 0;    // installed, not only those the program may use
  bool operator==(const Machine&) const = default;
};
Machine ThisMachine();
std::string TextOf(const Machine& machine);

struct Baseline {
  Machine machine;
  Ratios ratios;
};

// Throws InputError for a file that is missing or not a baseline.
Baseline ReadBaseline(const std::string& path);
void WriteBaseline(const std::string& path, const Baseline& baseline);

}  // namespace depthgrid::bench
