#include "mapper/io/matrix_poses.h"

#include <gtest/gtest.h>

#include "tests/refusal.h"

namespace depthgrid {
namespace {

constexpr const char* kQuarterTurn = "0 -1 0 1\n1 0 0 2\n0 0 1 3\n";

std::string MatrixPosesRefusal(const std::string& text) {
  RowDamage damage;
  return RefusalOf([&] { ParseMatrixPoses(text, "p", damage); });
}

void ExpectQuarterTurn(const std::optional<Pose3>& pose) {
  ASSERT_TRUE(pose);
  EXPECT_TRUE(pose->translation.isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_TRUE((*pose * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3)));
}

TEST(MatrixPoses, OneMatrixAFile) {
  ExpectQuarterTurn(ParseMatrixPose(std::string(kQuarterTurn) + "0 0 0 1\n", "p"));
  ExpectQuarterTurn(ParseMatrixPose(kQuarterTurn, "p"));
  EXPECT_FALSE(ParseMatrixPose("-inf -inf -inf -inf\nnan 0 0 0\n0 0 0 0\n0 0 0 1\n", "p"));
  EXPECT_FALSE(ParseMatrixPose("0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 1\n", "p"));
}

TEST(MatrixPoses, ManyInAnyLayout) {
  const std::string line = "0 -1 0 1 1 0 0 2 0 0 1 3";
  for (const std::string& text :
       {line + "\n" + line + "\n", line + " 0 0 0 1\n" + line + " 0 0 0 1\n",
        std::string(kQuarterTurn) + "\n" + kQuarterTurn,
        std::string(kQuarterTurn) + "0 0 0 1\n" + kQuarterTurn + "0 0 0 1\n"}) {
    RowDamage damage;
    const auto poses = ParseMatrixPoses(text, "p", damage);
    ASSERT_EQ(poses.size(), 2U) << text;
    ExpectQuarterTurn(poses[0]);
    ExpectQuarterTurn(poses[1]);
  }
  // Four poses of three lines: twelve lines, whose fourth starts a matrix.
  RowDamage damage;
  const std::string four = std::string(kQuarterTurn) + kQuarterTurn + kQuarterTurn + kQuarterTurn;
  EXPECT_EQ(ParseMatrixPoses(four, "p", damage).size(), 4U);
}

TEST(MatrixPoses, DamagedOnesKeepTheirPlace) {
  const std::string line = "0 -1 0 1 1 0 0 2 0 0 1 3\n";
  RowDamage damage;
  const auto rows = ParseMatrixPoses(line + "0 -1 0\n" + line + line + "0 -1 0 1 1 0", "p", damage);
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_FALSE(rows[1]);
  EXPECT_TRUE(rows[2]);
  EXPECT_FALSE(rows[4]);
  EXPECT_EQ(damage.damaged(), 2);
  // Blocks of four lines, cut in the third one.
  const std::string block = std::string(kQuarterTurn) + "0 0 0 1\n";
  RowDamage cut;
  const auto blocks = ParseMatrixPoses(block + block + "0 -1 0 1\n1 0", "p", cut);
  ASSERT_EQ(blocks.size(), 3U);
  ExpectQuarterTurn(blocks[1]);
  EXPECT_FALSE(blocks[2]);
  EXPECT_EQ(cut.damaged(), 1);
}

TEST(MatrixPoses, OfWhichNoneIsLeftSayWhy) {
  const auto refusal = [](const std::string& text) {
    RowDamage damage;
    const auto poses = ParseMatrixPoses(text, "p", damage);
    return RefusalOf([&] { RequireSomePose(poses, damage, "p"); });
  };
  const std::string good = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  const std::string none = "nan 0 0 0 0 1 0 0 0 0 1 0\n";
  EXPECT_EQ(refusal(none + good), "no error");
  EXPECT_EQ(refusal(none + none),
            "p: holds no pose that can be used, all 2 are left out; first: "
            "p:1: the matrix must be finite");
  EXPECT_EQ(refusal(""), "p: holds no pose");
}

TEST(MatrixPoses, OneClearLineForEachFault) {
  EXPECT_EQ(MatrixPosesRefusal("1 2 3\n"),
            "p:1: has 3 columns, must be a row of a matrix (4) or a whole matrix (12 or 16)");
  EXPECT_EQ(MatrixPosesRefusal("1 0 0 0\n0 1 0 0\n"), "p:2: the last matrix is incomplete");
  EXPECT_EQ(MatrixPosesRefusal("2 0 0 0\n0 2 0 0\n0 0 2 0\n"),
            "p:3: the matrix's upper left 3x3 must be a rotation");
  EXPECT_EQ(MatrixPosesRefusal("1 0 0 0\n0 1 0 0\n0 0 -1 0\n"),
            "p:3: the matrix's upper left 3x3 must be a rotation");
  EXPECT_EQ(MatrixPosesRefusal("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n"),
            "p:4: the matrix's last row must be 0 0 0 1");
  EXPECT_EQ(MatrixPosesRefusal("1 0 0 0 0 1 0 0 0 0 1 x\n"), "p:1: 'x' is not a number");
}

}  // namespace
}  // namespace depthgrid
