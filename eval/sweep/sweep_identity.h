// What makes a sweep: whether two folders hold the same one.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "eval/sweep/shard.h"
#include "eval/sweep/sweep_plan.h"

namespace depthgrid {

// The table `environment` of a sweep's database (docs/sweeps.md, "The database").
using SweepEnvironment = std::map<std::string, std::string>;

SweepEnvironment EnvironmentOf(const SweepPlan& plan, const Shard& shard);

// The entries in which the folders of one sweep agree.
const std::vector<std::string>& WhatMakesASweep();

// Throws InputError, which names the first difference, if `there` (of the folder `place`) and
// `here` differ in one of `respects`.
void RequireSameSweep(const std::string& place, const SweepEnvironment& there,
                      const SweepEnvironment& here, const std::vector<std::string>& respects,
                      const std::string& remedy);

// The value of `key`, for some a list "A, B"; "unknown" if an earlier version did not write it.
std::string ListIn(const SweepEnvironment& environment, const std::string& key);
// The entries of both lists, each once, in their order.
std::string JoinedLists(std::string entries, const std::string& more);

}  // namespace depthgrid
