// A second loss after one whose search was given up.
#include <gtest/gtest.h>

#include "mapper/graph/relocation.h"
#include "tests/mapper/mapped_frame.h"

namespace depthgrid {
namespace {

// Of which every scan lies on what was seen before to the same share.
class KnownShare final : public ReferenceMap {
 public:
  explicit KnownShare(double share) : share_(share) {}
  MatchResult Match(const std::shared_ptr<const Scan>&, const Prediction&) override { return {}; }
  std::span<const MapPart> MatchedParts() const override { return {}; }
  void Insert(const std::shared_ptr<const Scan>&, const Pose2&, const Eigen::Matrix3d&) override {}
  void InsertTied(const std::shared_ptr<const Scan>&, const Pose2&, int) override {}
  double ShareSeenBefore(const std::shared_ptr<const Scan>&, const Pose2&, int) override {
    return share_;
  }
  Adjustment Adjust(const std::vector<MappedFrame>&, const std::vector<PlanarLoop>&, AdjustEffort,
                    std::span<const int>) override {
    return {};
  }
  void Rebuild(const std::vector<MappedFrame>&) override {}

 private:
  double share_;
};

TEST(Relocation, IsSettledOnceTheGuessOfALaterLossIsRight) {
  RelocationOptions options;
  options.most_searches = 1;
  Relocation relocation(options, {}, {});
  for (int i = 0; i < 50; ++i) relocation.Explained(0.9);
  std::vector<MappedFrame> frames(50);
  const auto add = [&](int count, double step_m, double share) {
    KnownShare reference(share);
    for (int i = 0; i < count; ++i) {
      const double x_m = frames.back().map_from_base.x_m + step_m;
      frames.emplace_back().map_from_base = {x_m, 0.0, 0.0};
      EXPECT_FALSE(relocation.Find(frames, nullptr, reference));
    }
  };
  relocation.Lost(5.0, {});
  ASSERT_TRUE(relocation.BeginIfDoubtful(0.1, 50));
  add(4, 0.2, 0.0);  // half a metre on it is searched for, once
  EXPECT_FALSE(relocation.active());
  EXPECT_TRUE(relocation.unsettled());
  relocation.Lost(5.0, {});
  ASSERT_TRUE(relocation.BeginIfDoubtful(0.1, 54));
  add(20, 0.01, 1.0);  // no way for a search, and all that is seen was seen before
  EXPECT_FALSE(relocation.unsettled());
}

}  // namespace
}  // namespace depthgrid
