// Scans of a log's readings, and of a driver's.
#include <gtest/gtest.h>

#include <cstddef>
#include <limits>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "mapper/io/carmen_log.h"

namespace depthgrid {
namespace {

// Beams a degree apart: two between hits at 4 and 5 m are 4 m x 3 degrees = 0.21 m wide, seven are
// 0.56 m. One beside the last hit is 0.14 m, four before the first are 0.35 m.
TEST(CarmenScan, NarrowGapsWithoutReturnClearNoFartherThanTheHitsBeside) {
  CarmenScan line;
  line.bearing_step_rad = RadFromDeg(1.0);
  line.range_m = {4, 90, 90, 5, 5, 90, 90, 90, 90, 90, 90, 90, 4, 90};
  const Scan scan = ScanOf(line, {});
  for (const std::size_t i : {1U, 2U}) {
    EXPECT_FALSE(scan.beams[i].hit) << i;
    EXPECT_EQ(scan.beams[i].clear_to_m, 4.0F) << i;
  }
  for (const std::size_t i : {5U, 8U, 11U}) EXPECT_EQ(scan.beams[i].clear_to_m, 5.0F) << i;
  EXPECT_EQ(scan.beams[13].clear_to_m, 4.0F);
  // Two faults side by side, of which one says nothing: 0.21 m again. Five: 0.42 m.
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double no_data : {0.0, nan}) {
    line.range_m = {4, no_data, 90, 5, 4, 90, no_data, 90, 90, no_data, 4};
    const Scan faults = ScanOf(line, {});
    EXPECT_EQ(faults.beams[1].clear_to_m, 0.0F);
    EXPECT_EQ(faults.beams[2].clear_to_m, 4.0F);
    for (const std::size_t i : {5U, 7U, 8U}) EXPECT_EQ(faults.beams[i].clear_to_m, 5.0F) << i;
  }
  line.range_m = {90, 90, 90, 90, 4, 4, 4};
  EXPECT_EQ(ScanOf(line, {}).beams[0].clear_to_m, 5.0F);
  line.range_m = {90, 90, 90};
  EXPECT_EQ(ScanOf(line, {}).beams[0].clear_to_m, 5.0F);
  CarmenLogOptions wide;
  wide.no_return_gap_m = 0.0;
  EXPECT_EQ(ScanOf(line, wide).beams[1].clear_to_m, 5.0F);
}

TEST(CarmenScan, ADriversMetadataMustBeSound) {
  CarmenScan sound;
  sound.first_bearing_rad = -0.1;
  sound.bearing_step_rad = 0.1;
  sound.max_range_m = std::numeric_limits<double>::infinity();
  sound.range_m = {1, 2, 3};
  EXPECT_EQ(ScanOf(sound, {}).beams.size(), 3U);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto spoilt = [&](double CarmenScan::*field, double value) {
    CarmenScan scan = sound;
    scan.*field = value;
    return scan;
  };
  EXPECT_THROW(ScanOf(spoilt(&CarmenScan::first_bearing_rad, nan), {}), InputError);
  EXPECT_THROW(ScanOf(spoilt(&CarmenScan::bearing_step_rad, nan), {}), InputError);
  EXPECT_THROW(ScanOf(spoilt(&CarmenScan::bearing_step_rad, 0.0), {}), InputError);
  EXPECT_THROW(ScanOf(spoilt(&CarmenScan::max_range_m, nan), {}), InputError);
  EXPECT_THROW(ScanOf(spoilt(&CarmenScan::max_range_m, -1.0), {}), InputError);
  EXPECT_THROW(ScanOf(spoilt(&CarmenScan::first_bearing_rad, -135.0), {}), InputError);
  EXPECT_THROW(ScanOf(spoilt(&CarmenScan::bearing_step_rad, 45.0), {}), InputError);
  CarmenLogOptions narrow, negative;
  narrow.fov_deg = 0.001;
  EXPECT_THROW(ScanOf(sound, narrow), InputError);
  negative.max_range_m = -1.0;
  EXPECT_THROW(ScanOf(sound, negative), InputError);
}

// But codes for no return are all about the same, and single numbers say nothing.
TEST(CarmenScan, ADriversReadingsMustBeMetres) {
  CarmenScan line;
  line.bearing_step_rad = 0.01;
  for (int i = 0; i < 40; ++i) line.range_m.push_back(i % 2 == 0 ? 0.0 : 1500.0 + 10.0 * i);
  EXPECT_THROW(ScanOf(line, {}), InputError);
  for (double& range : line.range_m) range *= 1e-3;
  EXPECT_TRUE(ScanOf(line, {}).beams[1].hit);
  line.range_m = {150.0, 2000.0};
  EXPECT_EQ(ScanOf(line, {}).beams.size(), 2U);
  line.range_m.assign(40, 65535.0);
  line.range_m[3] = 65533.0;
  EXPECT_FALSE(ScanOf(line, {}).beams[3].hit);
}

}  // namespace
}  // namespace depthgrid
