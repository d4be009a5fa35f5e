// A mapper begins in a finished map (docs/math.md, "A finished map to go on in").
#include <string>
#include <utility>

#include "mapper/core/error.h"
#include "mapper/frame_check.h"
#include "mapper/mapper_state.h"

namespace depthgrid {

void IncrementalMapper::StartFrom(PriorMap prior) {
  if (!state_->history.records().empty() || state_->prior_start) {
    throw InputError("prior map", "must be given before the first frame, once");
  }
  RequireSound(prior);
  const int scans = state_->options.submap.scans;
  if (state_->options.method == MapperMethod::kPaper &&
      prior.frames.size() > static_cast<std::size_t>(scans)) {
    throw InputError("prior map", "has " + std::to_string(prior.frames.size()) +
                                      " frames, mapper.submap.scans is " + std::to_string(scans) +
                                      ", must be at least as many with mapper.method paper");
  }
  // SLAM's motion is replaced by that of the final poses, without SLAM's errors.
  for (std::size_t i = 1; i < prior.frames.size(); ++i) {
    prior.frames[i].slam_motion =
        Between(prior.frames[i - 1].map_from_base, prior.frames[i].map_from_base);
  }
  state_->has_prior = true;
  state_->prior_frames = static_cast<int>(prior.frames.size());
  state_->mapped.StartFrom(std::move(prior.frames));
  state_->InsertPrior();
  state_->fixed_map = prior.fixed;
  state_->prior_start = prior.map_from_slam;
  state_->beginning.End();  // in a finished map, SLAM's errors are corrected from the start
}

void IncrementalMapper::State::InsertPrior() {
  if (!reference) return;
  for (const MappedFrame& frame : mapped.all()) {
    reference->Insert(std::make_shared<const Scan>(*frame.scan), frame.map_from_base,
                      Eigen::Matrix3d::Zero());
  }
  // Only the match determines the pose of the first new frame relative to the last prior one.
  reference->BeginPart(PartPlace::kKnown);
}

IncrementalMapper IncrementalMapper::StartedAt(const Pose2& map_from_slam) const {
  const State& begun = *state_;
  if (!begun.prior_start || !begun.history.records().empty()) {
    throw InputError("prior map", "must have been given, and no frame, to start in it elsewhere");
  }
  RequireSoundStart(map_from_slam, 0.0);
  IncrementalMapper mapper(begun.options, begun.camera, begun.clocks, begun.oracle);
  State& state = *mapper.state_;
  state.match_oracle = begun.match_oracle;
  state.has_prior = true;
  state.prior_frames = begun.prior_frames;
  state.mapped.StartFrom(begun.mapped.all());
  if (begun.reference) state.reference = begun.reference->Clone();
  state.fixed_map = begun.fixed_map;
  state.prior_start = map_from_slam;
  state.beginning.End();
  return mapper;
}

}  // namespace depthgrid
