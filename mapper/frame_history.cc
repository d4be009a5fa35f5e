#include "mapper/frame_history.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/core/usual_step.h"

namespace depthgrid {
namespace {

// A motion so many times as large as usual is far larger; chosen, not measured.
constexpr double kFar = 3.0;
// Longest gap that counts as one frame: 10 Hz, and what stamps are rounded by.
constexpr double kNextS = 0.105;
// Gap at which the extrapolation's uncertainty reaches kEpochSigma; it grows with the square of the
// time.
constexpr double kSurpriseS = 0.3;
// Longest extrapolation in steps: a shorter step took no time but for a stamp's rounding.
constexpr double kMostExtrapolatedSteps = 100.0;

// SLAM's motion; both records must have poses.
Pose2 MotionOf(const FrameRecord& from, const FrameRecord& to) {
  return Between(BaseOf(*from.slam_from_camera), BaseOf(*to.slam_from_camera));
}

// A second at 30 Hz, over which SLAM's motion is accurate to millimetres.
constexpr int kLoopReachFrames = 30;

// Ten seconds: a more distant correction is no better than the online one.
constexpr int kFinalReachFrames = 300;

}  // namespace

void FrameHistory::Start(const Frame& frame, bool is_told) {
  const auto place = PlaceOf(frame.index);
  if (place != position_of_index_.end() && place->first == frame.index) {
    throw InputError("frame " + std::to_string(frame.index), "was given before");
  }
  position_of_index_.insert(PlaceOf(frame.index), {frame.index, records_.size()});
  FrameRecord record;
  record.index = frame.index;
  record.stamp_s = frame.stamp_s;
  record.slam_from_camera = frame.slam_from_camera;
  record.epoch = is_told ? epochs_.Of(frame) : epochs_.newest();
  records_.push_back(record);
}

FrameHistory::Positions::const_iterator FrameHistory::PlaceOf(int frame_index) const {
  if (position_of_index_.empty() || position_of_index_.back().first < frame_index) {
    return position_of_index_.end();
  }
  return std::lower_bound(position_of_index_.begin(), position_of_index_.end(),
                          std::pair(frame_index, std::size_t{0}));
}

const FrameRecord* FrameHistory::Find(int frame_index) const {
  const auto found = PlaceOf(frame_index);
  if (found == position_of_index_.end() || found->first != frame_index) return nullptr;
  return &records_[found->second];
}

void FrameHistory::Unmap(int first_frame_index, const Pose2& motion) {
  const auto first = static_cast<std::size_t>(Find(first_frame_index) - records_.data());
  for (std::size_t i = first; i < records_.size(); ++i) {
    records_[i].map_from_slam = motion * records_[i].map_from_slam;
    records_[i].mapped = -1;
  }
}

const FrameRecord* FrameHistory::PosedBefore(const FrameRecord& record) const {
  for (std::size_t i = PlaceOf(record.index)->second; i-- > 0;) {
    if (records_[i].slam_from_camera) return &records_[i];
  }
  return nullptr;
}

bool FrameHistory::WasLost() const {
  const FrameRecord* last = PosedBefore(newest());
  return last != nullptr && (last + 1 != &newest() || last->epoch != newest().epoch);
}

bool FrameHistory::RestartedAfterLoss() const {
  const FrameRecord* last = PosedBefore(newest());
  return last != nullptr && last + 1 != &newest() && last->epoch != newest().epoch;
}

bool FrameHistory::OutranUsualMotion() const {
  const FrameRecord* last = PosedBefore(newest());
  if (last == nullptr || !newest().slam_from_camera) return false;
  const auto frames = static_cast<double>(&newest() - last);
  return UsualMotionSoFar().FramesFor(MotionOf(*last, newest())) > kFar * frames;
}

double FrameHistory::LongestUsualWayM(const FrameRecord& since) const {
  return kFar * static_cast<double>(&newest() - &since) * UsualMotionSoFar().WayPerFrameM();
}

double FrameHistory::UsualStepBeforeNewest() const {
  constexpr std::size_t kRecentSteps = 15;
  std::array<double, kRecentSteps> steps_s;
  std::size_t count = 0;
  for (std::size_t i = records_.size() - 1; i-- > 1 && count < kRecentSteps;) {
    const double step_s = records_[i].stamp_s - records_[i - 1].stamp_s;
    if (step_s > 0.0) steps_s[count++] = step_s;
  }
  return UsualStepS(std::span(steps_s).first(count));
}

// Usual steps from the frame before to the newest.
int FrameHistory::StepsToNewest() const {
  const FrameRecord& before = records_[records_.size() - 2];
  return StepsIn(newest().stamp_s - before.stamp_s, UsualStepBeforeNewest());
}

bool FrameHistory::HadPause() const {
  // Chosen: a camera that drops a few images has not paused.
  constexpr double kPauseS = 0.5;
  constexpr int kPauseSteps = 5;
  if (records_.size() < 2 || !newest().slam_from_camera || WasLost()) return false;
  const FrameRecord& before = records_[records_.size() - 2];
  return before.slam_from_camera && newest().stamp_s - before.stamp_s >= kPauseS &&
         StepsToNewest() >= kPauseSteps;
}

int FrameHistory::FramesToNewest() const {
  if (records_.size() < 2 || !newest().slam_from_camera || WasLost()) return 1;
  const FrameRecord& before = records_[records_.size() - 2];
  const int steps = StepsToNewest();
  if (steps <= kFewSteps) return steps;  // UsualMotionSoFar() is costly and only needed below
  return MovingStepsIn(steps, MotionOf(before, newest()), UsualMotionSoFar());
}

// Over the last thousand frames before the newest; computed on demand, as pauses are rare.
UsualMotion FrameHistory::UsualMotionSoFar() const {
  constexpr std::size_t kMostFrames = 1000;
  UsualMotion usual;
  const std::size_t end = records_.size() - 1;
  for (std::size_t i = std::max<std::size_t>(end, kMostFrames) - kMostFrames + 1; i < end; ++i) {
    const FrameRecord& a = records_[i - 1];
    const FrameRecord& b = records_[i];
    if (a.slam_from_camera && b.slam_from_camera && a.epoch == b.epoch) usual.Add(MotionOf(a, b));
  }
  return usual;
}

const FrameRecord* FrameHistory::NearestMapped(const FrameRecord& record, int reach) const {
  const int position = static_cast<int>(PlaceOf(record.index)->second);
  const int count = static_cast<int>(records_.size());
  for (int step = 0; step <= reach; ++step) {
    for (const int candidate : {position - step, position + step}) {
      if (candidate < 0 || candidate >= count) continue;
      const FrameRecord& other = records_[static_cast<std::size_t>(candidate)];
      if (other.mapped >= 0 && other.epoch == record.epoch) return &other;
    }
  }
  return nullptr;
}

namespace {

// A mapped frame that stands in for a frame of the loop, and their relative pose.
struct Anchor {
  int mapped = 0;
  Pose2 anchor_from_frame;
};

std::optional<Anchor> AnchorOf(const FrameRecord& record, const FrameHistory& history,
                               int newest_mapped) {
  if (newest_mapped >= 0 && record.index == history.newest().index) {
    return Anchor{newest_mapped, {}};
  }
  if (const FrameRecord* mapped = history.NearestMapped(record, kLoopReachFrames)) {
    if (mapped->index == record.index) return Anchor{mapped->mapped, {}};
    return Anchor{mapped->mapped, MotionOf(*mapped, record)};
  }
  const FrameRecord& newest = history.newest();
  const bool is_near = newest.epoch == record.epoch && &newest - &record <= kLoopReachFrames;
  if (newest_mapped < 0 || !newest.slam_from_camera || !is_near) return std::nullopt;
  return Anchor{newest_mapped, MotionOf(newest, record)};
}

// Whether the next frame, if mapped, can stand in for this one, and none does now.
bool WaitsForAnchor(const FrameRecord& record, const FrameHistory& history) {
  const FrameRecord& newest = history.newest();
  return newest.epoch == record.epoch && &newest - &record < kLoopReachFrames &&
         history.NearestMapped(record, kLoopReachFrames) == nullptr;
}

}  // namespace

Extrapolation Extrapolated(const FrameHistory& history, const Pose2& map_from_slam, double near_s) {
  const auto is_near = [&](const FrameRecord& record) {
    return history.newest().stamp_s - record.stamp_s <= near_s;
  };
  const FrameRecord* last = history.PosedBefore(history.newest());
  if (last == nullptr) return {BaseOf(*history.newest().slam_from_camera), true};
  const double gap_s = history.newest().stamp_s - last->stamp_s;
  Extrapolation went_on{map_from_slam * BaseOf(*last->slam_from_camera), is_near(*last),
                        gap_s <= kNextS, std::min(1.0, std::pow(gap_s / kSurpriseS, 2))};
  const FrameRecord* later = last;
  const FrameRecord* before = history.PosedBefore(*later);
  // An epoch of one frame has no motion: use the last motion before it.
  while (before != nullptr && before->epoch != later->epoch && is_near(*before)) {
    later = before;
    before = history.PosedBefore(*later);
  }
  if (!went_on.near || before == nullptr || before->epoch != later->epoch) return went_on;
  const double step_s = later->stamp_s - before->stamp_s;
  // Stamps that repeat or go back tell no speed.
  if (gap_s < 0.0 || step_s <= 0.0 || gap_s > kMostExtrapolatedSteps * step_s) return went_on;
  const Pose2 motion = MotionOf(*before, *later);
  went_on.map_from_base =
      went_on.map_from_base * Pose2::FromVector(gap_s / step_s * motion.vector());
  if (went_on.next && gap_s > 0.0) went_on.gap_share = went_on.sigma_share;
  return went_on;
}

double ShareOfGap(double gap_s) { return std::clamp(gap_s / kSurpriseS, 1.0, kGuessedShare); }

std::optional<PlanarLoop> ProjectLoop(const LoopClosure& loop, const FrameHistory& history,
                                      int newest_mapped) {
  const FrameRecord* first = history.Find(loop.first_frame);
  const FrameRecord* second = history.Find(loop.second_frame);
  if (first == nullptr || second == nullptr) return std::nullopt;
  if (!first->slam_from_camera || !second->slam_from_camera) return std::nullopt;
  const std::optional<Anchor> first_anchor = AnchorOf(*first, history, newest_mapped);
  const std::optional<Anchor> second_anchor = AnchorOf(*second, history, newest_mapped);
  if (!first_anchor || !second_anchor || first_anchor->mapped == second_anchor->mapped) {
    return std::nullopt;
  }
  PlanarLoop planar;
  planar.first = first_anchor->mapped;
  planar.second = second_anchor->mapped;
  planar.first_from_second =
      first_anchor->anchor_from_frame *
      ProjectRelative(*first->slam_from_camera, *second->slam_from_camera, loop.first_from_second) *
      Inverse(second_anchor->anchor_from_frame);
  planar.sigma_translation_m = loop.sigma_translation_m;
  planar.sigma_yaw_rad = loop.sigma_rotation_rad;
  return planar;
}

bool MayBeProjectedLater(const LoopClosure& loop, const FrameHistory& history) {
  bool waits = false;
  for (const int end : {loop.first_frame, loop.second_frame}) {
    const FrameRecord* record = history.Find(end);
    if (record == nullptr || !record->slam_from_camera) return false;
    if (WaitsForAnchor(*record, history)) {
      waits = true;
    } else if (history.NearestMapped(*record, kLoopReachFrames) == nullptr) {
      return false;
    }
  }
  return waits;
}

Pose3 CameraPose(const FrameRecord& record, const Pose2& map_from_slam, const StandBlend& stands) {
  const Pose3 corrected = ApplyPlanar(map_from_slam, *record.slam_from_camera);
  return record.stand ? stands.Placed(corrected, *record.stand) : corrected;
}

std::vector<std::optional<Pose3>> FinalPoses(const FrameHistory& history,
                                             const std::vector<Pose2>& map_from_base_of_mapped,
                                             const StandBlend& stands) {
  std::vector<std::optional<Pose3>> poses;
  for (const FrameRecord& record : history.records()) {
    poses.emplace_back();
    if (!record.slam_from_camera) continue;
    Pose2 map_from_slam = record.map_from_slam;
    if (const FrameRecord* mapped = history.NearestMapped(record, kFinalReachFrames)) {
      const Pose2& base = map_from_base_of_mapped[static_cast<std::size_t>(mapped->mapped)];
      const Pose2 slam_from_base = BaseOf(*mapped->slam_from_camera);
      // Unchanged bit for bit where nothing moved.
      if (!(mapped->map_from_slam * slam_from_base == base)) {
        map_from_slam = base * Inverse(slam_from_base);
      } else {
        map_from_slam = mapped->map_from_slam;
      }
    }
    poses.back() = CameraPose(record, map_from_slam, stands);
  }
  return poses;
}

}  // namespace depthgrid
