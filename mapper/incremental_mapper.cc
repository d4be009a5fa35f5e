#include "mapper/incremental_mapper.h"

#include <utility>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/grid/map_drawing.h"

namespace depthgrid {
namespace {

// Adds the time from construction to destruction to one field of StageTimes.
class StageTimer {
 public:
  StageTimer(const CpuClock& clock, double& sum_us)
      : clock_(clock), sum_us_(sum_us), start_us_(clock ? clock() : 0.0) {}
  ~StageTimer() {
    if (clock_) sum_us_ += clock_() - start_us_;
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  const CpuClock& clock_;
  double& sum_us_;
  double start_us_;
};

int HitCount(const Scan& scan) {
  int hits = 0;
  for (const Beam& beam : scan.beams) hits += beam.hit ? 1 : 0;
  return hits;
}

}  // namespace

struct IncrementalMapper::State {
  MapperOptions options;
  CpuClock clock;
  std::vector<std::optional<Pose3>> slam_from_camera;  // of every input frame
  std::vector<MappedFrame> mapped;
  std::vector<int> input_of_mapped;  // position of a mapped frame among the input frames

  OccupancyMap Draw(const std::vector<MappedFrame>& frames) const {
    MapDrawing drawing(options.grid);
    for (const MappedFrame& frame : frames) drawing.Add(*frame.scan, frame.map_from_base);
    return drawing.Map();
  }
};

IncrementalMapper::IncrementalMapper(const MapperOptions& options,
                                     const std::optional<PinholeCamera>&, CpuClock clock)
    : state_(std::make_unique<State>()) {
  state_->options = options;
  state_->clock = std::move(clock);
  if (!options.fusion.TrustsSlamAlone()) {
    throw InputError("mapper.fusion.gain", "only 0 is available: there is no matching yet");
  }
}
IncrementalMapper::~IncrementalMapper() = default;
IncrementalMapper::IncrementalMapper(IncrementalMapper&&) noexcept = default;

FrameReport IncrementalMapper::AddFrame(const Frame& frame) {
  FrameReport report;
  const StageTimer total(state_->clock, report.times.total_us);
  report.index = frame.index;
  report.stamp_s = frame.stamp_s;
  report.slam_from_camera = frame.slam_from_camera;
  report.slam_epoch = frame.slam_epoch;
  report.map_from_camera = frame.slam_from_camera;
  state_->slam_from_camera.push_back(frame.slam_from_camera);
  if (!frame.slam_from_camera || !frame.scan) return report;
  report.beams = HitCount(*frame.scan);
  MappedFrame mapped;
  mapped.frame = frame.index;
  mapped.scan = frame.scan;
  mapped.map_from_base = BaseOf(*frame.slam_from_camera);
  state_->mapped.push_back(mapped);
  state_->input_of_mapped.push_back(static_cast<int>(state_->slam_from_camera.size()) - 1);
  report.inserted = true;
  return report;
}

MapperResult IncrementalMapper::Finish(const std::vector<std::optional<Pose3>>& slam_final) {
  Require(slam_final.empty() || slam_final.size() == state_->slam_from_camera.size(),
          "SLAM's final trajectory has one entry a frame");
  MapperResult result;
  result.map_from_camera = state_->slam_from_camera;
  result.mapped = state_->mapped;
  for (std::size_t i = 0; i < slam_final.size(); ++i) {
    if (slam_final[i]) result.map_from_camera[i] = slam_final[i];
  }
  for (std::size_t i = 0; i < result.mapped.size(); ++i) {
    const auto input = static_cast<std::size_t>(state_->input_of_mapped[i]);
    result.mapped[i].map_from_base = BaseOf(*result.map_from_camera[input]);
  }
  result.map = state_->Draw(result.mapped);
  return result;
}

OccupancyMap IncrementalMapper::CurrentMap() const { return state_->Draw(state_->mapped); }

}  // namespace depthgrid
