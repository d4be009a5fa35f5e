#include "mapper/mapped_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/core/error.h"

namespace depthgrid {

void FrameMoves::Include(const Pose2& before, const Pose2& after) {
  most_m = std::max(most_m, (after.translation() - before.translation()).norm());
  most_rad = std::max(most_rad, std::abs(WrapAngle(after.yaw_rad - before.yaw_rad)));
}

void FrameMoves::Append(const FrameMoves& next) {
  most_m += next.most_m;
  most_rad += next.most_rad;
}

MappedFrames::MappedFrames(const KeepOptions& options, int recent_frames)
    : options_(options),
      recent_frames_(static_cast<std::size_t>(recent_frames)),
      keeping_(options) {}

void MappedFrames::Archive::Keep(const FrameScans& scans, MappedFrame& frame) {
  frame.scan = matched.Keep(*scans.kept());
  frame.obstacles = scans.obstacles == scans.kept() ? frame.scan : obstacles.Keep(*scans.obstacles);
}

void MappedFrames::StartFrom(std::vector<MappedFrame> prior) {
  Require(frames_.empty(), "a prior map comes before the first frame");
  frames_ = std::move(prior);
  keeping_.Rebuild(frames_);
}

MappedFrame MappedFrames::WithScans(MappedFrame frame, const FrameScans& scans) {
  recent_.Keep(scans, frame);
  return frame;
}

const MappedFrame& MappedFrames::Add(MappedFrame frame, const FrameScans& scans,
                                     const std::optional<double>& explained,
                                     std::span<const MapPart> matched, int from) {
  if (frame.slam_motion) {
    const MatchResult& match = frame.match;
    frame.stands = standing_.After(*frame.slam_motion);
    standing_.Add(*frame.slam_motion,
                  match.found ? std::optional(match.map_from_base) : std::nullopt);
    standing_frames_ += frame.stands ? 1 : 0;
  }
  if (explained) {
    const bool well = *explained >= options_.min_explained;
    frame.tied_to = keeping_.TieOf(frames_, frame.map_from_base, well, matched, from).value_or(-1);
  }
  if (frame.kept()) {
    kept_.Keep(scans, frame);
    keeping_.Add(size(), frame.map_from_base);
  } else {
    recent_.Keep(scans, frame);
  }
  frames_.push_back(std::move(frame));
  if (frames_.size() > recent_frames_) {
    MappedFrame& old = frames_[frames_.size() - 1 - recent_frames_];
    if (!old.kept()) old.scan = old.obstacles = {};
  }
  return frames_.back();
}

FrameMoves MappedFrames::MoveTo(const std::vector<Pose2>& map_from_base) {
  Require(map_from_base.size() == frames_.size(), "one corrected pose a frame");
  FrameMoves moves;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    moves.Include(frames_[i].map_from_base, map_from_base[i]);
    MoveFrame(map_from_base[i], frames_[i]);
  }
  keeping_.Rebuild(frames_);
  standing_.MapMoved();
  return moves;
}

void MappedFrames::CutAt(int position) {
  frames_.erase(frames_.begin() + position, frames_.end());
  standing_ = Standing();
  standing_frames_ = 0;
  keeping_.Rebuild(frames_);
}

void MappedFrames::ForgetMotionTo(int position) {
  MappedFrame& frame = frames_[static_cast<std::size_t>(position)];
  frame.slam_motion.reset();
  frame.gap_share = kGuessedShare;
}

std::vector<MappedFrame> KeptFrames(const std::vector<MappedFrame>& frames,
                                    const std::vector<Pose2>& map_from_base) {
  std::vector<MappedFrame> kept;
  std::optional<Pose2> skipped = Pose2{};  // SLAM's motion since the last kept frame
  double gap_share = 0.0;                  // the widest gap in it
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::optional<Pose2>& step = frames[i].slam_motion;
    if (!step) gap_share = std::max(gap_share, frames[i].gap_share);
    if (!frames[i].kept()) {
      skipped = skipped && step ? std::optional(*skipped * *step) : std::nullopt;
      continue;
    }
    MappedFrame frame = frames[i];
    frame.map_from_base = map_from_base[i];
    if (i > 0 && !frames[i - 1].kept()) {
      frame.slam_motion = skipped && step ? std::optional(*skipped * *step) : std::nullopt;
    }
    if (!frame.slam_motion) frame.gap_share = gap_share;
    skipped = Pose2{};
    gap_share = 0.0;
    kept.push_back(std::move(frame));
  }
  return kept;
}

std::optional<PlanarLoop> BetweenKept(const PlanarLoop& loop,
                                      const std::vector<MappedFrame>& frames) {
  const auto at = [&](int i) -> const MappedFrame& { return FrameAt(frames, i); };
  PlanarLoop moved = loop;
  if (const MappedFrame& first = at(loop.first); !first.kept()) {
    moved.first = first.tied_to;
    moved.first_from_second =
        Between(at(first.tied_to).map_from_base, first.map_from_base) * moved.first_from_second;
  }
  if (const MappedFrame& second = at(loop.second); !second.kept()) {
    moved.second = second.tied_to;
    moved.first_from_second =
        moved.first_from_second * Between(second.map_from_base, at(second.tied_to).map_from_base);
  }
  return moved.first == moved.second ? std::nullopt : std::optional(moved);
}

std::vector<PlanarLoop> AmongKept(std::vector<PlanarLoop> loops,
                                  const std::vector<MappedFrame>& frames) {
  std::vector<int> position(frames.size(), -1);
  int kept = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].kept()) position[i] = kept++;
  }
  for (PlanarLoop& loop : loops) {
    loop.first = position[static_cast<std::size_t>(loop.first)];
    loop.second = position[static_cast<std::size_t>(loop.second)];
    Require(loop.first >= 0 && loop.second >= 0, "a loop's ends are kept");
  }
  return loops;
}

}  // namespace depthgrid
