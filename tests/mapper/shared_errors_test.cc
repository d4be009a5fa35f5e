#include "mapper/surfel/shared_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

Surfel Facing(double degrees) {
  Surfel surfel;
  surfel.normal = {std::cos(RadFromDeg(degrees)), std::sin(RadFromDeg(degrees))};
  return surfel;
}

TEST(SharedErrors, CompanionsAreOfOneStretchAndFaceTheSameWay) {
  std::vector<Surfel> surfels(18, Facing(0.0));
  surfels[3] = Facing(10.0);
  surfels[5] = Facing(90.0);
  surfels[7] = Facing(180.0);  // the wall's other side
  surfels[9] = Facing(85.0);
  const std::vector<int> companies = CompaniesOf(surfels);
  EXPECT_EQ(companies[0], 13);
  EXPECT_EQ(companies[3], 13);
  EXPECT_EQ(companies[5], 2);
  EXPECT_EQ(companies[7], 1);
  EXPECT_EQ(companies[9], 2);
  EXPECT_EQ(companies[16], 2);  // the second stretch has two
  EXPECT_EQ(companies[17], 2);
}

// Each stretch errs by something of its own beside what each surfel errs by alone.
double CorrelationFound(double shared_share, bool two_walls) {
  RandomStream random(1, RandomStage::kTest);
  SharedErrors errors;
  for (int group = 0; group < 400; ++group) {
    std::vector<Surfel> surfels;
    std::vector<double> residuals;
    const double shared = std::sqrt(shared_share) * random.Normal();
    const double shared_by_second = std::sqrt(shared_share) * random.Normal();
    for (int i = 0; i < 16; ++i) {
      const bool second = two_walls && i % 2 == 1;
      surfels.push_back(Facing(second ? 90.0 : 0.0));
      const double alone = std::sqrt(1.0 - shared_share) * random.Normal();
      residuals.push_back(alone + (second ? shared_by_second : shared));
    }
    residuals[4] = 0.0;   // not seen by another group
    residuals[6] *= 1e6;  // a wrong association
    errors.Add(surfels, residuals);
  }
  return errors.Correlation();
}

TEST(SharedErrors, CorrelationIsTheShareThatIsShared) {
  EXPECT_NEAR(CorrelationFound(0.0, false), 0.0, 0.02);
  EXPECT_NEAR(CorrelationFound(0.5, false), 0.5, 0.05);
  EXPECT_NEAR(CorrelationFound(0.5, true), 0.5, 0.05);
  EXPECT_NEAR(CorrelationFound(1.0, false), 1.0, 1e-9);
}

TEST(SharedErrors, NothingIsToldOfFewPairsOrWhatErrsTheOtherWay) {
  SharedErrors few;
  const std::vector<Surfel> two(2, Facing(0.0));
  for (int i = 0; i < 99; ++i) few.Add(two, std::vector<double>{1.0, 1.0});
  EXPECT_EQ(few.Correlation(), 0.0);
  few.Add(two, std::vector<double>{1.0, 1.0});
  EXPECT_NEAR(few.Correlation(), 1.0, 1e-9);
  SharedErrors against;
  for (int i = 0; i < 200; ++i) against.Add(two, std::vector<double>{1.0, -2.0});
  EXPECT_EQ(against.Correlation(), 0.0);
}

}  // namespace
}  // namespace depthgrid
