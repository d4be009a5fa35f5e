#include "mapper/io/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/damage.h"
#include "mapper/io/frozen_images.h"
#include "mapper/io/held_frames.h"
#include "mapper/io/held_gaps.h"
#include "mapper/io/images_ahead.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/pose_track.h"
#include "mapper/io/undistort.h"

namespace depthgrid {
namespace {

// The folder is rejected if this many images at the start are unreadable.
constexpr std::size_t kProbedImages = 10;

// Converts loops from entries of the SLAM output to frames of the source.
std::vector<LoopClosure> LoopsByFrame(const std::vector<LoopClosure>& loops,
                                      const std::vector<PoseTrack::Found>& poses, int& lost_loops) {
  std::vector<LoopClosure> mapped;
  const auto frame_of = [&](int entry) {
    const auto found = std::find_if(poses.begin(), poses.end(), [&](const auto& pose) {
      return pose.entry && *pose.entry == static_cast<std::size_t>(entry);
    });
    return static_cast<int>(found - poses.begin());
  };
  // An event of a frame without an image is given with the next frame that has one.
  const auto frame_from = [&](int entry) {
    const auto found = std::find_if(poses.begin(), poses.end(), [&](const auto& pose) {
      return pose.entry && *pose.entry >= static_cast<std::size_t>(entry);
    });
    return static_cast<int>(found - poses.begin());
  };
  for (LoopClosure loop : loops) {
    loop.first_frame = frame_of(loop.first_frame);
    loop.second_frame = frame_of(loop.second_frame);
    loop.reported_at_frame = frame_from(loop.reported_at_frame);
    const int end = static_cast<int>(poses.size());
    if (std::max({loop.first_frame, loop.second_frame, loop.reported_at_frame}) < end) {
      mapped.push_back(loop);
    } else {
      ++lost_loops;
    }
  }
  return mapped;
}

class RecordingSource final : public FrameSource {
 public:
  RecordingSource(Recording recording, const SlamOutput& slam, const RecordingOptions& options,
                  DepthReader reader)
      : recording_(std::move(recording)), reader_(std::move(reader)) {
    if (recording_.images.empty()) throw InputError(recording_.name, "holds no depth image");
    RequireSeconds(recording_.images.back().stamp_s, recording_.images.back().depth_path);
    FindPoses(slam, options);
    Probe();
    MendHeldPoses();
    next_ = recording_.part.begin;
    if (recording_.camera.camera.HasDistortion()) undistorter_.emplace(recording_.camera.camera);
    images_.emplace(next_, recording_.part.EndAmong(recording_.images.size()),
                    internal::UsualImagesAhead(),
                    [this](std::size_t i) { return Read(recording_.images[i]); });
  }

  std::optional<Frame> Next() override {
    if (next_ == recording_.part.EndAmong(recording_.images.size())) return {};
    const RecordedImage& image = recording_.images[next_];
    Frame frame;
    frame.index = static_cast<int>(next_);
    frame.stamp_s = image.stamp_s;
    frame.slam_from_camera = poses_[next_].slam_from_camera;
    frame.slam_epoch = poses_[next_].epoch;
    for (const LoopClosure& loop : loops_) {
      if (loop.reported_at_frame == frame.index) frame.loops.push_back(loop);
    }
    frame.depth = NextDepth();
    if (frame.depth && frame.slam_from_camera &&
        frozen_.IsFrozen(frame.depth, *frame.slam_from_camera, frame.stamp_s, frame.slam_epoch)) {
      repeated_.Add(image.depth_path);
      frame.depth = nullptr;
    }
    ++next_;
    return frame;
  }
  std::optional<PinholeCamera> Camera() const override {
    return undistorter_ ? undistorter_->camera() : recording_.camera.camera;
  }
  int FrameCount() const override { return static_cast<int>(ImagesOfPart(recording_).size()); }
  std::vector<std::string> Warnings() const override {
    std::vector<std::string> warnings = recording_.warnings;
    unreadable_.AppendTo(warnings, recording_.name, "depth image", "missing or damaged");
    wrong_size_.AppendTo(warnings, recording_.name, "depth image",
                         "of another size than the camera");
    repeated_.AppendTo(warnings, recording_.name, "depth image",
                       "the same as before while the camera moved, and left out");
    return warnings;
  }

 private:
  void FindPoses(const SlamOutput& slam, const RecordingOptions& options) {
    const PoseTrack track(slam.live, options);
    std::size_t without = 0;
    for (std::size_t i = 0; i < recording_.images.size(); ++i) {
      poses_.push_back(track.At(recording_.images[i].stamp_s));
      if (recording_.part.Has(i) && !poses_.back().slam_from_camera) ++without;
    }
    const std::size_t frames = ImagesOfPart(recording_).size();
    if (without == frames) throw NoImageHasPose(slam, options);
    if (without > 0 && !IsToldByReader(slam)) {
      recording_.warnings.push_back(fmt::format(
          "{}: {} of {} {} no pose{}", recording_.name, without, Counted(frames, "frame"),
          without == 1 ? "has" : "have", WhyWithout(slam, options)));
    }
    int lost_loops = 0;
    loops_ = LoopsByFrame(slam.loops, poses_, lost_loops);
    std::erase_if(loops_, [&](const LoopClosure& loop) { return !recording_.part.Has(loop); });
    if (lost_loops > 0) {
      recording_.warnings.push_back(
          fmt::format("{}: loop closures left out, as they join frames that have no image: {}",
                      recording_.name, lost_loops));
    }
  }

  // Poses that are held are interpolated, or where that says nothing taken for missing. Those
  // outside the part say so too, but their images are not read.
  void MendHeldPoses() {
    std::vector<std::optional<Pose3>> poses;
    for (const auto& frame : poses_) poses.push_back(frame.slam_from_camera);
    const std::vector<bool> held =
        HeldFrames(poses, recording_.part.begin, EndOfPart(),
                   [&](std::size_t i) { return Read(recording_.images[i]).depth; });
    std::vector<TimedPose> frames;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      frames.push_back({recording_.images[i].stamp_s, poses[i], poses_[i].epoch});
    }
    const MendedPoses mended = MendHeld(frames, held);
    for (std::size_t i = 0; i < poses.size(); ++i) poses_[i].slam_from_camera = mended.poses[i];
    const HeldCount count = CountHeld(mended.gaps, recording_.part);
    if (!count.first) return;
    recording_.warnings.push_back(fmt::format(
        "{}: one pose is given again and again while the camera moves, first in frame {}: {} "
        "interpolated, {} taken for lost",
        recording_.name, *count.first, Counted(count.interpolated, "frame"), count.lost));
  }

  std::size_t EndOfPart() const { return recording_.part.EndAmong(recording_.images.size()); }

  InputError NoImageHasPose(const SlamOutput& slam, const RecordingOptions& options) const {
    const bool any = std::any_of(slam.live.begin(), slam.live.end(), [](const SlamPose& pose) {
      return pose.slam_from_camera.has_value();
    });
    if (!any) return {recording_.name, "the trajectory for it holds no pose"};
    return {recording_.name, fmt::format("no pose within {} s of any image: {}",
                                         options.max_stamp_difference_s, Ranges(slam, options))};
  }
  // Whether poses are paired with frames, which have their stamps.
  static bool HasPosesByFrame(const SlamOutput& slam) {
    return std::any_of(slam.live.begin(), slam.live.end(),
                       [](const SlamPose& pose) { return !pose.slam_from_camera; });
  }
  // Whether so many poses are missing that it should be explained.
  bool LacksMany() const {
    std::vector<bool> has_pose;
    for (std::size_t i = recording_.part.begin; i < EndOfPart(); ++i) {
      has_pose.push_back(poses_[i].slam_from_camera.has_value());
    }
    const auto with_pose = std::count(has_pose.begin(), has_pose.end(), true);
    return MostLackPoses(static_cast<std::size_t>(with_pose), has_pose.size()) ||
           LacksEachSecondPose(has_pose);
  }
  // Matrices that are not one per frame are told of where they are paired; ReadSlamFiles tells,
  // with the file's name and stamps.
  bool IsToldByReader(const SlamOutput& slam) const {
    if (slam.lack_is_told) return true;
    return recording_.poses_given && HasPosesByFrame(slam) && LacksMany();
  }
  std::string WhyWithout(const SlamOutput& slam, const RecordingOptions& options) const {
    return HasPosesByFrame(slam) || !LacksMany() ? "" : ": " + Ranges(slam, options);
  }
  std::string Ranges(const SlamOutput& slam, const RecordingOptions& options) const {
    std::vector<double> stamps_s;  // entries paired with frames in order may lack a pose
    for (const SlamPose& pose : slam.live) {
      if (pose.slam_from_camera) stamps_s.push_back(pose.stamp_s);
    }
    return StampRanges(NamesOf(recording_, options), stamps_s);
  }

  // Rejects a folder if no image can be read or their size is not the camera's; a single damaged
  // image is tolerated.
  void Probe() const {
    std::exception_ptr first_error;
    const auto images = ImagesOfPart(recording_);
    for (const RecordedImage& image : images.first(std::min(kProbedImages, images.size()))) {
      try {
        RequireCameraSize(reader_(image.depth_path), image);
        return;
      } catch (const SizeError&) {
        throw;
      } catch (const InputError&) {
        if (!first_error) first_error = std::current_exception();
      }
    }
    std::rethrow_exception(first_error);
  }

  struct SizeError : InputError {
    using InputError::InputError;
  };
  void RequireCameraSize(const DepthImage& depth, const RecordedImage& image) const {
    const PinholeCamera& camera = recording_.camera.camera;
    if (depth.width_px == camera.width_px && depth.height_px == camera.height_px) return;
    throw SizeError(image.depth_path,
                    fmt::format("is {}x{} pixels, must be {}x{} as the camera's", depth.width_px,
                                depth.height_px, camera.width_px, camera.height_px));
  }

  // Called on several threads at once.
  internal::ReadImage Read(const RecordedImage& image) const {
    internal::ReadImage read;
    try {
      auto depth = std::make_shared<DepthImage>(reader_(image.depth_path));
      RequireCameraSize(*depth, image);
      if (undistorter_) *depth = undistorter_->Apply(*depth);
      read.depth = std::move(depth);
    } catch (const SizeError& error) {
      read.wrong_size = error.what();
    } catch (const InputError& error) {
      read.unreadable = error.what();
    }
    return read;
  }
  std::shared_ptr<const DepthImage> NextDepth() {
    internal::ReadImage read = images_->Next();
    if (!read.wrong_size.empty()) wrong_size_.Add(read.wrong_size);
    if (!read.unreadable.empty()) unreadable_.Add(read.unreadable);
    return std::move(read.depth);
  }

  Recording recording_;
  DepthReader reader_;
  std::optional<Undistorter> undistorter_;
  std::vector<PoseTrack::Found> poses_;
  std::vector<LoopClosure> loops_;
  std::size_t next_ = 0;
  Tally unreadable_;
  Tally wrong_size_;
  FrozenImages frozen_;
  Tally repeated_;
  std::optional<internal::ImagesAhead> images_;  // last member, as its threads use those above
};

}  // namespace

std::unique_ptr<FrameSource> OpenRecording(Recording recording, const SlamOutput& slam,
                                           const RecordingOptions& options, DepthReader reader) {
  return std::make_unique<RecordingSource>(std::move(recording), slam, options, std::move(reader));
}

FramePart FindPart(const PartOptions& part, const Recording& recording) {
  return FindPart(part, NamesOf(recording).stamps_s, recording.name);
}

std::span<const RecordedImage> ImagesOfPart(const Recording& recording) {
  const std::span<const RecordedImage> images = recording.images;
  return images.subspan(recording.part.begin, recording.part.CountAmong(images.size()));
}

Recording WithImages(Recording recording, std::vector<RecordedImage> images) {
  recording.images = std::move(images);
  recording.part = {};
  return recording;
}

FrameNames NamesOf(const Recording& recording, const RecordingOptions& options) {
  FrameNames names;
  names.time_offset_s = options.time_offset_s;
  if (options.interpolate_poses) names.interpolated_gap_s = options.max_interpolation_gap_s;
  names.part = recording.part;
  for (const RecordedImage& image : recording.images) {
    names.stamps_s.push_back(image.stamp_s + options.time_offset_s);
    names.numbers.push_back(image.number);
  }
  return names;
}

DepthReader PngDepthReader(const DepthPngFormat& format) {
  return [format](const std::string& path) { return ReadDepthPng(path, format); };
}

void CompleteSize(const Recording& recording, CameraDescription& camera) {
  if (camera.has_size) return;
  for (const RecordedImage& image : ImagesOfPart(recording)) {
    int width_px = 0, height_px = 0;
    try {
      const DepthImage depth = ReadDepthPng(image.depth_path);
      width_px = depth.width_px;
      height_px = depth.height_px;
    } catch (const InputError&) {
      continue;  // OpenRecording reports the error if none can be read
    }
    TakeSize(width_px, height_px, image.depth_path, camera);
    return;
  }
  if (camera.sizes.empty()) return;
  throw InputError(camera.path, fmt::format("lists the depth stream at {} sizes, must list it at "
                                            "one: {} has no readable PNG image that tells which",
                                            camera.sizes.size(), recording.name));
}

DepthPngFormat DepthFormatOf(const CameraFile& camera, const RecordingOptions& options) {
  DepthPngFormat format;
  if (options.depth_scale_per_m > 0.0 && options.depth_scale_per_m < kLeastDepthScale) {
    throw SettingError(
        "sequence.recording.depth_scale",
        fmt::format("is {:g}, must be 0 (the camera file's) or from {:g}: it is in units "
                    "a metre, 1000 of millimetres",
                    options.depth_scale_per_m, kLeastDepthScale));
  }
  format.scale_per_m =
      options.depth_scale_per_m > 0.0 ? options.depth_scale_per_m : camera.depth_scale_per_m;
  format.invalid_units.clear();
  for (const double units : options.invalid_units) {
    if (units != std::floor(units)) {
      throw SettingError("sequence.recording.invalid_units",
                         fmt::format("holds {}, must be whole numbers", units));
    }
    format.invalid_units.push_back(static_cast<std::uint16_t>(units));
  }
  return format;
}

}  // namespace depthgrid
