// Command-line options of several commands.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "eval/cli/commands.h"

namespace depthgrid::cli {

constexpr const char* kSetMeaning = "Override a key: key.path=value (repeat for more)";
// Of commands without --keys.
constexpr const char* kSetOfExperimentMeaning =
    "Override a key: key.path=value (repeat for more); `depthgrid run --keys` lists them";
// `meaning`: the text in --help.
void AddSet(CLI::App& app, CommonArguments& common, const char* meaning = kSetMeaning);
// For an option that names a folder to create: normalises the path, so that x/../out is out even if
// there is no x.
CLI::Option* MeantFolder(CLI::Option* option);
constexpr const char* kForceMeaning =
    "Write into a folder that is not empty: what an earlier such command wrote there is removed, "
    "all other files stay; never overwrites a file that this command reads";
// `force_meaning`: the text of --force in --help.
void AddOutput(CLI::App& app, CommonArguments& common, const char* force_meaning = kForceMeaning);
void AddThreads(CLI::App& app, CommonArguments& common);
void AddCache(CLI::App& app, CommonArguments& common);
void AddMapMode(CLI::App& app, MapMode& mode);
void AddOutputForms(CLI::App& app, OutputArguments& output);
void AddKeys(CLI::App& app, std::string (*keys)());
void AddSeed(CLI::App& app, const char* flag, std::uint64_t& seed, const char* meaning);

}  // namespace depthgrid::cli
