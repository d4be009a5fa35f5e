// A second loss after one whose search was given up.
#include <gtest/gtest.h>

#include <vector>

#include "mapper/graph/relocation.h"
#include "tests/mapper/mapped_frame.h"
#include "tests/mapper/match_world.h"

namespace depthgrid {
namespace {

// Of which every scan lies on what was seen before to the same share.
class KnownShare final : public ReferenceMap {
 public:
  explicit KnownShare(double share) : share_(share) {}
  std::unique_ptr<ReferenceMap> Clone() const override {
    return std::make_unique<KnownShare>(*this);
  }
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

Pose2 AheadBy(double way_m) { return {1.5 + way_m, 1.7, 0.6}; }

// Given up and lost again; then the camera goes on at a place where the map always explains all
// that it sees. Whether it is still a guess. `truly`: where the camera is, seen from the guess.
bool RemainsAGuess(const Pose2& truly) {
  RelocationOptions options;
  options.most_searches = 1;
  Relocation relocation(options, {}, {});
  for (int i = 0; i < 50; ++i) relocation.Explained(0.9);
  const PlanarWorld room = FurnishedRoom();
  std::vector<MappedFrame> frames;
  const auto add = [&](const Pose2& pose, const Pose2& off) {
    const int i = static_cast<int>(frames.size());
    frames.push_back(
        MappedFrameAt(room, {.beams = 160, .sigma_of_range = 0.005}, pose * off, pose, i));
  };
  for (int i = 0; i < 50; ++i) add(AheadBy(0.02 * i), {});
  const auto go_on = [&](int count, double step_m, double share, const Pose2& off) {
    KnownShare reference(share);
    for (int i = 0; i < count; ++i) {
      add(AheadBy(1.0 + step_m * i), off);
      relocation.Find(frames, nullptr, reference);
    }
  };
  relocation.Lost(5.0, {});
  EXPECT_TRUE(relocation.BeginIfDoubtful(0.1, 50));
  go_on(4, 0.2, 0.0, {});  // half a metre on it is searched for, once
  EXPECT_FALSE(relocation.active());
  EXPECT_TRUE(relocation.unsettled());
  relocation.Lost(5.0, {});
  EXPECT_TRUE(relocation.BeginIfDoubtful(0.1, 54));
  go_on(30, 0.01, 1.0, truly);  // no way for a search
  return relocation.unsettled();
}

TEST(Relocation, IsSettledOnceTheGuessOfALaterLossIsRight) { EXPECT_FALSE(RemainsAGuess({})); }

// Where walls of elsewhere lie on those of the map, most of a scan can look as if seen before.
TEST(Relocation, ByWhatAgreesAndNotByWhatIsExplainedAlone) {
  EXPECT_TRUE(RemainsAGuess({-0.8, 0.4, 0.3}));
}

}  // namespace
}  // namespace depthgrid
