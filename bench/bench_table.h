// Every benchmark stands beside a floor (the least anything could do: copy the image, Embree's
// packets alone) or a plain reference (exhaustive search, Ceres) measured in the same run: times
// depend on the machine and its load, their ratio much less.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <string>

namespace depthgrid::bench {

using Loop = std::function<void(benchmark::State&)>;

// What cases are compared with; several may share one. Known once, by name; what follows " @" in it
// is not shown.
void AddFloor(const std::string& name, const Loop& loop);

struct Case {
  std::string stage;  // a table of its own
  std::string size;   // a row of it
  std::string floor;  // name given to AddFloor
  Loop loop;
  bool slow = false;  // only with --long
};
void AddCase(const Case& row);

// Gives Google Benchmark the cases whose "stage/size" contains `filter`, and their floors.
void RegisterCases(const std::string& filter, bool with_slow);

// Seconds an iteration took, by Google Benchmark's name: the best repetition, as load only adds.
using Times = std::map<std::string, double>;
// Ratios by stage and size.
using Ratios = std::map<std::string, std::map<std::string, double>>;

Ratios RatiosOf(const Times& times);
// Empty when there is no such file.
Ratios ReadRatios(const std::string& path);
// Ratios in the file that are not given stay, but those of cases that are no more.
void WriteRatios(const std::string& path, const Ratios& ratios);

// The tables as Markdown, and below them what changed by more than `band` (0.25: by a quarter).
std::string TablesOf(const Times& times, const Ratios& baseline, double band);

}  // namespace depthgrid::bench
