#include "mapper/io/gravity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapper/core/angle.h"
#include "mapper/core/median.h"
#include "mapper/io/level_surface.h"

namespace depthgrid {
namespace {

using internal::FitNear;
using internal::kHeightBinM;
using internal::LevelPoints;
using internal::Levels;
using internal::NormalOf;
using internal::PlaneFit;
using internal::SurfaceView;
using Patches = std::vector<internal::SurfacePatch>;
using Views = std::vector<SurfaceView>;

const double kMaxFromImageUp = std::cos(RadFromDeg(50.0));
const double kCandidateCone = std::cos(RadFromDeg(6.0));
constexpr std::size_t kCandidates = 300;
constexpr std::size_t kVoterStep = 3;
constexpr std::size_t kMinFloorPatches = 200;
constexpr double kMinFloorShare = 0.02;  // of all patches
// Patches that an image needs to be used for the level.
constexpr std::size_t kMinViewPatches = 40;
constexpr double kWanderShare = 0.9;

// The images agree on the floor when this share of them has its lowest surface this near to it.
constexpr double kAgreeM = 0.1;
constexpr double kAgreeShare = 0.5;
// If they do not, this many of the first ones define the floor and up.
constexpr std::size_t kFirstViews = 3;
// The same if the first images have the floor farther off than this with the camera as high above
// it as later: in a few seconds SLAM's height drifts by less than kAgreeM for half of the images.
constexpr double kFirstFloorOffM = 0.03;
// A camera above a table is at least this much lower than above the floor, also if hand-held.
constexpr double kTableM = 0.3;
// Without drift the median scatter of the images' normals is below this (0.4 degrees even if some
// see only cushions and sills).
constexpr double kDriftRad = RadFromDeg(0.8);
// SLAM's tilt also drifted, at the start only, if the first images' floor is off from the common
// one by more than a single place may be (1.5 degrees).
constexpr double kFirstOffRad = RadFromDeg(2.0);
// Furniture stands on floors. Of the patches of ceilings up to 4 % are on something this much
// nearer to the camera (docs/tried.md, "Other people's data"); of the floors of cameras that are
// upside down 8 to 22 %, ten times the share of the ceiling or more.
constexpr double kStandingM = 0.2;
constexpr double kCrowdedShare = 0.06;
constexpr double kMoreCrowded = 5.0;
constexpr std::size_t kMinCeilingPatches = 500;
// Patches this near to the plane are used in its fit, per iteration.
constexpr double kFitBandM[] = {0.15, 0.10, 0.07, 0.05};

// The direction shared by most normals, among a few hundred candidates.
Eigen::Vector3d CommonNormal(const Patches& patches) {
  Eigen::Vector3d best = patches.front().normal;
  std::size_t most = 0;
  const std::size_t step = std::max<std::size_t>(1, patches.size() / kCandidates);
  for (std::size_t i = 0; i < patches.size(); i += step) {
    std::size_t votes = 0;
    for (std::size_t k = 0; k < patches.size(); k += kVoterStep) {
      votes += patches[k].normal.dot(patches[i].normal) > kCandidateCone ? 1 : 0;
    }
    if (votes > most) {
      most = votes;
      best = patches[i].normal;
    }
  }
  return best;
}

struct Direction {
  Eigen::Vector3d up;
  double wander_rad;
  double error_rad;
  bool drifts;
};

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, a.dot(b)));
}

// Up from the first images, as SLAM's world was defined there and its tilt drifts. The median of
// their normals, to be robust against a slanted surface, using the larger surfaces only.
Eigen::Vector3d FirstUp(std::vector<PlaneFit> fits, const Eigen::Vector3d& up,
                        std::size_t most_views) {
  std::vector<double> sizes;
  sizes.reserve(fits.size());
  for (const PlaneFit& fit : fits) sizes.push_back(static_cast<double>(fit.points));
  const double usual = UpperMedian(sizes);
  std::erase_if(fits, [&](const PlaneFit& f) { return static_cast<double>(f.points) < usual; });
  fits.resize(std::min(fits.size(), most_views));
  Eigen::Vector3d middle = up;
  double least_rad = std::numeric_limits<double>::infinity();
  for (const PlaneFit& fit : fits) {
    const Eigen::Vector3d normal = NormalOf(fit.scatter, up);
    double sum_rad = 0.0;
    for (const PlaneFit& other : fits) sum_rad += AngleBetween(normal, NormalOf(other.scatter, up));
    if (sum_rad >= least_rad) continue;
    least_rad = sum_rad;
    middle = normal;
  }
  return middle;
}

// The largest level surface of each image that sees one.
std::vector<PlaneFit> LargestLevels(const Views& views, const Eigen::Vector3d& up, double band_m) {
  std::vector<PlaneFit> fits;
  for (const SurfaceView& view : views) {
    const std::vector<Eigen::Vector3d> level = LevelPoints(view.patches, up);
    if (level.size() < kMinViewPatches) continue;
    const PlaneFit fit = FitNear(level, up, Levels(level, up).FullestM(), band_m);
    if (fit.points >= kMinViewPatches) fits.push_back(fit);
  }
  return fits;
}

// Up as the common normal of the largest level surface of each image. Each surface has its own
// height, as a table is as level as the floor and SLAM's height drifts (a single plane through all
// was tilted by 2.9 degrees by a drift of 0.6 m).
struct CommonLevel {
  Eigen::Vector3d up;
  std::vector<PlaneFit> fits;  // of the images with a level surface; empty: up is unknown
};

CommonLevel FitCommonLevel(const Views& views, const Eigen::Vector3d& about_up) {
  CommonLevel level{about_up, {}};
  for (const double band_m : kFitBandM) {
    level.fits = LargestLevels(views, level.up, band_m);
    if (level.fits.empty()) break;
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const PlaneFit& fit : level.fits) scatter += fit.scatter;
    level.up = NormalOf(scatter, level.up);
  }
  return level;
}

Patches PatchesOf(const Views& views) {
  Patches all;
  for (const auto& [camera, own] : views) all.insert(all.end(), own.begin(), own.end());
  return all;
}

struct FloorOfViews {
  double height_m = 0.0;  // up . point
  double camera_height_m = 0.0;
  bool is_late = false;
};

// The lowest surface of each image.
std::vector<FloorOfViews> OwnFloors(const Views& views, const Eigen::Vector3d& up) {
  std::vector<FloorOfViews> floors;
  for (const SurfaceView& view : views) {
    const std::vector<Eigen::Vector3d> own = LevelPoints(view.patches, up);
    if (own.size() < kMinViewPatches) continue;
    const double own_m = Levels(own, up).LowestM();
    const PlaneFit fit = FitNear(own, up, own_m, kHeightBinM);
    const double floor_m = fit.points > 0 ? up.dot(fit.mean) : own_m;
    floors.push_back({floor_m, up.dot(view.camera) - floor_m, false});
  }
  return floors;
}

double MiddleOf(const std::vector<FloorOfViews>& floors, double FloorOfViews::*number) {
  std::vector<double> numbers;
  for (const FloorOfViews& floor : floors) numbers.push_back(floor.*number);
  return UpperMedian(numbers);
}

// Up from the recording's first images, if they see a floor.
std::optional<Eigen::Vector3d> UpAtFirst(const Views& first_views) {
  if (first_views.empty()) return {};
  const auto patches = PatchesOf(first_views);
  if (patches.size() < kMinFloorPatches) return {};
  const CommonLevel first = FitCommonLevel(first_views, CommonNormal(patches));
  if (first.fits.size() < kFirstViews) return {};
  return FirstUp(first.fits, first.up, first.fits.size());
}

// Whether most of the first images see the floor at the same height and as level as the later ones.
bool SeeSameFloor(const Views& first_views, const Views& views, const Eigen::Vector3d& up) {
  const auto later = OwnFloors(views, up);
  if (later.empty()) return false;
  const double usual_m = MiddleOf(later, &FloorOfViews::camera_height_m);
  std::size_t seeing = 0;
  for (const SurfaceView& view : first_views) {
    const auto points = LevelPoints(view.patches, up);
    const double floor_m = up.dot(view.camera) - usual_m;
    const PlaneFit fit = FitNear(points, up, floor_m, kAgreeM);
    if (fit.points < kMinViewPatches) continue;
    seeing += AngleBetween(NormalOf(fit.scatter, up), up) <= kFirstOffRad ? 1 : 0;
  }
  return 2 * seeing > first_views.size();
}

// Whether the camera's height above the first images' level surface equals that above the later
// images' floor; otherwise the surface may be a sofa's cushions.
bool IsFloorToo(const Views& first_views, const Eigen::Vector3d& first_up, const Views& views,
                const Eigen::Vector3d& up) {
  const auto first = OwnFloors(first_views, first_up);
  const auto later = OwnFloors(views, up);
  return !first.empty() && !later.empty() &&
         std::abs(MiddleOf(first, &FloorOfViews::camera_height_m) -
                  MiddleOf(later, &FloorOfViews::camera_height_m)) <= kAgreeM;
}

// Of each image's normal.
std::vector<double> AnglesFrom(const CommonLevel& level) {
  std::vector<double> angles_rad;
  for (const PlaneFit& fit : level.fits) {
    angles_rad.push_back(AngleBetween(level.up, NormalOf(fit.scatter, level.up)));
  }
  return angles_rad;
}

// The median angle between the normals of images that follow each other. If SLAM's tilt drifts it
// is a small part of their scatter, if each image has an error of its own 1.4 times as much.
double StepOf(const CommonLevel& level) {
  std::vector<double> steps_rad = {0.0};
  for (std::size_t i = 1; i < level.fits.size(); ++i) {
    steps_rad.push_back(AngleBetween(NormalOf(level.fits[i - 1].scatter, level.up),
                                     NormalOf(level.fits[i].scatter, level.up)));
  }
  return UpperMedian(steps_rad);
}

double QuantileOf(std::vector<double> numbers, double share) {
  std::sort(numbers.begin(), numbers.end());
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(numbers.size()));
  return numbers[std::min(rank, numbers.size() - 1)];
}

std::optional<Direction> CommonUp(const Views& views, const Views& first_views,
                                  const Eigen::Vector3d& about_up) {
  const CommonLevel level = FitCommonLevel(views, about_up);
  if (level.fits.empty()) return {};
  const auto angles_rad = AnglesFrom(level);
  const double wander_rad = QuantileOf(angles_rad, kWanderShare);
  const double error_rad = wander_rad / std::sqrt(static_cast<double>(angles_rad.size()));
  const double usual_rad = UpperMedian(angles_rad);
  const std::optional<Eigen::Vector3d> first = UpAtFirst(first_views);
  const bool drifts = (usual_rad > kDriftRad && StepOf(level) < usual_rad) ||
                      (first && AngleBetween(level.up, *first) > kFirstOffRad &&
                       !SeeSameFloor(first_views, views, level.up) &&
                       IsFloorToo(first_views, *first, views, level.up));
  if (!drifts) return Direction{level.up, wander_rad, error_rad, false};
  // Otherwise from the first of the spread images that see a floor.
  return Direction{first ? *first : FirstUp(level.fits, level.up, kFirstViews), wander_rad,
                   error_rad, true};
}

std::vector<FloorOfViews> WithoutTables(std::vector<FloorOfViews> floors, double usual_camera_m) {
  std::erase_if(floors, [&](const FloorOfViews& floor) {
    return floor.camera_height_m < usual_camera_m - kTableM;
  });
  return floors;
}

// The floor from the first images; the camera's height is the one above each image's own lowest
// surface. If few of the first images see the floor, the next ones are used: late, unless the few
// agree.
FloorOfViews FirstFloor(const std::vector<FloorOfViews>& first,
                        const std::vector<FloorOfViews>& own) {
  const double usual_m = MiddleOf(own, &FloorOfViews::camera_height_m);
  const auto first_height_m = [](std::vector<FloorOfViews> floors) {
    floors.resize(std::min(floors.size(), kFirstViews));
    return MiddleOf(floors, &FloorOfViews::height_m);
  };
  const auto seeing = WithoutTables(first, usual_m);
  const double next_m = first_height_m(WithoutTables(own, usual_m));
  if (seeing.empty()) return {next_m, usual_m, true};
  const double first_m = first_height_m(seeing);
  if (seeing.size() >= kFirstViews) return {first_m, usual_m, false};
  return {next_m, usual_m, std::abs(first_m - next_m) > kFirstFloorOffM};
}

// Whether SLAM's height drifts: the images disagree on the lowest surface, or the first ones see
// theirs at another height and it is not a table.
bool HeightDrifts(const std::vector<FloorOfViews>& first, const std::vector<FloorOfViews>& own,
                  double lowest_m) {
  if (own.empty()) return false;
  const auto agreeing = std::count_if(own.begin(), own.end(), [&](const FloorOfViews& floor) {
    return std::abs(floor.height_m - lowest_m) <= kAgreeM;
  });
  if (static_cast<double>(agreeing) < kAgreeShare * static_cast<double>(own.size())) return true;
  if (first.size() < kFirstViews) return false;
  const FloorOfViews at_first = FirstFloor(first, first);
  const double usual_m = MiddleOf(own, &FloorOfViews::camera_height_m);
  return std::abs(at_first.height_m - lowest_m) > kFirstFloorOffM &&
         std::abs(at_first.camera_height_m - usual_m) < kAgreeM;
}

// The floor is the lowest of all surfaces, with the camera's height above it. If SLAM's height
// drifts, it is the floor of the first images.
FloorOfViews FloorUnder(const Views& views, const Views& first_views,
                        const std::vector<Eigen::Vector3d>& level, const Eigen::Vector3d& up) {
  const double lowest_m = Levels(level, up).LowestM();
  const std::vector<FloorOfViews> own = OwnFloors(views, up);
  const std::vector<FloorOfViews> first = OwnFloors(first_views, up);
  if (HeightDrifts(first, own, lowest_m)) return FirstFloor(first, own);
  const double floor_m = up.dot(FitNear(level, up, lowest_m, kHeightBinM).mean);
  std::vector<double> cameras_m;
  for (const SurfaceView& view : views) cameras_m.push_back(up.dot(view.camera) - floor_m);
  return {floor_m, UpperMedian(cameras_m), false};
}

struct Crowd {
  std::size_t level = 0;     // patches
  std::size_t standing = 0;  // of them, on what stands on the lowest level of their image
  double Share() const {
    return level == 0 ? 0.0 : static_cast<double>(standing) / static_cast<double>(level);
  }
};

// Each image for itself, as SLAM's height drifts.
Crowd CrowdOn(const Views& views, const Eigen::Vector3d& up) {
  Crowd crowd;
  for (const SurfaceView& view : views) {
    const std::vector<Eigen::Vector3d> own = LevelPoints(view.patches, up);
    if (own.size() < kMinViewPatches) continue;
    const double standing_m = Levels(own, up).LowestM() + kStandingM;
    crowd.level += own.size();
    for (const Eigen::Vector3d& point : own) crowd.standing += up.dot(point) > standing_m ? 1 : 0;
  }
  return crowd;
}

bool CrowdedAbove(const Views& views, const Eigen::Vector3d& up) {
  const Crowd above = CrowdOn(views, -up);
  return above.level >= kMinCeilingPatches && above.Share() > kCrowdedShare &&
         above.Share() > kMoreCrowded * CrowdOn(views, up).Share();
}

Views Upward(Views views, const Eigen::Vector3d& image_up) {
  for (SurfaceView& view : views) {
    std::erase_if(view.patches,
                  [&](const auto& patch) { return patch.normal.dot(image_up) <= kMaxFromImageUp; });
  }
  return views;
}

}  // namespace

void GravityFinder::Add(const DepthImage& image, const PinholeCamera& camera,
                        const Pose3& world_from_camera) {
  views_.push_back(internal::ViewOf(image, camera, world_from_camera));
  images_up_.Add(world_from_camera);
}

void GravityFinder::AddFirst(const DepthImage& image, const PinholeCamera& camera,
                             const Pose3& world_from_camera) {
  first_views_.push_back(internal::ViewOf(image, camera, world_from_camera));
}

std::optional<Gravity> GravityFinder::Find(bool upside_down) const {
  if (images_up_.Mean().norm() == 0.0) return {};
  const Eigen::Vector3d image_up = (upside_down ? -1.0 : 1.0) * images_up_.Mean().normalized();
  const Views upward = Upward(views_, image_up);
  const Views first_upward = Upward(first_views_, image_up);
  const Patches together = PatchesOf(upward);
  // A camera mounted upside down mostly looks up.
  const double share =
      upside_down ? 0.0 : kMinFloorShare * static_cast<double>(PatchesOf(views_).size());
  const std::size_t needed = std::max(kMinFloorPatches, static_cast<std::size_t>(share));
  if (together.size() < needed) return {};
  const auto direction = CommonUp(upward, first_upward, CommonNormal(together));
  if (!direction) return {};
  const std::vector<Eigen::Vector3d> level = LevelPoints(together, direction->up);
  if (level.size() < needed) return {};
  const FloorOfViews floor = FloorUnder(upward, first_upward, level, direction->up);
  if (floor.camera_height_m <= 0.0) return {};
  const double below = internal::ShareBelow(views_, direction->up, floor.height_m - kTableM);
  return Gravity{direction->up,
                 direction->wander_rad,
                 direction->error_rad,
                 direction->drifts,
                 floor.height_m,
                 floor.camera_height_m,
                 floor.is_late,
                 below,
                 CrowdedAbove(views_, direction->up)};
}

}  // namespace depthgrid
