#include "bench/baseline.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "mapper/core/error.h"
#include "mapper/io/file.h"

namespace depthgrid::bench {

Machine ThisMachine() {
  Machine machine{"unknown", static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN))};
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (!line.starts_with("model name") || colon == std::string::npos) continue;
    machine.cpu = line.substr(colon + 2);
    break;
  }
  return machine;
}

std::string TextOf(const Machine& machine) {
  return fmt::format("{}, {} cores", machine.cpu, machine.cores);
}

Baseline ReadBaseline(const std::string& path) {
  const std::string text = ReadTextFile(path);
  Baseline baseline;
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    baseline.machine = {json.at("cpu").get<std::string>(), json.at("cores").get<int>()};
    baseline.ratios = json.at("ratios").get<Ratios>();
  } catch (const nlohmann::json::exception& error) {
    throw InputError(path, fmt::format("is no baseline ({})", error.what()));
  }
  for (const auto& [stage, sizes] : baseline.ratios) {
    for (const auto& [size, ratio] : sizes) {
      if (ratio > 0.0 && std::isfinite(ratio)) continue;
      throw InputError(path, fmt::format("{}, {}: is {}, must be above 0", stage, size, ratio));
    }
  }
  return baseline;
}

void WriteBaseline(const std::string& path, const Baseline& baseline) {
  const nlohmann::json json = {{"cpu", baseline.machine.cpu},
                               {"cores", baseline.machine.cores},
                               {"ratios", baseline.ratios}};
  WriteFile(path, json.dump(2) + "\n");
}

}  // namespace depthgrid::bench
