// Warnings about a sweep that is probably not as intended.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "eval/run/truth_record.h"
#include "eval/sweep/sweep_plan.h"

namespace depthgrid {

// Warns of runs that must give the same result as an earlier one because the settings in which they
// differ have no effect. One line; empty when all differ. Of very many runs only the first are
// checked.
std::optional<std::string> DoubtOfRepeats(const SweepPlan& plan);

// Warns of seed axes with a single number, which was probably meant as the number of seeds: one
// line each.
std::vector<std::string> DoubtsOfLoneSeeds(const std::vector<SweepAxis>& axes);

// Warns if the points have too few seeds for `stop`, which is at `place`.
std::optional<std::string> DoubtOfStop(const SweepPlan& plan, const std::string& place);

// Warns of keys given in the sweep's file (`fixed`) or by --set that an axis overrides in every
// run: one line each.
std::vector<std::string> DoubtsOfAxisKeys(const SweepPlan& plan, const Config& fixed,
                                          const std::vector<std::string>& set);

// Warns of probably unintended cameras: the first, and their number.
std::optional<std::string> DoubtOfCameras(const SweepPlan& plan);

// The sources of a sweep's settings; later ones override earlier ones.
struct SweepLayers {
  const Config& experiment;  // the file
  const Config& fixed;       // what the sweep's file sets
  const std::vector<std::string>& set;
  // The experiment with `fixed` and some of `set`.
  std::function<Config(const std::vector<std::string>& set)> base_with;
};

// Warns of settings without effect in any run, one line each; for the experiment's file only if it
// is the user's own (not `is_shipped`).
std::vector<std::string> DoubtsOfLayers(const SweepPlan& plan, const SweepLayers& layers,
                                        bool is_shipped);

// Warnings from the runs' results, each given once for all runs: true maps without a free cell or
// with most of the path outside free cells, and maps without a free cell.
class RunDoubts {
 public:
  void Add(const PlannedRun& run, const OccupancyMap& map, const TruthRecord& truth,
           const ExperimentOptions& options);
  std::vector<std::string> Lines(const SweepPlan& plan) const;

 private:
  struct Kind {
    int runs = 0;
    int first = -1;
    std::string of_first;

    void Add(int run, const std::string& doubt);
  };
  Kind truth_;
  Kind map_;
};

// Warns of settings that the experiment's file has for its own slam.profile and that remain when
// `fixed` or an axis selects another: one line.
std::optional<std::string> DoubtOfProfiles(const std::string& name, const Config& experiment,
                                           const Config& fixed, const std::vector<SweepAxis>& axes);

}  // namespace depthgrid
