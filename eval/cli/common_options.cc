#include "eval/cli/common_options.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "eval/cli/usage.h"
#include "eval/experiment/shipped.h"

namespace depthgrid::cli {
namespace {

// Empty unless the key's value is a file name that begins with ~.
std::string RefusalOfTildeIn(const std::string& assignment) {
  const auto equals = assignment.find('=');
  return equals == std::string::npos ? "" : RefusalOfTilde(assignment.substr(equals + 1));
}

// File names on the command line are relative to the current folder; those in an experiment, whose
// keys these override, to the experiment's folder.
std::string WithFileFromHere(std::string assignment) {
  for (const std::string key : {"scene=", "trajectory="}) {
    if (!assignment.starts_with(key)) continue;
    const std::string name = assignment.substr(key.size());
    if (IsFileName(name)) return key + std::filesystem::absolute(name).string();
  }
  return assignment;
}

}  // namespace

void AddSet(CLI::App& app, CommonArguments& common, const char* meaning) {
  app.add_option("--set", common.set, meaning)
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->transform(CLI::Validator(
          [](std::string& assignment) {
            const std::string refusal = RefusalOfTildeIn(assignment);
            if (refusal.empty()) assignment = WithFileFromHere(std::move(assignment));
            return refusal;
          },
          ""));
}

CLI::Option* MeantFolder(CLI::Option* option) {
  return option->transform(CLI::Validator(
      [](std::string& path) {
        const std::string refusal = RefusalOfTilde(path);
        if (!refusal.empty()) return refusal;
        std::error_code error;  // errors are reported when the folder is created
        const auto around = std::filesystem::path(path).parent_path();
        if (around.empty() || std::filesystem::exists(around, error)) return refusal;
        const auto meant = std::filesystem::weakly_canonical(path, error);
        if (!error && path.find("..") != std::string::npos) path = meant.string();
        return refusal;
      },
      ""));
}

void AddOutput(CLI::App& app, CommonArguments& common, const char* force_meaning) {
  MeantFolder(app.add_option("-o,--output", common.output, "Folder to write"))
      ->required()
      ->type_name("DIR");
  app.add_flag("--force", common.force, force_meaning);
}

void AddThreads(CLI::App& app, CommonArguments& common) {
  app.add_option("--threads", common.threads, "Threads; 0: one per core. Never changes a result")
      ->type_name("N")
      ->check(CLI::Range(0, 1024).description(""));
}

void AddCache(CLI::App& app, CommonArguments& common) {
  app.add_option("--cache", common.cache,
                 "Keep rendered depth in this folder (default: $DEPTHGRID_CACHE)")
      ->type_name("DIR");
  app.add_flag("--no-cache", common.no_cache, "Render everything anew");
}

// CLI11's transformer alone would show the enum's numbers in messages.
void AddMapMode(CLI::App& app, MapMode& mode) {
  const std::map<std::string, MapMode> modes = {
      {"trinary", MapMode::kTrinary}, {"scale", MapMode::kScale}, {"raw", MapMode::kRaw}};
  app.add_option_function<std::string>(
         "--map-mode", [&mode, modes](const std::string& name) { mode = modes.at(name); },
         "What the map's shades mean, as in Nav2: trinary, scale or raw")
      ->check(CLI::IsMember({"trinary", "scale", "raw"}))
      ->type_name("MODE");
}

void AddOutputForms(CLI::App& app, OutputArguments& output) {
  AddMapMode(app, output.map_mode);
  app.add_option(
         "--video", output.video,
         "Write a video of the map growing (MP4, by ffmpeg); --force replaces an existing one")
      ->type_name("FILE");
}

// --keys prints the keys and exits, like --help, whatever else is given.
void AddKeys(CLI::App& app, std::string (*keys)()) {
  app.add_flag_callback(
      "--keys",
      [keys] {
        fmt::print("{}", keys());
        throw CLI::Success();
      },
      "List every key that --set takes, with default, allowed values and meaning");
}

void AddSeed(CLI::App& app, const char* flag, std::uint64_t& seed, const char* meaning) {
  app.add_option(flag, seed, meaning)->check(RefusalUnlessSeed)->capture_default_str();
}

}  // namespace depthgrid::cli
