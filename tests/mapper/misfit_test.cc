#include "mapper/surfel/misfit.h"

#include <gtest/gtest.h>

#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

TEST(Misfit, NothingSeenOrFittingWellChangesNothing) {
  Misfit misfit;
  EXPECT_EQ(misfit.VarianceFactor(), 1.0);
  for (int i = 0; i < 100; ++i) misfit.Add(0.1);
  EXPECT_EQ(misfit.VarianceFactor(), 1.0);
}

// Residuals three times as large as expected, a fifth of them wrong associations.
TEST(Misfit, IsTheVarianceThatResidualsHave) {
  Misfit misfit;
  RandomStream random(1, RandomStage::kTest);
  for (int i = 0; i < 40000; ++i) misfit.Add(3.0 * random.Normal());
  EXPECT_NEAR(misfit.VarianceFactor(), 9.0, 0.4);
  for (int i = 0; i < 10000; ++i) misfit.Add(1e6);
  EXPECT_LT(misfit.VarianceFactor(), 16.0);
}

TEST(Misfit, EvenCountsTakeTheLowerMiddle) {
  Misfit misfit;
  misfit.Add(-2.03);
  misfit.Add(7.03);
  EXPECT_NEAR(misfit.VarianceFactor(), 1.4826 * 1.4826 * 2.05 * 2.05, 1e-9);
}

}  // namespace
}  // namespace depthgrid
