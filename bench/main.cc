// `./dev bench`: all benchmarks interleaved, the best of their repetitions, as tables of ratios
// beside a committed baseline. It never fails for being slow: load decides too much.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <set>

#include "bench/bench_table.h"

namespace depthgrid::bench {
namespace {

struct Arguments {
  std::string baseline = "bench/baseline.json";
  bool write_baseline = false;
  bool is_long = false;
  std::string filter;
  double band = 0.25;
  int repetitions = 8;
  double min_time_s = 0.02;
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

void Run(const Arguments& arguments) {
  const Ratios baseline = ReadRatios(arguments.baseline);
  std::vector<std::string> texts;
  texts.emplace_back("bench");
  texts.push_back(fmt::format("--benchmark_repetitions={}", arguments.repetitions));
  texts.push_back(fmt::format("--benchmark_min_time={}", arguments.min_time_s));
  texts.emplace_back("--benchmark_enable_random_interleaving=true");
  std::vector<char*> argv;
  for (std::string& text : texts) argv.push_back(text.data());
  int argc = static_cast<int>(argv.size());
  benchmark::Initialize(&argc, argv.data());
  RegisterCases(arguments.filter, arguments.is_long);
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  std::fputs(TablesOf(collector.times(), baseline, arguments.band).c_str(), stdout);
  if (arguments.write_baseline) WriteRatios(arguments.baseline, RatiosOf(collector.times()));
}

}  // namespace
}  // namespace depthgrid::bench

int main(int argc, char** argv) {
  depthgrid::bench::Arguments arguments;
  CLI::App app("Time of every stage, as a multiple of a floor or plain reference");
  app.add_option("--filter", arguments.filter, "only cases whose stage/size contains this");
  app.add_flag("--long", arguments.is_long, "large cases too");
  app.add_option("--repetitions", arguments.repetitions, "of which the best counts");
  app.add_option("--min-time", arguments.min_time_s, "seconds of each repetition");
  app.add_option("--baseline", arguments.baseline, "ratios to compare with");
  app.add_option("--band", arguments.band, "a change by this share is worth a line");
  app.add_flag("--write-baseline", arguments.write_baseline, "keep this run's ratios");
  CLI11_PARSE(app, argc, argv);
  try {
    depthgrid::bench::Run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
