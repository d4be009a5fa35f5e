#include "eval/doubts/view_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "eval/doubts/truth_check.h"
#include "eval/experiment/shipped.h"
#include "mapper/core/angle.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

bool HasHit(const Scan& scan) {
  return std::any_of(scan.beams.begin(), scan.beams.end(),
                     [](const Beam& beam) { return beam.hit; });
}

bool NoneToMatch(const MappingRun& run) {
  return !run.reports.empty() &&
         std::all_of(run.reports.begin(), run.reports.end(),
                     [](const FrameReport& report) { return report.beams == 0; });
}

// With a smaller share of matched frames the poses are mostly SLAM's. In shipped rooms all frames
// but the first are matched; with 75 % matched, errors were as large as SLAM's.
constexpr double kFewestMatched = 0.9;

struct MatchedFrames {
  int matched = 0;
  int frames = 0;      // with an image, a pose and an earlier map to match against
  double beams = 0.0;  // mean number with a hit, in frames that were not matched

  bool AreFew() const { return matched < kFewestMatched * frames; }
};

MatchedFrames CountMatched(const MappingRun& run) {
  MatchedFrames count;
  bool any_mapped = false;
  for (const FrameReport& report : run.reports) {
    // A frame without an image has no stand; the recording's reader reports what is missing.
    if (!report.slam_from_camera || (run.camera && !report.stand)) continue;
    if (any_mapped || report.match.found) {
      count.matched += report.match.found ? 1 : 0;
      ++count.frames;
      if (!report.match.found) count.beams += report.beams;
    }
    any_mapped = any_mapped || report.inserted;
  }
  const int unmatched = count.frames - count.matched;
  if (unmatched > 0) count.beams /= unmatched;
  return count;
}

// The range of depths in the sample frames.
std::string DepthSeen(const MappingRun& run) {
  float least_m = std::numeric_limits<float>::infinity();
  float most_m = 0.0F;
  for (const SampleFrame& sample : run.samples) {
    for (const float z_m : sample.depth->z_m) {
      if (!(z_m > 0.0F) || !std::isfinite(z_m)) continue;
      least_m = std::min(least_m, z_m);
      most_m = std::max(most_m, z_m);
    }
  }
  return most_m > 0.0F ? fmt::format("show depth from {:.3g} to {:.3g} m", least_m, most_m)
                       : "hold no measurement";
}

std::string ImagesOf(const MappingRun& run) {
  const PinholeCamera& camera = *run.camera;
  // Between the outer edges of the first and the last column, wherever the principal point is.
  const double width_rad = std::atan((camera.width_px - 0.5 - camera.cx_px) / camera.fx_px) -
                           std::atan((-0.5 - camera.cx_px) / camera.fx_px);
  return fmt::format("the images, {}x{} pixels and {:.3g} degrees wide, {}", camera.width_px,
                     camera.height_px, DegFromRad(width_rad), DepthSeen(run));
}

// A reason is named if it is that of this share of the frames that show too little. Chosen.
constexpr double kNamedShare = 0.25;

std::string ReasonOf(ShownView view, const ScanOptions& scan) {
  switch (view) {
    case ShownView::kNoDepth:
      return "there is next to no depth";
    case ShownView::kNoDepthAhead:
      return "there is hardly any depth at the camera's height, as what is there is out of the "
             "sensor's range or returns nothing";
    case ShownView::kBeyondRange:
      return fmt::format(
          "the camera sees at its height mostly what is beyond {:g} m (mapper.scan.max_range_m)",
          scan.max_range_m);
    case ShownView::kBelowRange:
      return fmt::format(
          "the camera sees at its height mostly what is nearer than {:g} m "
          "(mapper.scan.min_range_m)",
          scan.min_range_m);
    case ShownView::kFloor:
      return fmt::format(
          "the camera looks at the floor, with hardly anything above {:g} m "
          "(mapper.scan.band_low_m)",
          scan.band_low_m);
    case ShownView::kCeiling:
      return fmt::format(
          "the camera looks at the ceiling, with hardly anything below {:g} m "
          "(mapper.scan.band_high_m)",
          scan.band_high_m);
    case ShownView::kFloorAndCeiling:
      return fmt::format(
          "the camera looks at floor and ceiling, with hardly anything from {:g} to {:g} m "
          "(mapper.scan.band_low_m, band_high_m)",
          scan.band_low_m, scan.band_high_m);
    case ShownView::kOther:
      break;
  }
  Broken("other views have no reason");
}

// Empty where there is none that so many frames have.
std::string ReasonsOf(const UnmatchedViews& views, const ScanOptions& scan) {
  std::vector<std::string> reasons;
  for (std::size_t i = 0; i < kShownViews; ++i) {
    const auto view = static_cast<ShownView>(i);
    const int frames = views.Count(view);
    if (view == ShownView::kOther || frames == 0 || frames < kNamedShare * views.frames()) continue;
    reasons.push_back(fmt::format("in {} of the others, the first is frame {}, {}", frames,
                                  views.First(view), ReasonOf(view, scan)));
  }
  return fmt::format("{}", fmt::join(reasons, "; "));
}

// Why few frames were matched: too little was visible, or hits were not matched.
std::string WhyFewMatched(const MatchedFrames& count, const UnmatchedViews& views,
                          const MapperOptions& options) {
  if (count.beams < kFewBeams * options.scan.beams) {
    if (std::string reasons = ReasonsOf(views, options.scan); !reasons.empty()) return reasons;
    return fmt::format(
        "in the others, on average {:.0f} of {} beams see what is matched (in mapper.scan: mode, "
        "slice_half_height_m, min_range_m, max_range_m)",
        count.beams, options.scan.beams);
  }
  const bool is_surfel = options.method == MapperMethod::kSurfel;
  return fmt::format(
      "in the others, on average {:.0f} of {} beams see what is matched, but it does not fit what "
      "was mapped: limits of {} are too narrow, or the poses err by more than these",
      count.beams, options.scan.beams, is_surfel ? "mapper.surfel.match" : "mapper.match");
}

}  // namespace

// Only the drawn band counts; the slice for matching may have hits where it has none.
bool SawNothing(const MappingRun& run) {
  bool any_kept = false;
  for (const MappedFrame& frame : run.result.mapped) {
    if (frame.of_prior_map() || !frame.kept()) continue;
    any_kept = true;
    if (HasHit(*frame.obstacles)) return false;
  }
  return any_kept || NoneToMatch(run);
}

std::optional<std::string> DoubtOfScans(const MappingRun& run) {
  const MatchedFrames count = CountMatched(run);
  if (count.matched == 0 || !count.AreFew()) return {};
  return fmt::format(
      "{} of {} scans could be matched, the poses of the others are those given: the others have "
      "{:.0f} beams with a hit on average",
      count.matched, count.frames, count.beams);
}

std::optional<std::string> DoubtOfView(const MappingRun& run, const MapperOptions& options) {
  if (!run.camera) return {};
  const ScanOptions& scan = options.scan;
  if (SawNothing(run)) {
    return fmt::format(
        "no frame sees anything from {:g} to {:g} m above the floor (mapper.scan.band_low_m, "
        "band_high_m) and {:g} to {:g} m away (mapper.scan.min_range_m, max_range_m); {}",
        scan.band_low_m, scan.band_high_m, scan.min_range_m, scan.max_range_m, ImagesOf(run));
  }
  if (!HasFree(StatesOf(run.result.map))) {
    return fmt::format(
        "the map has no free cell: no beam clears anything, as no image shows the way to what it "
        "sees at {:g} m above the floor (mapper.scan.band_low_m). Is the camera level, or does it "
        "look at the ceiling, or stand close to a wall? {}",
        scan.band_low_m, ImagesOf(run));
  }
  if (options.fusion.TrustsSlamAlone()) return {};
  if (!NoneToMatch(run)) {
    const MatchedFrames count = CountMatched(run);
    if (!count.AreFew()) return {};
    return fmt::format(
        "{} of {} frames could be matched, the poses of the others are those given: {}; {}",
        count.matched, count.frames, WhyFewMatched(count, run.unmatched, options), ImagesOf(run));
  }
  return fmt::format(
      "nothing could be matched, the poses are those given: no frame sees anything within {:g} m "
      "of the camera's height (mapper.scan.slice_half_height_m) in {} rows or more "
      "(mapper.scan.min_returns); {}",
      scan.slice_half_height_m, scan.min_returns, ImagesOf(run));
}

std::optional<std::string> DoubtOfView(const MappingRun& run, const ExperimentOptions& options) {
  auto doubt = DoubtOfView(run, options.mapper);
  // Poses of a shipped path are correct.
  if (doubt && IsFileName(options.trajectory)) {
    *doubt += "; the path's poses must be those of the camera's axes, x right, y down, z forward";
  }
  return doubt;
}

}  // namespace depthgrid
