#include "eval/doubts/agreement_check.h"

#include <fmt/format.h>

#include "mapper/grid/crossed_walls.h"

namespace depthgrid {
namespace {

// Warned of from this share on (docs/results.md, "Scans against their map").
constexpr double kManyCrossing = 0.02;

}  // namespace

std::optional<Agreement> AgreementOf(const MapperResult& result) {
  Agreement agreement;
  int crossing = 0, worst = 0;
  for (const CrossedWalls& scan : WallsCrossed(result.mapped, result.map)) {
    agreement.beams += scan.beams;
    crossing += scan.crossing;
    if (scan.crossing <= worst) continue;
    worst = scan.crossing;
    agreement.worst_frame = FrameAt(result.mapped, scan.mapped).frame;
  }
  if (agreement.beams == 0) return {};
  agreement.crossing_share = static_cast<double>(crossing) / agreement.beams;
  return agreement;
}

std::optional<std::string> DoubtOfAgreement(const Agreement& agreement) {
  if (agreement.crossing_share < kManyCrossing) return {};
  return fmt::format(
      "the map contradicts its own scans: {:.1f} % of the beams lead through its walls (most "
      "around frame {}), so walls are drawn twice or askew, as where poses are wrong",
      100.0 * agreement.crossing_share, *agreement.worst_frame);
}

std::optional<std::string> DoubtOfAgreement(const MapperResult& result) {
  const auto agreement = AgreementOf(result);
  return agreement ? DoubtOfAgreement(*agreement) : std::nullopt;
}

}  // namespace depthgrid
