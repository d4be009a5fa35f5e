#include "mapper/core/options.h"

#include <gtest/gtest.h>

#include <limits>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

struct Inner {
  double share = 0.5;
  std::array<double, 3> gain = {0.1, 0.2, 0.3};
  void Visit(OptionsVisitor& v) {
    v.Number("share", share, {0.0, 1.0}, "");
    v.PerAxis("gain", gain, {0.0, 1.0}, "");
  }
};

struct Outer {
  int frames = 4;
  std::vector<double> heights_m = {1.0};
  Inner inner;
  double last = 0.0;
  void Visit(OptionsVisitor& v) {
    v.Number("frames", frames, {1, 1e9}, "");
    v.Numbers("heights_m", heights_m, {0.0, std::numeric_limits<double>::infinity()}, "");
    v.Group("inner", inner, "");
    v.Number("last", last, {}, "");
  }
};

std::string Fault(const Outer& options) {
  try {
    RequireInRange(options, "node");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Options, AreInTheirIntervalsOrTheFirstThatIsNotIsNamed) {
  Outer options;
  EXPECT_EQ(Fault(options), "");
  options.last = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Fault(options), "node.last: is inf, must be a finite number");
  options.inner.gain[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Fault(options), "node.inner.gain: is nan, must be from 0 to 1");
  options.inner.share = 1.5;
  EXPECT_EQ(Fault(options), "node.inner.share: is 1.5, must be from 0 to 1");
  options.heights_m.push_back(-1e-9);
  EXPECT_EQ(Fault(options), "node.heights_m: is -1e-09, must be at least 0");
  options.frames = 0;
  EXPECT_EQ(Fault(options), "node.frames: is 0, must be from 1 to 1000000000");
}

struct Range {
  double low_m = 1.0, high_m = 2.0;
  void Visit(OptionsVisitor& v) {
    v.Number("low_m", low_m, {}, "");
    v.Number("high_m", high_m, {}, "");
    v.NotMore("low_m", low_m, "high_m", high_m);
  }
};
struct WithRange {
  Range range;
  void Visit(OptionsVisitor& v) { v.Group("range", range, ""); }
};

TEST(Options, OfAPairThatContradictsItselfTheOneThatWasGivenIsNamed) {
  WithRange options;
  std::string given;
  const auto fault = [&] {
    try {
      RequireInRange(options, "", [&](const std::string& key) {
        return key == given ? "a.yaml:3" : std::string();
      });
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  options.range.low_m = 2.0;
  EXPECT_EQ(fault(), "");
  options.range.low_m = 3.5;
  EXPECT_EQ(fault(), "range.low_m: is 3.5, must be at most high_m, 2");
  for (const std::string key : {"range.low_m", "range.high_m"}) {
    given = key;
    EXPECT_EQ(fault(), "a.yaml:3: range.low_m is 3.5, must be at most high_m, 2");
  }
}

}  // namespace
}  // namespace depthgrid
