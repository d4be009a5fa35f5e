// Where the map goes on when SLAM's poses begin a new epoch (docs/math.md, "Epochs").
#include "mapper/core/level.h"
#include "mapper/mapper_state.h"

namespace depthgrid {

bool IncrementalMapper::State::SameEpoch() const {
  return !filter_epoch || *filter_epoch == history.newest().epoch;
}

// SLAM's pose with the correction that stood before it.
Pose2 IncrementalMapper::State::CarriedOn() const {
  return filter.Predict(BaseOf(*history.newest().slam_from_camera), history.newest().stamp_s)
      .map_from_base;
}

// Two guesses: the camera went on as it did, or SLAM's new pose means the same place of the map as
// its old poses did (a relocalisation).
IncrementalMapper::State::EpochStart IncrementalMapper::State::BegunAt(
    const std::shared_ptr<const Scan>& scan) {
  const Extrapolation went_on = Extrapolated(history, filter.map_from_slam());
  const EpochStart going_on{went_on.map_from_base, went_on.sigma_share};
  const EpochStart carried{CarriedOn(), 1.0};
  if (!scan || mapped.empty()) return went_on.near ? going_on : carried;
  const auto share = [&](const EpochStart& guess) {
    const MatchResult match = reference->Match(scan, {guess.map_from_base, filter.covariance()});
    return match.found ? match.score : 0.0;
  };
  const double share_going_on = share(going_on), share_carried = share(carried);
  // After a longer gap the last motion says nothing, and SLAM is believed unless it is plainly
  // wrong.
  const bool goes_on =
      went_on.near ? share_going_on >= share_carried
                   : relocation.IsUsual(share_going_on) && !relocation.IsUsual(share_carried);
  return goes_on ? going_on : carried;
}

// The correction is chosen so that SLAM's newest pose lies there; `sigma_share` of kEpochSigma is
// how well it is known to.
void IncrementalMapper::State::Anchor(const EpochStart& start) {
  const FrameRecord& record = history.newest();
  filter.Commit(BaseOf(*record.slam_from_camera), record.stamp_s, start.map_from_base,
                filter.covariance() + Squared(start.sigma_share * kEpochSigma));
  errors.Break();
  filter_epoch = record.epoch;
}

}  // namespace depthgrid
