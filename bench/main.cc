// `./dev bench`: runs all benchmarks interleaved and prints the ratios of the fastest repetitions
// next to a committed baseline. Slowness is never a failure, as it depends too much on load.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>

#include "bench/bench_table.h"
#include "bench/command_line.h"
#include "bench/guarded_main.h"

namespace depthgrid::bench {
namespace {

struct Arguments {
  std::optional<std::string> baseline;
  bool write_baseline = false;
  bool is_long = false;
  std::string filter;
  double band = 0.25;
  int repetitions = 8;
  double min_time_s = 0.02;
  std::string json;
};

class Collector : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      const std::string& name = run.run_name.function_name;
      if (run.error_occurred) {
        if (failed_.insert(name).second) {
          std::fprintf(stderr, "%s: %s\n", name.c_str(), run.error_message.c_str());
        }
        continue;
      }
      const double seconds = run.cpu_accumulated_time / static_cast<double>(run.iterations);
      const auto [time, is_new] = times_.emplace(name, seconds);
      time->second = std::min(time->second, seconds);
    }
  }
  const Times& times() const { return times_; }

 private:
  Times times_;
  std::set<std::string> failed_;
};

constexpr const char* kDefaultBaseline = "bench/baseline.json";

// Checks the path before anything is measured.
void RequireFolderOf(const std::string& option, const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (std::filesystem::is_directory(path)) throw InputError(option, "'" + path + "' is a folder");
  if (folder.empty() || std::filesystem::is_directory(folder)) return;
  throw InputError(option, "'" + path + "': there is no folder " + folder.string());
}

// The baseline to compare with, if any. It may be missing if it is the default one or is to be
// written.
std::optional<Baseline> BaselineOf(const Arguments& arguments) {
  const std::string path = arguments.baseline.value_or(kDefaultBaseline);
  if (arguments.write_baseline) RequireFolderOf("--baseline", path);
  if (std::filesystem::exists(path) || (arguments.baseline && !arguments.write_baseline)) {
    return ReadBaseline(path);
  }
  if (!arguments.write_baseline) {
    fmt::print("No {} in this folder: nothing to compare with (--baseline FILE).\n", path);
  }
  return std::nullopt;
}

// A file must not mix ratios of two machines.
bool IsOfAnother(const std::optional<Baseline>& baseline) {
  return baseline && baseline->machine != ThisMachine();
}

void SayWhoseItIs(const Arguments& arguments, const Baseline& baseline) {
  if (arguments.write_baseline && !arguments.filter.empty()) {
    throw InputError("--write-baseline",
                     fmt::format("{} is of another machine ({}; this is {}): without --filter, or "
                                 "into another file (--baseline FILE)",
                                 arguments.baseline.value_or(kDefaultBaseline),
                                 TextOf(baseline.machine), TextOf(ThisMachine())));
  }
  fmt::print(
      "The baseline is of ANOTHER MACHINE: {}; this is {}. What \"change\" says is the difference "
      "of the machines, {}\n",
      TextOf(baseline.machine), TextOf(ThisMachine()),
      arguments.write_baseline
          ? "whose ratios go, those that are not measured too."
          : "not of the program: first write one of your own (--write-baseline --baseline FILE).");
}

void Measure(const Arguments& arguments, Collector& collector) {
  std::vector<std::string> texts;
  texts.emplace_back("bench");
  texts.push_back(fmt::format("--benchmark_repetitions={}", arguments.repetitions));
  texts.push_back(fmt::format("--benchmark_min_time={}", arguments.min_time_s));
  texts.emplace_back("--benchmark_enable_random_interleaving=true");
  if (!arguments.json.empty()) texts.push_back("--benchmark_out=" + arguments.json);
  std::vector<char*> argv;
  for (std::string& text : texts) argv.push_back(text.data());
  int argc = static_cast<int>(argv.size());
  benchmark::Initialize(&argc, argv.data());
  benchmark::RunSpecifiedBenchmarks(&collector);
}

void Run(const Arguments& arguments) {
  RegisterCases(arguments.filter, arguments.is_long);
  if (!arguments.json.empty()) RequireFolderOf("--json", arguments.json);
  const std::optional<Baseline> baseline = BaselineOf(arguments);
  if (IsOfAnother(baseline)) SayWhoseItIs(arguments, *baseline);
  std::fflush(stdout);
  Collector collector;
  Measure(arguments, collector);
  const Ratios before = baseline ? baseline->ratios : Ratios();
  std::fputs(TablesOf(collector.times(), before, arguments.band).c_str(), stdout);
  if (!arguments.write_baseline) return;
  const std::string path = arguments.baseline.value_or(kDefaultBaseline);
  const Ratios kept = IsOfAnother(baseline) ? Ratios() : before;
  WriteBaseline(path, {ThisMachine(), Renewed(kept, RatiosOf(collector.times()))});
  fmt::print("\nThe baseline is in {}\n", path);
}

int Main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Time of every stage, as a multiple of a floor or plain reference");
  app.add_option("--filter", arguments.filter, "only cases whose stage/size contains this");
  app.add_flag("--long", arguments.is_long, "large cases too");
  app.add_option("--repetitions", arguments.repetitions, "of which the best counts")
      ->check(FromTo(1, 1000));
  app.add_option("--min-time", arguments.min_time_s, "seconds of each repetition")
      ->check(FromTo(0.001, 60));
  app.add_option("--baseline", arguments.baseline, "ratios to compare with")
      ->default_str(kDefaultBaseline);
  app.add_option("--band", arguments.band, "a change by this share is worth a line")
      ->check(FromTo(0, 1));
  app.add_flag("--write-baseline", arguments.write_baseline, "keep this run's ratios");
  app.add_option("--json", arguments.json, "every repetition's time into this file");
  if (ReadCommandLine(app, argc, argv)) Run(arguments);
  return 0;
}

}  // namespace
}  // namespace depthgrid::bench

int main(int argc, char** argv) {
  return depthgrid::GuardedMain(depthgrid::bench::Main, argc, argv);
}
