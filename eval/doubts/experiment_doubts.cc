#include "eval/doubts/experiment_doubts.h"

#include "eval/doubts/crossing_check.h"
#include "eval/doubts/truth_check.h"
#include "eval/doubts/units_check.h"
#include "eval/doubts/view_check.h"

namespace depthgrid {

std::vector<std::string> DoubtsOfExperiment(const World& world, const MappingRun& run,
                                            const TruthRecord& truth,
                                            const ExperimentOptions& options) {
  std::vector<std::string> doubts;
  for (const auto& doubt : {DoubtOfUnits(world.scene), DoubtOfView(run, options),
                            DoubtOfCrossing(run.result), DoubtOfTruth(world, truth, options)}) {
    if (doubt) doubts.push_back(*doubt);
  }
  return doubts;
}

}  // namespace depthgrid
