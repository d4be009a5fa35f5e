// Rooms and ground truth, which many runs share and which are slow to make.
#pragma once

#include <memory>

#include "eval/run/truth_record.h"
#include "eval/run/world.h"
#include "eval/sweep/shelf.h"

namespace depthgrid {

class SweepInputs {
 public:
  explicit SweepInputs(int threads) : threads_(threads) {}

  // Both throw InputError as LoadWorld does. Thread-safe.
  std::shared_ptr<const World> WorldOf(const ExperimentOptions& options);
  std::shared_ptr<const TruthRecord> TruthOf(const ExperimentOptions& options);

 private:
  int threads_;
  // More than runs that are close to each other in a sweep need; a world takes a few MB.
  Shelf<World> worlds_{8};
  Shelf<TruthRecord> truths_{16};
};

}  // namespace depthgrid
