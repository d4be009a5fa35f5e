#include "mapper/map_start.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "mapper/core/angle.h"
#include "mapper/core/level.h"
#include "mapper/frame_check.h"
#include "mapper/grid/map_drawing.h"
#include "mapper/match/distance_field.h"
#include "mapper/match/map_agreement.h"
#include "mapper/scan/frame_scans.h"

namespace depthgrid {
namespace {

// Number and spacing of the first views: different enough that a narrow camera has looked around a
// little.
constexpr int kStartScans = 8;
constexpr double kNextViewM = 0.3;
constexpr double kNextViewRad = RadFromDeg(12.0);
// Longest distance of the first views, which limits SLAM's drift within them.
constexpr double kStartPathM = 3.0;
// The same for the refinement by fewer views, and the largest shift by it, due to that drift.
constexpr double kFirstPathM = 1.0;
constexpr double kMostShiftM = 0.7;

// Share of the best fit or agreement that makes another place ambiguous.
constexpr double kUncertainShare = 0.9;
// Length of the trial.
constexpr std::size_t kTrialFrames = 400;
constexpr double kTrialPathM = 6.0;
// Where the first views take more frames than the trial, as of a robot that stands at its charger,
// those nearer than this to the one before are left out: they show the same, would decide the trial
// by their number, and cost memory and time.
constexpr double kStoredEveryM = 0.05;
constexpr double kStoredEveryRad = RadFromDeg(2.0);
// Share of the best agreement at which the first place is preferred: SLAM's frame is mostly the
// map's, and among similar offices a wrong one may agree better where the robot leaves the map. A
// right place had 0.89 of the best, wrong ones at most 0.71 (docs/results.md, "Going on in a
// finished map").
constexpr double kFirstShare = 0.8;
// Share of the forward agreement that the way back must reach. Below 1 to allow for chance: with 1
// some starts before a single wall stayed up to 0.2 m off.
constexpr double kRetracedShare = 0.98;
// Candidates that end this near to each other are one place.
constexpr double kSamePlaceM = 0.3;
constexpr double kSamePlaceRad = RadFromDeg(5.0);

// Least agreement. Of 68 right starts over two laser logs, drawn rooms and a rendered one, some
// with moved furniture, none had less than 0.72; of 81 in another room or outside the map 68 had
// (docs/formats.md, "Going on in a finished map").
constexpr double kLeastAgreement = 0.7;
// Agreement below which a nearly equal fit elsewhere makes the place uncertain. This finds eight
// more wrong starts; of the 15 right ones below it, two had such a fit.
constexpr double kSureAgreement = 0.85;
// After a shorter path only one viewpoint was seen and limits are stricter.
constexpr double kShortReachM = 1.0;
constexpr double kShortUncertainShare = 0.8;

double Way(const Pose2& motion) { return motion.translation().norm(); }

// A source of frames already collected.
class CollectedFrames final : public FrameSource {
 public:
  CollectedFrames(const std::vector<Frame>& frames, const std::optional<PinholeCamera>& camera)
      : frames_(frames), camera_(camera) {}

  std::optional<Frame> Next() override {
    if (next_ == frames_.size()) return {};
    return frames_[next_++];
  }
  std::optional<PinholeCamera> Camera() const override { return camera_; }
  int FrameCount() const override { return static_cast<int>(frames_.size()); }
  std::vector<std::string> Warnings() const override { return {}; }

 private:
  const std::vector<Frame>& frames_;
  std::optional<PinholeCamera> camera_;
  std::size_t next_ = 0;
};

// The first frames with a pose and a scan in one SLAM epoch, read on demand.
class FirstFrames {
 public:
  FirstFrames(FrameSource& source, const ScanOptions& options)
      : source_(source), camera_(source.Camera()), scanner_(camera_, options) {}

  const std::vector<Frame>& all() const { return frames_; }

  // False at the end.
  bool ReadOne() {
    while (auto frame = source_.Next()) {
      if (!frame->slam_from_camera) continue;
      if (!frames_.empty() && frame->slam_epoch != frames_.front().slam_epoch) return false;
      if (frames_.size() >= kTrialFrames) LeaveOutThoseNear();
      if (leaves_out_ && AreNear(frames_.back(), *frame)) continue;
      RequireSound(*frame, camera_);
      const FrameScans scans = scanner_.ScansOf(*frame);
      if (!scans.obstacles) continue;
      frame->depth.reset();
      // Holding the scans keeps the scanner from reusing them.
      frame->scan = scans.obstacles;
      frame->matched_scan = scans.matched;
      frame->stand = scans.stand;
      frame->loops.clear();
      frames_.push_back(std::move(*frame));
      return true;
    }
    return false;
  }

 private:
  static bool AreNear(const Frame& a, const Frame& b) {
    return !AreApart(BaseOf(*a.slam_from_camera), BaseOf(*b.slam_from_camera), kStoredEveryM,
                     kStoredEveryRad);
  }
  void LeaveOutThoseNear() {
    leaves_out_ = true;
    frames_.erase(std::unique(frames_.begin(), frames_.end(), AreNear), frames_.end());
  }

  FrameSource& source_;
  std::optional<PinholeCamera> camera_;
  FrameScanner scanner_;
  std::vector<Frame> frames_;
  bool leaves_out_ = false;  // frames nearer than kStoredEveryM to the one before
};

PlacedScan PlacedScanOf(const Frame& frame) {
  return {frame.scan, BaseOf(*frame.slam_from_camera)};
}

std::vector<PlacedScan> FirstViews(FirstFrames& frames) {
  std::vector<PlacedScan> views;
  while (static_cast<int>(views.size()) < kStartScans && frames.ReadOne()) {
    const PlacedScan now = PlacedScanOf(frames.all().back());
    if (!views.empty()) {
      const Pose2& last = views.back().slam_from_base;
      if (!AreApart(last, now.slam_from_base, kNextViewM, kNextViewRad)) continue;
      if (Way(Between(views.front().slam_from_base, now.slam_from_base)) > kStartPathM) break;
    }
    views.push_back(now);
  }
  return views;
}

// The scans of the first metre, over which SLAM has hardly drifted.
std::vector<PlacedScan> FirstMetre(const std::vector<PlacedScan>& scans) {
  std::vector<PlacedScan> first;
  for (const PlacedScan& scan : scans) {
    if (Way(Between(scans.front().slam_from_base, scan.slam_from_base)) > kFirstPathM) break;
    first.push_back(scan);
  }
  return first;
}

// Refines the place with the first views alone. Few views fit at more places than many, so a result
// that is not near is ignored.
FoundPlace Nearer(const FoundPlace& found, const OccupancyMap& map,
                  const std::vector<PlacedScan>& scans) {
  const std::vector<PlacedScan> first = FirstMetre(scans);
  if (first.size() == scans.size()) return found;
  const auto again = FindPlace(map, first, found.map_from_slam);
  if (!again || again->score < found.score) return found;
  const Pose2& first_base = scans.front().slam_from_base;
  const Pose2 shift = Between(found.map_from_slam * first_base, again->map_from_slam * first_base);
  if (Way(shift) > kMostShiftM) return found;
  FoundPlace nearer = found;
  nearer.map_from_slam = again->map_from_slam;
  return nearer;
}

struct Tried {
  Pose2 map_from_slam;       // at the first frame
  Pose2 last_map_from_slam;  // after the last frame
  Pose2 map_from_base;       // of the last frame
  double agreement = 0.0;
  double against = 0.0;
};

// A mapper in the prior map, from which those of all trials are started.
IncrementalMapper TrialMapper(const PriorMap& prior, const MapperOptions& options) {
  PriorMap fixed = prior;
  fixed.fixed = true;
  fixed.map_from_slam = {};  // each trial has its own
  MapperOptions trial = options;
  trial.loops.relocation.use = false;  // the place to be judged is the given one
  IncrementalMapper mapper(trial, std::nullopt);
  mapper.StartFrom(std::move(fixed));
  return mapper;
}

Tried Try(const Pose2& map_from_slam, const IncrementalMapper& in_map, const DistanceField& walls,
          const std::vector<Frame>& frames) {
  IncrementalMapper mapper = in_map.StartedAt(map_from_slam);
  Tried tried;
  tried.map_from_slam = map_from_slam;
  MapAgreement agreement;
  for (const Frame& frame : frames) {
    const FrameReport report = mapper.AddFrame(frame);
    tried.map_from_base = BaseOf(*report.map_from_camera);
    tried.last_map_from_slam = report.map_from_slam;
    Compare(*frame.scan, tried.map_from_base, walls, agreement);
  }
  tried.agreement = agreement.share();
  tried.against = agreement.share_against();
  return tried;
}

bool LedElsewhere(const Tried& a, const Tried& b) {
  return AreApart(a.map_from_base, b.map_from_base, kSamePlaceM, kSamePlaceRad);
}

// The first views may determine their place poorly, as before one wall, while later ones do:
// localises backwards from the end to the start.
Pose2 Retraced(const Tried& best, const IncrementalMapper& in_map, const DistanceField& walls,
               const std::vector<Frame>& frames) {
  std::vector<Frame> back(frames.rbegin(), frames.rend());
  for (std::size_t i = 0; i < back.size(); ++i) {
    back[i].index = static_cast<int>(i);
    back[i].stamp_s = frames.back().stamp_s - back[i].stamp_s;
  }
  const Tried retraced = Try(best.last_map_from_slam, in_map, walls, back);
  const bool as_good = retraced.agreement >= kRetracedShare * best.agreement;
  return as_good ? retraced.last_map_from_slam : best.map_from_slam;
}

// Not the path length, to which SLAM's noise adds even if the robot stands.
double ReachOf(const std::vector<Frame>& frames) {
  double reach_m = 0.0;
  for (const Frame& frame : frames) {
    const Pose2 motion =
        Between(PlacedScanOf(frames.front()).slam_from_base, PlacedScanOf(frame).slam_from_base);
    reach_m = std::max(reach_m, Way(motion));
  }
  return reach_m;
}

// Whether the first views fit at the retraced start; among moved furniture the way back may go
// astray.
bool FitsThere(const OccupancyMap& map, const std::vector<PlacedScan>& views,
               const Pose2& map_from_slam, const Pose2& map_from_other) {
  const std::vector<PlacedScan> first = FirstMetre(views);
  return FitsAsWell(FitAt(map, first, map_from_slam), FitAt(map, first, map_from_other));
}

// Localises the first metres from each candidate place and chooses the best.
void TryAll(FirstFrames& frames, const PriorMap& prior, const OccupancyMap& map,
            const std::vector<PlacedScan>& views, const MapperOptions& options, MapStart& start) {
  double way_m = 0.0;
  while (frames.all().size() < kTrialFrames && way_m < kTrialPathM && frames.ReadOne()) {
    const std::size_t newest = frames.all().size() - 1;
    way_m += Way(Between(PlacedScanOf(frames.all()[newest - 1]).slam_from_base,
                         PlacedScanOf(frames.all()[newest]).slam_from_base));
  }
  const DistanceField walls(map, kOffWallM + map.geometry.resolution_m);
  const IncrementalMapper in_map = TrialMapper(prior, options);
  std::vector<Tried> all = {Try(start.place.map_from_slam, in_map, walls, frames.all())};
  for (const Pose2& other : start.place.others) {
    all.push_back(Try(other, in_map, walls, frames.all()));
  }
  const auto most = std::max_element(all.begin(), all.end(), [](const Tried& a, const Tried& b) {
    return a.agreement < b.agreement;
  });
  const Tried& first = all.front();
  const Tried best = first.agreement >= kFirstShare * most->agreement ? first : *most;
  StartTrial trial{static_cast<int>(all.size()),
                   static_cast<int>(frames.all().size()),
                   ReachOf(frames.all()),
                   best.agreement,
                   0.0,
                   best.against};
  for (const Tried& tried : all) {
    if (!LedElsewhere(tried, best)) continue;
    trial.agreement_next = std::max(trial.agreement_next, tried.agreement);
  }
  start.trial = trial;
  start.place.map_from_slam = best.map_from_slam;
  const Pose2 retraced = Retraced(best, in_map, walls, frames.all());
  if (FitsThere(map, views, retraced, best.map_from_slam)) start.place.map_from_slam = retraced;
}

}  // namespace

bool MapStart::uncertain() const {
  const bool fits_elsewhere = place.second_score > kUncertainShare * place.score;
  if (!trial) return fits_elsewhere;
  if (fits_badly()) return true;
  if (known) return place.score < kUncertainShare * place.second_score;
  if (fits_elsewhere && trial->agreement < kSureAgreement) return true;
  if (hardly_moved() && (place.unsure || trial->agreement < kSureAgreement)) return true;
  const double share = hardly_moved() ? kShortUncertainShare : kUncertainShare;
  return trial->places > 1 && trial->agreement_next > share * trial->agreement;
}

bool MapStart::fits_badly() const { return trial && trial->agreement < kLeastAgreement; }

bool MapStart::hardly_moved() const { return trial && trial->reach_m < kShortReachM; }

bool MapStart::contradicted() const { return trial && trial->against > kMuchAgainst; }

namespace {

// `place_of` finds the place from map and first views; the trial may move it by at most
// `most_moved_m`.
template <typename PlaceOf>
std::optional<MapStart> StartAt(const PriorMap& prior, FrameSource& source,
                                const MapperOptions& options, double most_moved_m,
                                PlaceOf place_of) {
  RequireSound(prior);
  MapDrawing drawing(options.grid);
  for (const MappedFrame& frame : prior.frames) {
    drawing.Add(frame.frame, *frame.obstacles, frame.map_from_base);
  }
  const OccupancyMap map = drawing.Map();
  FirstFrames frames(source, options.scan);
  const std::vector<PlacedScan> views = FirstViews(frames);
  std::optional<FoundPlace> place = place_of(map, views);
  if (!place) return {};
  const Pose2& first_base = views.front().slam_from_base;
  const Pose2 placed = place->map_from_slam * first_base;
  MapStart start;
  start.place = std::move(*place);
  if (!options.fusion.TrustsSlamAlone()) TryAll(frames, prior, map, views, options, start);
  start.map_from_base = start.place.map_from_slam * first_base;
  if (most_moved_m == 0.0 || Way(Between(placed, start.map_from_base)) > most_moved_m) {
    start.map_from_base = placed;
    start.place.map_from_slam = placed * Inverse(first_base);
  }
  return start;
}

}  // namespace

std::optional<MapStart> FindStart(const PriorMap& prior, FrameSource& source,
                                  const MapperOptions& options) {
  const auto place_of = [](const OccupancyMap& map,
                           const std::vector<PlacedScan>& views) -> std::optional<FoundPlace> {
    const auto found = FindPlace(map, views, Pose2{});
    if (!found) return {};
    return Nearer(*found, map, views);
  };
  return StartAt(prior, source, options, std::numeric_limits<double>::infinity(), place_of);
}

std::optional<MapStart> FindStartNear(const PriorMap& prior, const Pose2& map_from_base,
                                      FrameSource& source, const MapperOptions& options,
                                      double within_m) {
  RequireSoundStart(map_from_base, within_m);
  const auto place_of = [&](const OccupancyMap& map,
                            const std::vector<PlacedScan>& views) -> std::optional<FoundPlace> {
    if (views.empty()) return {};
    const Pose2& slam_from_base = views.front().slam_from_base;
    const Pose2 map_from_slam = map_from_base * Inverse(slam_from_base);
    auto near = FindPlaceNear(map, views, map_from_slam, within_m);
    const auto any = FindPlace(map, views, map_from_slam);
    if (!near || !any) return {};
    const bool is_elsewhere =
        IsElsewhere(near->map_from_slam * slam_from_base, any->map_from_slam * slam_from_base);
    near->second_score = is_elsewhere ? any->score : any->second_score;
    near->second = is_elsewhere ? any->map_from_slam : any->second;
    if (!is_elsewhere && within_m > 0.0) near->unsure = any->unsure;
    return near;
  };
  auto start = StartAt(prior, source, options, within_m, place_of);
  if (start) start->known = true;
  return start;
}

std::optional<MapStart> FindStart(const PriorMap& prior, const std::vector<Frame>& first_frames,
                                  const std::optional<PinholeCamera>& camera,
                                  const MapperOptions& options) {
  CollectedFrames source(first_frames, camera);
  return FindStart(prior, source, options);
}

std::optional<MapStart> FindStartNear(const PriorMap& prior, const Pose2& map_from_base,
                                      const std::vector<Frame>& first_frames,
                                      const std::optional<PinholeCamera>& camera,
                                      const MapperOptions& options, double within_m) {
  CollectedFrames source(first_frames, camera);
  return FindStartNear(prior, map_from_base, source, options, within_m);
}

}  // namespace depthgrid
