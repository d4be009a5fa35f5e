// Every benchmark is compared with a floor (minimal work on the same data: copying the image,
// Embree's packets alone) or a plain reference (exhaustive search, Ceres) measured in the same run.
// Load slows both, so their ratio depends less on it than times do; it does depend on the machine.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <string>

#include "bench/baseline.h"

namespace depthgrid::bench {

using Loop = std::function<void(benchmark::State&)>;

// Adds a floor or reference that cases refer to by name; several may share one. The part of the
// name after " @" is not shown. `iterations` as for a case.
void AddFloor(const std::string& name, const Loop& loop, int iterations = 0);

struct Case {
  std::string stage;  // a table of its own
  std::string size;   // a row of it
  std::string floor;  // name given to AddFloor
  Loop loop;
  bool slow = false;   // only with --long
  int iterations = 0;  // per repetition; 0: as many as fit in --min-time
};
void AddCase(const Case& row);

// Gives Google Benchmark the cases whose "stage/size" contains `filter`, and their floors. Throws
// InputError where there is none.
void RegisterCases(const std::string& filter, bool with_slow);

// Seconds per iteration by Google Benchmark's name, of the fastest repetition, as load only adds
// time.
using Times = std::map<std::string, double>;
Ratios RatiosOf(const Times& times);
// `before` updated with these ratios, without cases that no longer exist.
Ratios Renewed(const Ratios& before, const Ratios& ratios);

// The tables as Markdown, followed by the changes against the baseline, if any, of more than `band`
// (0.25: a quarter more or less time).
std::string TablesOf(const Times& times, const Ratios& baseline, double band);

}  // namespace depthgrid::bench
