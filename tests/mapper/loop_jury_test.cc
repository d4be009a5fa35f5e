#include "mapper/surfel/loop_jury.h"

#include <gtest/gtest.h>

namespace depthgrid {
namespace {

// From the first of some groups to another, 1 m each, known to 1 cm.
GroupLink LoopTo(int second) {
  return {0, second, {static_cast<double>(second), 0.0, 0.0}, {0.01, 0.01, 0.01}};
}

// The groups lie where the loops have them, but for errors of so many sigmas.
std::vector<Pose2> Poses(const std::vector<double>& sigmas) {
  std::vector<Pose2> poses = {{}};
  for (const double off : sigmas) {
    poses.push_back({static_cast<double>(poses.size()) + 0.01 * off, 0.0, 0.0});
  }
  return poses;
}

TEST(LoopJury, TheWorstGoFirstAndWhatFitsWithoutThemComesBack) {
  const std::vector<GroupLink> loops = {LoopTo(1), LoopTo(2), LoopTo(3), LoopTo(4)};
  LoopJury jury(loops, 5.0);
  using Accepted = std::vector<bool>;
  EXPECT_EQ(jury.accepted(), Accepted(4, true));
  EXPECT_TRUE(jury.ReviseAccepted(Poses({40.0, 25.0, 12.0, 1.0})));
  EXPECT_EQ(jury.accepted(), (Accepted{false, false, true, true}));
  // Those that are out do not count among the worst.
  EXPECT_TRUE(jury.ReviseAccepted(Poses({60.0, 3.0, 8.0, 1.0})));
  EXPECT_EQ(jury.accepted(), (Accepted{false, false, false, true}));
  EXPECT_TRUE(jury.ReviseAccepted(Poses({60.0, 3.0, 7.0, 1.0})));
  EXPECT_EQ(jury.accepted(), (Accepted{false, true, false, true}));
  // Once only.
  EXPECT_TRUE(jury.ReviseAccepted(Poses({60.0, 6.0, 7.0, 1.0})));
  EXPECT_FALSE(jury.ReviseAccepted(Poses({60.0, 3.0, 7.0, 1.0})));
  EXPECT_EQ(jury.accepted(), (Accepted{false, false, false, true}));
}

TEST(LoopJury, OneOnTrialEndsItWhereItIsTheWorstAndStaysWhereItIsNot) {
  std::vector<GroupLink> loops = {LoopTo(1), LoopTo(2)};
  loops[1].on_trial = true;
  LoopJury jury(loops, 5.0);
  EXPECT_TRUE(jury.ReviseAccepted(Poses({10.0, 9.0})));
  EXPECT_EQ(jury.accepted(), (std::vector<bool>{false, true}));
  EXPECT_FALSE(jury.ReviseAccepted(Poses({10.0, 9.0})));
  EXPECT_EQ(jury.accepted(), (std::vector<bool>{false, false}));
}

}  // namespace
}  // namespace depthgrid
