// frames.csv: what it says of each frame.
#include <gmock/gmock.h>

#include <sstream>
#include <string>
#include <vector>

#include "eval/output/run_tables.h"

namespace depthgrid {
namespace {

std::vector<std::string> CellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::string cell;
  std::istringstream in(line + ",");
  while (std::getline(in, cell, ',')) cells.push_back(cell);
  return cells;
}

TEST(FramesCsv, TellsWhichPosesAreGuessesAndWhereTheCameraWasCarried) {
  MappingRun run;
  for (int i = 0; i < 3; ++i) {
    FrameReport report;
    report.index = i;
    report.guessed = i > 0;
    report.carried = i == 1;
    run.reports.push_back(report);
  }
  std::istringstream csv(FramesCsv(run, nullptr));
  std::string line;
  std::getline(csv, line);
  const std::vector<std::string> names = CellsOf(line);
  std::vector<std::string> guessed, carried;
  while (std::getline(csv, line)) {
    const std::vector<std::string> cells = CellsOf(line);
    ASSERT_EQ(cells.size(), names.size());
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (names[k] == "guessed") guessed.push_back(cells[k]);
      if (names[k] == "carried") carried.push_back(cells[k]);
    }
  }
  EXPECT_THAT(guessed, testing::ElementsAre("0", "1", "1"));
  EXPECT_THAT(carried, testing::ElementsAre("0", "1", "0"));
}

}  // namespace
}  // namespace depthgrid
