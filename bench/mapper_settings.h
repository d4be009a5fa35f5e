// The mapper's options in a measuring program.
#pragma once

#include <string>
#include <vector>

#include "mapper/io/config.h"
#include "mapper/mapper_options.h"

namespace depthgrid {

// The defaults with these settings, KEY=VALUE each, such as "method=paper".
inline MapperOptions MapperWith(const std::vector<std::string>& sets) {
  Config config;
  for (const std::string& set : sets) config.Set(set);
  MapperOptions options;
  config.Read(options);
  return options;
}

}  // namespace depthgrid
