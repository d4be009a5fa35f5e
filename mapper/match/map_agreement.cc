#include "mapper/match/map_agreement.h"

#include <algorithm>
#include <iterator>

namespace depthgrid {
namespace {

// Every this many-th beam is compared.
constexpr std::size_t kNextBeam = 4;
constexpr double kOnWallM = 0.15;
// Weight of all beams relative to those that contradict the map, so that beams into unknown space
// count a little. Small, because a robot that leaves the map at once sees little of it.
constexpr double kUnknownWorth = 0.1;

}  // namespace

double MapAgreement::share() const {
  return on_wall == 0 ? 0.0 : on_wall / (on_wall + against + kUnknownWorth * beams);
}

double MapAgreement::share_against() const {
  return against == 0 ? 0.0 : static_cast<double>(against) / (on_wall + against);
}

void Compare(const Scan& scan, const Pose2& map_from_base, const DistanceField& walls,
             MapAgreement& agreement) {
  const Eigen::Vector2d from = map_from_base.translation();
  for (std::size_t i = 0; i < scan.beams.size(); i += kNextBeam) {
    const Beam& beam = scan.beams[i];
    if (!beam.hit) continue;
    const Eigen::Vector2d to = map_from_base * EndPoint(beam);
    const bool through = std::any_of(std::begin(kOnTheWay), std::end(kOnTheWay), [&](double share) {
      return walls.FreeAt(from + share * (to - from)) < 0;
    });
    const double off_m = walls.At(to);
    ++agreement.beams;
    if (through || (off_m > kOffWallM && walls.FreeAt(to) > 0)) {
      ++agreement.against;
    } else if (off_m < kOnWallM) {
      ++agreement.on_wall;
    }
  }
}

}  // namespace depthgrid
