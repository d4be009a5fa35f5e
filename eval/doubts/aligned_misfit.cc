#include "eval/doubts/aligned_misfit.h"

#include "eval/metrics/alignment.h"
#include "eval/metrics/trajectory_metrics.h"

namespace depthgrid {

std::optional<double> AlignedMisfit(const std::vector<PosePair>& pairs) {
  if (const auto fit = Align(pairs, Alignment::kSe3)) {
    return Summarise(TranslationErrorsXyz(Aligned(pairs, *fit))).rmse;
  }
  const auto level = Align(pairs, Alignment::kSe2);
  if (!level) return std::nullopt;
  return Summarise(TranslationErrorsXy(Aligned(pairs, *level))).rmse;
}

}  // namespace depthgrid
