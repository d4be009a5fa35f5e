// A path for a test's files that no other test uses, not even the same test in another tree or
// running at the same time.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <string>

namespace depthgrid {

// A path prefix. The test must remove the files that it makes there.
inline std::string ScratchPath() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string("depthgrid_") + test->test_suite_name() + "_" + test->name();
  std::replace(name.begin(), name.end(), '/', '_');  // names of parameterised tests contain '/'
  return testing::TempDir() + name + "_" + std::to_string(::getpid());
}

}  // namespace depthgrid
