#include "mapper/io/frame_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "mapper/core/counted.h"
#include "mapper/core/usual_step.h"
#include "mapper/io/recording_options.h"

namespace depthgrid {
namespace {

// Spans whose ratio is larger are in different units.
constexpr double kMostSpanRatio = 100.0;

double PartBeginS(const FrameNames& names) { return names.stamps_s[names.part.begin]; }
double PartEndS(const FrameNames& names) {
  return names.stamps_s[names.part.EndAmong(names.stamps_s.size()) - 1];
}

// The rate (1/s) of stamps in seconds that belong to numbers with the span `numbers`. Nothing if
// the spans are similar, so that the numbers may be seconds.
std::optional<double> RateBesideNumbers(const std::vector<double>& stamps_s, double numbers) {
  if (stamps_s.size() < 2 || 2.0 * (stamps_s.back() - stamps_s.front()) > numbers) return {};
  const double step_s = UsualStepBetween(stamps_s, std::identity());
  if (!(step_s > 0.0 && step_s <= 0.5)) return {};
  return 1.0 / step_s;
}

// The poses per second, if the images' stamps are their numbers (ICL-NUIM) and the poses' are
// seconds, with at most as many poses as numbers.
std::optional<double> PosesASecond(const FrameNames& names,
                                   const std::vector<double>& pose_stamps_s) {
  for (std::size_t i = 0; i < names.stamps_s.size(); ++i) {
    if (names.stamps_s[i] - names.time_offset_s != static_cast<double>(names.NumberOf(i)))
      return {};
  }
  const double numbers = names.stamps_s.back() - names.stamps_s.front();
  if (static_cast<double>(pose_stamps_s.size()) > numbers + 1.0) return {};
  return RateBesideNumbers(pose_stamps_s, numbers);
}

// The images per second, if the images' stamps are seconds and the poses' are image numbers from 0
// or 1.
std::optional<double> ImagesASecond(const FrameNames& names,
                                    const std::vector<double>& pose_stamps_s) {
  const auto is_number = [](double stamp_s) {
    return stamp_s >= 0.0 && stamp_s == std::round(stamp_s);
  };
  const auto images = static_cast<double>(names.NumberOf(names.stamps_s.size() - 1)) + 1.0;
  if (pose_stamps_s.back() > images ||
      !std::all_of(pose_stamps_s.begin(), pose_stamps_s.end(), is_number)) {
    return {};
  }
  return RateBesideNumbers(names.stamps_s, pose_stamps_s.back() - pose_stamps_s.front());
}

// The gap that spans nineteen in twenty steps between the poses, rounded up to 10 ms; nothing if
// that is too long to say where the camera went meanwhile, or spanned already.
std::optional<double> GapNeededS(const std::vector<double>& pose_stamps_s, double spanned_s) {
  constexpr double kMostS = 2.0;  // chosen, not measured
  constexpr double kShare = 0.95, kUnitS = 0.01;
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < pose_stamps_s.size(); ++i) {
    steps_s.push_back(pose_stamps_s[i] - pose_stamps_s[i - 1]);
  }
  if (steps_s.empty()) return {};
  const auto at = static_cast<std::ptrdiff_t>(kShare * static_cast<double>(steps_s.size() - 1));
  std::nth_element(steps_s.begin(), steps_s.begin() + at, steps_s.end());
  const double step_s = steps_s[static_cast<std::size_t>(at)];
  if (step_s <= spanned_s || step_s > kMostS) return {};
  return kUnitS * std::ceil(step_s / kUnitS);
}

std::string InterpolationRemedy(const FrameNames& names, const std::vector<double>& pose_stamps_s) {
  const double spanned_s =
      names.interpolated_gap_s.value_or(RecordingOptions{}.max_interpolation_gap_s);
  const auto needed_s = GapNeededS(pose_stamps_s, spanned_s);
  if (names.interpolated_gap_s) {
    return fmt::format(
        "poses more than {:g} s apart are not interpolated, --set "
        "sequence.recording.max_interpolation_gap_s={}",
        spanned_s,
        needed_s ? fmt::format("{:.2f} interpolates most of them", *needed_s)
                 : "S interpolates those up to S apart");
  }
  if (needed_s) {
    return fmt::format(
        "--set sequence.recording.interpolate_poses=true --set "
        "sequence.recording.max_interpolation_gap_s={:.2f} interpolates poses up to that apart, "
        "for a camera that moves smoothly between them",
        *needed_s);
  }
  return "--set sequence.recording.interpolate_poses=true interpolates poses up to "
         "max_interpolation_gap_s apart, for a camera that moves smoothly between them";
}

// How many of the part's images are in the time of the poses, if that is less than half: to
// interpolate would not help the others.
std::optional<std::size_t> FewAmongPoses(const FrameNames& names, double first_pose_s,
                                         double last_pose_s) {
  std::size_t among = 0;
  for (std::size_t i = names.part.begin; i < names.part.EndAmong(names.stamps_s.size()); ++i) {
    among += first_pose_s <= names.stamps_s[i] && names.stamps_s[i] <= last_pose_s ? 1 : 0;
  }
  return MostLackPoses(among, names.CountInPart()) ? std::optional(among) : std::nullopt;
}

std::string RemedyOf(const FrameNames& names, const std::vector<double>& pose_stamps_s) {
  if (const auto rate_hz = PosesASecond(names, pose_stamps_s)) {
    return fmt::format(
        "the images' stamps are their numbers, the poses' look like seconds, {:.3g} a second: a "
        "pose's must be its image's number",
        *rate_hz);
  }
  if (const auto rate_hz = ImagesASecond(names, pose_stamps_s)) {
    return fmt::format(
        "the poses' stamps are numbers, the images' look like seconds, {:.3g} a second: a pose's "
        "must be its image's stamp",
        *rate_hz);
  }
  const double first_pose_s = pose_stamps_s.front();
  const double last_pose_s = pose_stamps_s.back();
  const double first_s = names.stamps_s.front();
  const double last_s = names.stamps_s.back();
  if (AreOfOtherUnits(last_s - first_s, last_pose_s - first_pose_s)) return "are both in seconds?";
  const auto overlap = [&](double begin_s, double end_s) {
    return first_pose_s <= end_s && begin_s <= last_pose_s;
  };
  if (!overlap(first_s, last_s)) {
    const double offset_s = names.time_offset_s + first_pose_s - first_s;
    if (std::abs(offset_s) > kMostTimeOffsetS) return "are both in seconds?";
    return fmt::format(
        "--set sequence.recording.time_offset_s={:.3f} makes the first of both coincide", offset_s);
  }
  if (!overlap(PartBeginS(names), PartEndS(names))) return "none are of the part";
  if (const auto covered = FewAmongPoses(names, first_pose_s, last_pose_s)) {
    return fmt::format(
        "{} between the first pose and the last",
        *covered == 1 ? "only 1 image is" : fmt::format("only {} images are", *covered));
  }
  return InterpolationRemedy(names, pose_stamps_s);
}

std::string LackShown(const std::vector<std::optional<Pose3>>& paired) {
  const auto lacking = std::count(paired.begin(), paired.end(), std::nullopt);
  if (lacking == 0) return "";
  return fmt::format(", so {} no pose",
                     Counted(lacking, "frame") + (lacking == 1 ? " has" : " have"));
}

// What is assumed of poses without stamps that are not as many as the frames, and the remedy.
std::string PairedFromTheFirst(std::size_t poses, std::size_t frames, const std::string& lack) {
  const std::string assumed = poses < frames
                                  ? fmt::format("taken for the first {}", Counted(poses, "frame"))
                                  : fmt::format("the first {} are taken for them", frames);
  return fmt::format(
      "without stamps: {}{}; if they are of others, give a row with a stamp for each "
      "(t x y z qx qy qz qw), or a row for each frame (NaN where there is no pose)",
      assumed, lack);
}

}  // namespace

bool AreOfOtherUnits(double span_s, double other_span_s) {
  const auto [least_s, most_s] = std::minmax({span_s, other_span_s});
  return least_s > 0.0 && most_s > kMostSpanRatio * least_s;
}

bool LacksEachSecondPose(const std::vector<bool>& has_pose) {
  std::size_t lacking = 0, between = 0;
  for (std::size_t i = 0; i < has_pose.size(); ++i) {
    if (has_pose[i]) continue;
    ++lacking;
    const bool is_between = i > 0 && i + 1 < has_pose.size() && has_pose[i - 1] && has_pose[i + 1];
    between += is_between ? 1 : 0;
  }
  return lacking > 0 && 5 * lacking >= 2 * has_pose.size() && 2 * between > lacking;
}

std::string StampRanges(const FrameNames& names, const std::vector<double>& pose_stamps_s) {
  const std::string added =
      names.time_offset_s == 0.0 ? "" : fmt::format(" ({:g} s added)", names.time_offset_s);
  const double first_s = names.stamps_s.front();
  const double last_s = names.stamps_s.back();
  const std::string part = names.IsWhole() ? ""
                                           : fmt::format(", the part's from {:.3f} to {:.3f} s",
                                                         PartBeginS(names), PartEndS(names));
  return fmt::format("images from {:.3f} to {:.3f} s{}{}, poses from {:.3f} to {:.3f} s; {}",
                     first_s, last_s, added, part, pose_stamps_s.front(), pose_stamps_s.back(),
                     RemedyOf(names, pose_stamps_s));
}

std::string PartShown(const FrameNames& names) {
  const double first_s = names.stamps_s.front();
  return fmt::format("frames {} to {} of {}, {:.3f} to {:.3f} s of {:.3f}", names.part.begin,
                     names.part.EndAmong(names.stamps_s.size()) - 1, names.stamps_s.size(),
                     PartBeginS(names) - first_s, PartEndS(names) - first_s,
                     names.stamps_s.back() - first_s);
}

PairedPoses PairInOrder(std::vector<std::optional<Pose3>> poses, const FrameNames& frames,
                        const std::string& place, std::vector<std::string>& warnings) {
  const std::size_t count = frames.stamps_s.size();
  if (poses.size() == count || count == 0) return {std::move(poses), false};
  if (poses.size() == frames.CountInPart()) {  // SLAM ran on the part only
    poses.insert(poses.begin(), frames.part.begin, std::nullopt);
    poses.resize(count);
    return {std::move(poses), false};
  }
  const auto last = static_cast<std::size_t>(frames.NumberOf(count - 1));
  const bool by_number = poses.size() == last + 1;
  std::vector<std::optional<Pose3>> paired(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t pose = by_number ? static_cast<std::size_t>(frames.NumberOf(i)) : i;
    if (pose < poses.size()) paired[i] = poses[pose];
  }
  const std::string lack = LackShown(paired);
  warnings.push_back(fmt::format("{}: {} for {}, {}", place, Counted(poses.size(), "pose"),
                                 Counted(count, "frame"),
                                 by_number ? "paired by the frames' numbers" + lack
                                           : PairedFromTheFirst(poses.size(), count, lack)));
  // What is told of frames is of the part.
  return {std::move(paired), frames.IsWhole()};
}

}  // namespace depthgrid
