#include "mapper/io/slam_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/trajectory_file.h"

namespace depthgrid {
namespace {

constexpr double kMaxStampDifferenceS = 0.01;  // evo's, and less than half a frame at 30 Hz
constexpr double kMaxNormError = 1e-3;
constexpr const char* kHeader =
    "kind,frame,epoch,first,second,tx_m,ty_m,tz_m,qx,qy,qz,qw,sigma_translation_m,"
    "sigma_rotation_rad\n";
constexpr std::size_t kLoopColumns = 14;

std::string LoopRow(const LoopClosure& loop, int epoch) {
  const Eigen::Vector3d& t = loop.first_from_second.translation;
  const Eigen::Quaterniond& q = loop.first_from_second.rotation;
  return fmt::format("loop,{},{},{},{},{},{},{},{},{},{},{},{},{}\n", loop.reported_at_frame, epoch,
                     loop.first_frame, loop.second_frame, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(),
                     q.w(), loop.sigma_translation_m, loop.sigma_rotation_rad);
}

// The fields of one line, empty ones included; SplitRows has no empty fields.
std::vector<std::string_view> SplitAtCommas(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

struct Event {
  int frame = 0;
  int epoch = 0;
  std::optional<LoopClosure> loop;
};

// Fields of one row of loops.csv, each error naming the line.
class EventRow {
 public:
  EventRow(std::vector<std::string_view> fields, std::string place, std::size_t frame_count)
      : fields_(std::move(fields)), place_(std::move(place)), frame_count_(frame_count) {
    if (fields_.size() != kLoopColumns) {
      throw InputError(place_,
                       fmt::format("has {} columns, must have {}", fields_.size(), kLoopColumns));
    }
  }
  Event Parse() const {
    if (fields_[0] != "loop" && fields_[0] != "relocalisation") {
      throw InputError(place_,
                       fmt::format("kind is '{}', must be loop or relocalisation", fields_[0]));
    }
    Event event = {Frame(1), Whole(2), std::nullopt};
    if (fields_[0] == "loop") event.loop = Loop(event.frame);
    return event;
  }

 private:
  LoopClosure Loop(int reported_at_frame) const {
    LoopClosure loop;
    loop.reported_at_frame = reported_at_frame;
    loop.first_frame = Frame(3);
    loop.second_frame = Frame(4);
    loop.first_from_second = {Eigen::Quaterniond(Value(11), Value(8), Value(9), Value(10)),
                              {Value(5), Value(6), Value(7)}};
    loop.sigma_translation_m = Value(12);
    loop.sigma_rotation_rad = Value(13);
    const double norm = loop.first_from_second.rotation.norm();
    if (!(std::abs(norm - 1.0) <= kMaxNormError)) {
      throw InputError(place_, fmt::format("quaternion has norm {:.6g}, must be 1", norm));
    }
    if (std::max(loop.first_frame, loop.second_frame) > reported_at_frame) {
      throw InputError(place_, "a loop cannot be reported before the frames it joins");
    }
    if (!(loop.sigma_translation_m > 0.0) || !(loop.sigma_rotation_rad > 0.0)) {
      throw InputError(place_, "the sigmas of a loop must be above 0");
    }
    return loop;
  }
  double Value(std::size_t column) const {
    const std::optional<double> value = ParseNumber(fields_[column]);
    if (!value || !std::isfinite(*value)) {
      throw InputError(place_, fmt::format("column {} is '{}', must be a finite number", column + 1,
                                           fields_[column]));
    }
    return *value;
  }
  int Whole(std::size_t column) const {
    const double value = Value(column);
    if (value != std::floor(value) || value < 0.0 || value > 1e9) {
      throw InputError(place_, fmt::format("column {} is '{}', must be a whole number", column + 1,
                                           fields_[column]));
    }
    return static_cast<int>(value);
  }
  int Frame(std::size_t column) const {
    const int frame = Whole(column);
    if (static_cast<std::size_t>(frame) >= frame_count_) {
      throw InputError(
          place_, fmt::format("frame {} is not among the {} input frames", frame, frame_count_));
    }
    return frame;
  }

  std::vector<std::string_view> fields_;
  std::string place_;
  std::size_t frame_count_;
};

std::vector<Event> ReadEvents(const std::string& path, std::size_t frame_count) {
  std::vector<Event> events;
  const std::string text = ReadFile(path);
  std::string_view rest = text;
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find('\n');
    std::string_view row = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (row.ends_with('\r')) row.remove_suffix(1);
    const bool header = line == 1 && row.starts_with("kind");
    if (row.empty() || row.starts_with('#') || header) continue;
    events.push_back(EventRow(SplitAtCommas(row), PlaceOfLine(path, line), frame_count).Parse());
    const std::size_t last = events.size() - 1;
    if (last == 0) continue;
    if (events[last].frame < events[last - 1].frame ||
        events[last].epoch < events[last - 1].epoch) {
      throw InputError(PlaceOfLine(path, line), "frames and epochs must not go down");
    }
  }
  return events;
}

// The input frame each pose belongs to.
std::vector<std::size_t> FramesOf(const Trajectory& poses, const std::vector<double>& stamps_s,
                                  const std::string& path) {
  std::vector<std::size_t> frames;
  for (const StampedPose& pose : poses) {
    const auto after = std::lower_bound(stamps_s.begin(), stamps_s.end(), pose.stamp_s);
    auto nearest = after;
    if (after == stamps_s.end() ||
        (after != stamps_s.begin() && pose.stamp_s - *std::prev(after) <= *after - pose.stamp_s)) {
      nearest = after == stamps_s.begin() ? after : std::prev(after);
    }
    if (nearest == stamps_s.end() || std::abs(*nearest - pose.stamp_s) > kMaxStampDifferenceS) {
      throw InputError(path, fmt::format("stamp {:.6f} is that of no input frame", pose.stamp_s));
    }
    const auto frame = static_cast<std::size_t>(nearest - stamps_s.begin());
    if (!frames.empty() && frames.back() == frame) {
      throw InputError(
          path, fmt::format("stamp {:.6f} is the second pose of one input frame", pose.stamp_s));
    }
    frames.push_back(frame);
  }
  return frames;
}

std::vector<SlamPose> LivePoses(const Trajectory& poses, const std::vector<std::size_t>& frames,
                                const std::vector<Event>& events,
                                const std::vector<double>& stamps_s) {
  std::vector<SlamPose> live;
  for (const double stamp_s : stamps_s) live.push_back({stamp_s, std::nullopt, 0});
  for (std::size_t k = 0; k < poses.size(); ++k) {
    live[frames[k]].slam_from_camera = poses[k].world_from_camera;
  }
  auto event = events.begin();
  int epoch = 0;
  for (std::size_t i = 0; i < live.size(); ++i) {
    for (; event != events.end() && static_cast<std::size_t>(event->frame) == i; ++event) {
      epoch = event->epoch;
    }
    live[i].epoch = epoch;
  }
  return live;
}

}  // namespace

std::string LoopsText(const SlamOutput& output) {
  std::string text = kHeader;
  auto loop = output.loops.begin();
  int epoch = 0;
  for (std::size_t i = 0; i < output.live.size(); ++i) {
    bool explained = output.live[i].epoch == epoch;
    epoch = output.live[i].epoch;
    for (; loop != output.loops.end() && static_cast<std::size_t>(loop->reported_at_frame) == i;
         ++loop) {
      text += LoopRow(*loop, epoch);
      explained = true;
    }
    if (!explained) text += fmt::format("relocalisation,{},{},,,,,,,,,,,\n", i, epoch);
  }
  Require(loop == output.loops.end(), "loops are ordered by the frame that reports them");
  return text;
}

void WriteSlamFiles(const std::string& folder, const SlamOutput& output) {
  Trajectory live;
  for (const SlamPose& pose : output.live) {
    if (pose.slam_from_camera) live.push_back({pose.stamp_s, *pose.slam_from_camera});
  }
  WriteTrajectory(folder + "/slam.txt", live);
  WriteTrajectory(folder + "/slam_final.txt", output.final);
  WriteFile(folder + "/loops.csv", LoopsText(output));
}

SlamOutput ReadSlamFiles(const SlamFilePaths& paths, const std::vector<double>& frame_stamps_s) {
  SlamOutput output;
  std::vector<Event> events;
  if (!paths.loops.empty()) events = ReadEvents(paths.loops, frame_stamps_s.size());
  for (const Event& event : events) {
    if (event.loop) output.loops.push_back(*event.loop);
  }
  const Trajectory live = ReadTrajectory(paths.live);
  const std::vector<std::size_t> frames = FramesOf(live, frame_stamps_s, paths.live);
  output.live = LivePoses(live, frames, events, frame_stamps_s);
  output.final = paths.final.empty() ? live : ReadTrajectory(paths.final);
  if (!paths.final.empty()) FramesOf(output.final, frame_stamps_s, paths.final);
  return output;
}

}  // namespace depthgrid
