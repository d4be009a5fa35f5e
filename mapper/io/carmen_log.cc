#include "mapper/io/carmen_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "mapper/core/angle.h"
#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/core/slam_step.h"
#include "mapper/io/carmen_check.h"
#include "mapper/io/carmen_line.h"
#include "mapper/io/carmen_lines.h"
#include "mapper/io/carmen_raw.h"
#include "mapper/io/carmen_scan_impl.h"
#include "mapper/io/carmen_twins.h"
#include "mapper/io/laser_faults.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/scan_clock.h"
#include "mapper/io/slam_jumps.h"

namespace depthgrid {
namespace {

// Whether odometry was reset or the line is damaged.
bool IsJump(const Pose2& odom_from_last, const Pose2& odom_from_next, double time_s) {
  return IsTooFar((odom_from_next.translation() - odom_from_last.translation()).norm(), time_s);
}

// The time that passed while the clock was set back is unknown: a larger step is not taken for
// motion. Chosen, not measured.
constexpr double kUntimedStepM = 0.5;
constexpr double kUntimedStepRad = 0.5;

double SpeedMps(const CarmenScan& a, const CarmenScan& b) {
  return (b.odom_from_laser.translation() - a.odom_from_laser.translation()).norm() /
         (b.stamp_s - a.stamp_s);
}

// Converts a loop between bases to one between cameras.
LoopClosure CameraLoop(LoopClosure loop, const Pose2& base_from_laser) {
  const Pose3 base_from_camera = CameraOf(base_from_laser, 0.0);
  loop.first_from_second = Inverse(base_from_camera) * loop.first_from_second * base_from_camera;
  return loop;
}

class CarmenLogSource : public FrameSource {
 public:
  CarmenLogSource(std::string path, const CarmenLogOptions& options,
                  const std::vector<LoopClosure>& loops, const PartOptions& part)
      : lines_(std::move(path)),
        path_(lines_.Path()),
        options_(options),
        part_(part),
        faults_(options) {
    for (const LoopClosure& loop : loops) {
      loops_.push_back(CameraLoop(loop, options_.mount.base_from_laser()));
    }
    RequireInRange(options_, "sequence.laser");
    RequireFieldOfView(options_.fov_deg);
    Survey();
    RequireScans();
    Rewind();
  }

  std::optional<Frame> Next() override {
    std::optional<CarmenScan> line = NextScan();
    while (line && place_ == Place::kBeforePart) line = NextScan();
    if (!line || place_ == Place::kBehindPart) return std::nullopt;
    Frame frame;
    frame.index = static_cast<int>(scans_) - 1;
    frame.stamp_s = line->stamp_s;
    line->odom_from_laser = *odom_from_last_;
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    if (faults_.HasPose(scans_ - 1)) {
      const Pose2 odom_from_laser = LaserPoseOf(*line, options_);
      frame.slam_from_camera = CameraOf(odom_from_laser, 0.0);
      velocity = velocity_.To(frame.stamp_s, odom_from_laser, epoch_);
    } else {
      velocity_.Lose();
    }
    if (faults_.HasScan(scans_ - 1 - names_.part.begin)) {
      faults_.DropBody(*line);
      frame.scan = std::make_shared<const Scan>(
          AtStamp(ScanOfLine(*line, options_), options_.sweep,
                  options_.upside_down ? SweepOrder::kReversed : SweepOrder::kAsListed, velocity));
    }
    frame.slam_epoch = epoch_;
    for (const LoopClosure& loop : loops_) {
      if (loop.reported_at_frame == frame.index) frame.loops.push_back(loop);
    }
    return frame;
  }
  std::optional<PinholeCamera> Camera() const override { return std::nullopt; }
  int FrameCount() const override { return static_cast<int>(names_.CountInPart()); }
  std::vector<std::string> Warnings() const override { return warnings_; }
  const FrameNames& Names() const { return names_; }

 private:
  struct Problem {
    int count = 0;
    int first_line = 0;
    std::string first_fault;  // ": field, value and rule", where that is known
  };

  // Possible faults of the part's scans.
  struct Doubts {
    CarmenCheck check;
    std::vector<double> speeds_mps;
  };

  // Reads the whole log from its beginning and collects its scans' names.
  Doubts ReadThrough() {
    Rewind();
    Doubts doubts{CarmenCheck(options_), {}};
    std::optional<CarmenScan> last;
    while (auto scan = NextScan()) {
      names_.stamps_s.push_back(scan->stamp_s);
      names_.numbers.push_back(lines_of_scans_ - 1);
      faults_.AddPose(*scan, epoch_);
      if (place_ != Place::kInPart) continue;
      const double no_return_m = ReachOf(*scan, options_).no_return_m;
      doubts.check.Add(*scan, no_return_m, lines_.Number());
      faults_.Add(*scan);
      if (last) doubts.speeds_mps.push_back(SpeedMps(*last, *scan));
      last = std::move(scan);
    }
    return doubts;
  }

  std::string TextOfRaw() const {
    const std::string poses =
        path_ +
        ": scans are RAWLASER1 lines, their poses the robot's of the ODOM lines around them";
    const Pose2& place = raw_.robot_from_laser();
    if (place == Pose2{}) return poses + "; sequence.laser.mount is where the laser is on it";
    return fmt::format(
        "{} with the laser at ({:g}, {:g}) m, {:g} degrees to the left, as PARAM "
        "robot_frontlaser_offset and the like say (sequence.laser.mount replaces it)",
        poses, place.x_m, place.y_m, DegFromRad(place.yaw_rad));
  }

  Doubts ReadAgain() {
    names_ = {};
    faults_ = LaserFaults(options_);
    problems_.clear();
    earlier_ = 0;
    return ReadThrough();
  }

  // Warns of possible faults of the log. If stamps decrease it is read once more, as only later
  // stamps show which are wrong; so too if all scans are written twice.
  void Survey() {
    Doubts doubts = ReadThrough();
    if (lines_of_scans_ == 0 && raw_.Begin()) doubts = ReadAgain();
    if (raw_.IsUsed() && !names_.stamps_s.empty()) {
      warnings_.push_back(TextOfRaw());
    }
    if (const std::optional<int> first = twins_.FirstFlaser()) {
      warnings_.push_back(
          fmt::format("{}:{}: scans are written twice, as FLASER and as ROBOTLASER1: the latter, "
                      "which state their angles, are used",
                      path_, *first));
      leaves_out_flaser_ = true;
      clock_ = {};
      doubts = ReadAgain();
    }
    if (clock_.Mend()) doubts = ReadAgain();
    faults_.Find();
    names_.part = FindPart(part_, names_.stamps_s, path_);
    std::erase_if(loops_, [&](const LoopClosure& loop) { return !names_.part.Has(loop); });
    WarnOfProblems();
    WarnOfClock();
    WarnOfOrder();
    for (std::string& fault : faults_.Warnings(path_, names_.part)) {
      warnings_.push_back(std::move(fault));
    }
    for (std::string& doubt : doubts.check.Warnings(path_)) warnings_.push_back(std::move(doubt));
    if (const auto speed_mps = ImpossibleSpeedMps(std::move(doubts.speeds_mps))) {
      warnings_.push_back(fmt::format(
          "{}: the laser moves at {:.0f} m/s: is the odometry in metres, and are the stamps in "
          "seconds?",
          path_, *speed_mps));
    }
  }

  void WarnOfProblems() {
    for (const auto& [reason, seen] : problems_) {
      warnings_.push_back(
          fmt::format("{}:{}: {}{}{}", path_, seen.first_line, reason, seen.first_fault,
                      seen.count == 1 ? "" : fmt::format(" ({} such lines)", seen.count)));
    }
  }

  // Call after Survey().
  void RequireScans() const {
    if (!names_.stamps_s.empty()) return;
    if (has_zero_bytes_)
      throw InputError(path_,
                       "holds bytes that are zero (UTF-16, or no text?), must be UTF-8 text");
    if (const auto nameless = problems_.find(kNamelessLine);
        nameless != problems_.end() && problems_.size() == 1) {
      throw InputError(
          PlaceOfLine(path_, nameless->second.first_line),
          "begins with no message name, must be a CARMEN log's; images are given by their folder "
          "and poses by --poses");
    }
    throw InputError(path_,
                     fmt::format("no usable FLASER, ROBOTLASER1 or RAWLASER1 line among {}{}",
                                 Counted(lines_.Number(), "line"),
                                 warnings_.empty() ? "" : "; first: " + warnings_[0]));
  }

  void Rewind() {
    lines_.Rewind();
    lines_of_scans_ = 0;
    raw_.Rewind();
    clock_.Rewind();
    scans_ = 0;
    last_stamp_s_ = -std::numeric_limits<double>::infinity();
    odom_from_last_.reset();
    velocity_.Lose();
    epoch_ = 0;
    front_max_m_ = 0.0;
    first_stamp_s_.reset();
    place_ = Place::kBeforePart;
  }

  // Call for each scan that is used. Faults noted before the part are discarded.
  void MoveTo(double stamp_s) {
    if (!first_stamp_s_) first_stamp_s_ = stamp_s;
    const bool in_part = part_.Has(stamp_s - *first_stamp_s_);
    if (place_ == Place::kInPart && !in_part) place_ = Place::kBehindPart;
    if (place_ != Place::kBeforePart || !in_part) return;
    place_ = Place::kInPart;
    if (part_.from_s == 0.0) return;
    problems_.clear();
    earlier_ = 0;
  }

  // Also if it was set back before the part, whose stamps then differ from the log's.
  void WarnOfClock() {
    if (names_.stamps_s.empty()) return;  // RequireScans() says so
    const double end_s = part_.to_s > 0.0 ? names_.stamps_s.front() + part_.to_s
                                          : std::numeric_limits<double>::infinity();
    for (std::string& warning : clock_.Warnings(path_, end_s)) {
      warnings_.push_back(std::move(warning));
    }
  }

  // The program does not sort the scans: after the clock was set back this would interleave two
  // drives.
  void WarnOfOrder() {
    const std::size_t used = names_.CountInPart();
    if (static_cast<std::size_t>(earlier_) <= used) return;
    warnings_.push_back(fmt::format(
        "{}: {} of {} scans are earlier than one before them, so most of the log is left out: its "
        "lines must be in order of time; is it written backwards, or was its clock set back?",
        path_, earlier_, used + static_cast<std::size_t>(earlier_)));
  }

  void Note(const std::string& reason, const std::string& fault = {}) {
    if (place_ == Place::kBehindPart) return;
    const Problem first = {0, lines_.Number(), fault.empty() ? "" : ": " + fault};
    ++problems_.try_emplace(reason, first).first->second.count;
  }

  // Whether the step from the last scan to this one is not a motion.
  bool BreaksOff(const Pose2& odom_from_laser, double stamp_s) {
    if (!odom_from_last_) return false;
    if (IsJump(*odom_from_last_, odom_from_laser, stamp_s - last_stamp_s_)) {
      Note("the pose jumps by more than 10 m: its motion there is not used");
      return true;
    }
    if (!clock_.IsSetBack()) return false;
    const Pose2 step = Between(*odom_from_last_, odom_from_laser);
    if (step.translation().norm() <= kUntimedStepM && std::abs(step.yaw_rad) <= kUntimedStepRad) {
      return false;
    }
    Note("the pose jumps where the clock was set back: its motion there is not used");
    return true;
  }

  // False for a scan that is not later than the one before and is left out.
  bool GoOnWith(const CarmenScan& scan) {
    const bool is_same = IsSameStamp(scan.stamp_s, last_stamp_s_);
    if (!is_same) ++lines_of_scans_;
    // This also drops the second of two messages for one scan.
    if (is_same || scan.stamp_s < last_stamp_s_) {
      const bool counts = place_ != Place::kBehindPart;
      earlier_ += counts && !is_same ? 1 : 0;
      const bool is_whole = is_same && scan.stamp_s == std::floor(scan.stamp_s);
      Note(
          "a scan that is not later than the one before it",
          is_whole ? fmt::format("both at {:.0f} s, are stamps whole seconds?", scan.stamp_s) : "");
      return false;
    }
    MoveTo(scan.stamp_s);
    const Pose2 odom_from_laser = faults_.PoseOr(scans_++, scan.odom_from_laser);
    if (BreaksOff(odom_from_laser, scan.stamp_s)) ++epoch_;
    last_stamp_s_ = scan.stamp_s;
    odom_from_last_ = odom_from_laser;
    return true;
  }

  std::optional<CarmenScan> NextScan() {
    while (const std::optional<LogLine> written = lines_.Next()) {
      if (written->is_too_long) Note(fmt::format("a line longer than {} bytes", kMaxLineBytes));
      if (names_.stamps_s.empty() && written->text.find('\0') != std::string_view::npos) {
        has_zero_bytes_ = true;
      }
      CarmenLine line = raw_.Take(ParseCarmenLine(written->text));
      if (const auto* damage = std::get_if<CarmenDamage>(&line)) {
        Note(damage->reason, damage->fault);
        lines_of_scans_ += damage->is_scan ? 1 : 0;
      }
      if (const auto* max = std::get_if<CarmenMaximum>(&line)) front_max_m_ = max->range_m;
      auto* scan = std::get_if<CarmenScan>(&line);
      if (scan == nullptr) continue;
      if (leaves_out_flaser_ && !scan->states_angles) continue;
      if (!leaves_out_flaser_) twins_.Add(*scan, lines_.Number());
      if (scan->max_range_m == 0.0 && options_.max_range_m == 0.0) {
        scan->max_range_m = front_max_m_;
      }
      const std::optional<double> stamp_s = clock_.Take(scan->stamp_s, lines_.Number());
      if (!stamp_s) {
        ++lines_of_scans_;
        Note("a scan whose stamp is later than all after it",
             fmt::format("stamp {:.6f}", scan->stamp_s));
        continue;
      }
      scan->stamp_s = *stamp_s;
      if (!GoOnWith(*scan)) continue;
      if (!written->has_end) Note("the last line has no line end; it is used, but may be cut");
      return std::move(*scan);
    }
    return std::nullopt;
  }

  CarmenLines lines_;
  const std::string& path_;  // that of lines_
  CarmenLogOptions options_;
  PartOptions part_;
  std::vector<LoopClosure> loops_;
  std::size_t scans_ = 0;  // those used
  std::int64_t lines_of_scans_ = 0;
  FrameNames names_;
  CarmenRaw raw_{options_.mount.base_from_laser() == Pose2{}};
  ScanClock clock_;
  CarmenTwins twins_;
  bool leaves_out_flaser_ = false;
  double last_stamp_s_ = 0.0;
  std::optional<double> first_stamp_s_;
  enum class Place { kBeforePart, kInPart, kBehindPart };
  Place place_ = Place::kBeforePart;     // of the scan read last
  std::optional<Pose2> odom_from_last_;  // interpolated if it was held
  LaserVelocity velocity_;
  LaserFaults faults_;
  int epoch_ = 0;
  double front_max_m_ = 0.0;     // as PARAM states it, 0 when none did
  int earlier_ = 0;              // scans left out, except those with a repeated stamp
  bool has_zero_bytes_ = false;  // before the first scan
  std::map<std::string, Problem> problems_;
  std::vector<std::string> warnings_;
};

}  // namespace

FrameNames CarmenFrames(const std::string& path, const CarmenLogOptions& options,
                        const PartOptions& part) {
  return CarmenLogSource(path, options, {}, part).Names();
}

std::unique_ptr<FrameSource> OpenCarmenLog(const std::string& path, const CarmenLogOptions& options,
                                           const std::vector<LoopClosure>& loops) {
  return OpenCarmenLog(path, options, loops, {}).source;
}

CarmenLog OpenCarmenLog(const std::string& path, const CarmenLogOptions& options,
                        const std::vector<LoopClosure>& loops, const PartOptions& part) {
  auto source = std::make_unique<CarmenLogSource>(path, options, loops, part);
  FrameNames names = source->Names();
  return {std::move(source), std::move(names)};
}

}  // namespace depthgrid
