// What sweeps found, compared.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "eval/sweep/sweep_results.h"
#include "tests/eval/program.h"

namespace depthgrid {

class SweepTableTest : public ProgramTest {
 protected:
  // The table less its timing columns.
  std::string TableOf(const std::string& folder) const {
    SweepResults results = ReadSweep(Path(folder));
    for (const SweepColumn& column : results.times) {
      const bool says_so = column.name.find("time") != std::string::npos ||
                           column.name.find("_us") != std::string::npos;
      EXPECT_TRUE(says_so) << column.name;
    }
    EXPECT_EQ(ReadFile(Path(folder + "/results.csv")), ResultsCsv(results));
    results.times.clear();
    return ResultsCsv(results);
  }
  void ExpectSameTable(const std::string& a, const std::string& b) const {
    const std::string table = TableOf(a);
    EXPECT_GT(table.size(), 1000U);
    EXPECT_TRUE(table == TableOf(b)) << a << " and " << b;
  }
};

}  // namespace depthgrid
