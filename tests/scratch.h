// A place for a test's files that no other test has: neither one of the same name in another tree,
// nor the same one started twice at a time.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <string>

namespace depthgrid {

// The start of a path; what is made there is the test's to remove.
inline std::string ScratchPath() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string("depthgrid_") + test->test_suite_name() + "_" + test->name();
  std::replace(name.begin(), name.end(), '/', '_');  // of tests with parameters
  return testing::TempDir() + name + "_" + std::to_string(::getpid());
}

}  // namespace depthgrid
