#include "mapper/core/kept_scan.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

// Values that repeat, equal each other or are odd, so that every code occurs.
float SomeValue(RandomStream& random) {
  constexpr std::array<float, 6> kValues = {
      0.0F, -0.0F, 0.4F, 6.0F, std::numeric_limits<float>::infinity(), 1e-42F};
  const auto pick = random.Below(2 * kValues.size());
  return pick < kValues.size() ? kValues[pick] : static_cast<float>(random.Uniform(0.0, 6.0));
}

Scan SomeScan(RandomStream& random, int beams) {
  Scan scan;
  scan.max_range_m = random.Uniform(1.0, 10.0);
  for (int i = 0; i < beams; ++i) {
    Beam beam;
    beam.bearing_rad = 0.01F * static_cast<float>(i);
    beam.hit = random.Uniform() < 0.5;
    beam.range_m = SomeValue(random);
    beam.clear_from_m = SomeValue(random);
    beam.clear_to_m = random.Uniform() < 0.5 ? beam.range_m : SomeValue(random);
    scan.beams.push_back(beam);
  }
  return scan;
}

bool SameBytes(const Scan& a, const Scan& b) {
  // operator== takes -0 for 0.
  if (!(a == b)) return false;
  for (std::size_t i = 0; i < a.beams.size(); ++i) {
    if (std::memcmp(&a.beams[i], &b.beams[i], 4 * sizeof(float)) != 0) return false;
  }
  return true;
}

TEST(KeptScan, ComesBackBitForBit) {
  RandomStream random(5, RandomStage::kTest);
  ScanArchive archive;
  std::vector<Scan> scans;
  std::vector<KeptScan> kept;
  for (int i = 0; i < 500; ++i) {
    // Bearings change with the number of beams.
    const int beams = i % 100 < 50 ? 40 : static_cast<int>(random.Below(60));
    scans.push_back(SomeScan(random, beams));
    kept.push_back(archive.Keep(scans.back()));
  }
  archive = ScanArchive();  // what was kept does not need it
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_TRUE(SameBytes(*kept[i], scans[i])) << i;
    EXPECT_TRUE(IsWhole(kept[i].packed())) << i;
  }
}

TEST(KeptScan, ALasersBeamTakesFiveBytes) {
  Scan scan;
  scan.max_range_m = 6.0;
  for (int i = 0; i < 640; ++i) {
    const float range_m = 1.0F + 0.003F * static_cast<float>(i);
    scan.beams.push_back({0.001F * static_cast<float>(i), range_m, 0.4F, range_m, true});
  }
  const KeptScan kept = ScanArchive().Keep(scan);
  EXPECT_EQ(kept.packed().codes.size(), 640U);
  EXPECT_EQ(kept.packed().values.size(), 641U);  // and where it is clear from, once
  EXPECT_EQ(*kept, scan);
}

TEST(KeptScan, NothingKeptAndDamageAreTold) {
  EXPECT_FALSE(KeptScan());
  EXPECT_THROW(*KeptScan(), std::logic_error);
  RandomStream random(6, RandomStage::kTest);
  const KeptScan kept = ScanArchive().Keep(SomeScan(random, 20));
  PackedScan packed = kept.packed();
  packed.values = packed.values.first(packed.values.size() - 1);
  EXPECT_FALSE(IsWhole(packed));
  packed = kept.packed();
  packed.codes = packed.codes.first(19);
  EXPECT_FALSE(IsWhole(packed));
}

}  // namespace
}  // namespace depthgrid
