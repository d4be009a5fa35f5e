// Every benchmark stands beside a floor (little work over the same data: copy the image, Embree's
// packets alone) or a plain reference (exhaustive search, Ceres) measured in the same run: load
// adds to both, so their ratio depends less on it than times do. It does depend on the machine.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <string>

#include "bench/baseline.h"

namespace depthgrid::bench {

using Loop = std::function<void(benchmark::State&)>;

// What cases are compared with; several may share one. Known once, by name; what follows " @" in it
// is not shown. `iterations` as of a case.
void AddFloor(const std::string& name, const Loop& loop, int iterations = 0);

struct Case {
  std::string stage;  // a table of its own
  std::string size;   // a row of it
  std::string floor;  // name given to AddFloor
  Loop loop;
  bool slow = false;   // only with --long
  int iterations = 0;  // of a repetition; 0: as many as its time (--min-time) holds
};
void AddCase(const Case& row);

// Gives Google Benchmark the cases whose "stage/size" contains `filter`, and their floors. Throws
// InputError where there is none.
void RegisterCases(const std::string& filter, bool with_slow);

// Seconds an iteration took, by Google Benchmark's name: the best repetition, as load only adds.
using Times = std::map<std::string, double>;
Ratios RatiosOf(const Times& times);
// `before` with these ratios in place of its own, without cases that are no more.
Ratios Renewed(const Ratios& before, const Ratios& ratios);

// The tables as Markdown, and below them, where there is a baseline, what changed by more than
// `band` (0.25: takes a quarter more, or less).
std::string TablesOf(const Times& times, const Ratios& baseline, double band);

}  // namespace depthgrid::bench
