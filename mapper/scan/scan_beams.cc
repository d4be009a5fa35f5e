#include "mapper/scan/scan_beams.h"

#include "mapper/scan/clear_interval.h"

namespace depthgrid {
namespace {

// For the modes that clear as a laser does.
void FindClearOfLaser(const BearingViews& views, const std::vector<BlockHits>& hits,
                      double camera_height_m, const ScanOptions& options, BeamNumbers& beams) {
  for (std::size_t k = 0; k < beams.clear_to_m.size(); ++k) {
    BearingView view;
    const SlopeRange seen{views.seen.low[k], views.seen.high[k]};
    if (seen.low <= seen.high) view.seen = seen;
    const BlockHits& of_block = hits[k / kBlockBearings];
    const std::size_t i = k % kBlockBearings;
    const double limit_m = of_block.is_hit[i] > 0.0F ? of_block.range_m[i] : options.max_range_m;
    const Distances clear = LaserClearInterval(view, camera_height_m, limit_m, options);
    beams.clear_from_m[k] = static_cast<float>(clear.from_m);
    beams.clear_to_m[k] = static_cast<float>(clear.to_m);
  }
}

}  // namespace

void FindViews(const BearingLineTable& lines, const std::vector<BlockViews>& rows,
               BearingViews& views) {
  for (Slopes* slopes : {&views.seen, &views.below, &views.above}) {
    slopes->low.resize(rows.size() * kBlockBearings);
    slopes->high.resize(rows.size() * kBlockBearings);
  }
  views.has_gap.resize(rows.size());
  for (std::size_t block = 0; block < rows.size(); ++block) {
    internal::FindSlopes(lines.blocks[block], rows[block], block, views);
  }
}

Scan ScanOf(const std::vector<Bearing>& bearings, const BearingViews& views,
            const std::vector<BlockHits>& hits, double camera_height_m, const ScanOptions& options,
            BeamNumbers& memory, Scan scan) {
  memory.clear_from_m.resize(hits.size() * kBlockBearings);
  memory.clear_to_m.resize(hits.size() * kBlockBearings);
  if (options.mode == ScanMode::kFull) {
    internal::FindClear(views, hits, camera_height_m, options, memory);
  } else {
    FindClearOfLaser(views, hits, camera_height_m, options, memory);
  }
  scan.max_range_m = options.max_range_m;
  scan.beams.resize(bearings.size());
  for (std::size_t k = 0; k < bearings.size(); ++k) {
    const BlockHits& of_block = hits[k / kBlockBearings];
    const std::size_t i = k % kBlockBearings;
    scan.beams[k] = {static_cast<float>(bearings[k].angle_rad), of_block.range_m[i],
                     memory.clear_from_m[k], memory.clear_to_m[k], of_block.is_hit[i] > 0.0F};
  }
  return scan;
}

}  // namespace depthgrid
