// What of a sweep is likely not meant, found before its first run.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "eval/run/truth_record.h"
#include "eval/sweep/sweep_plan.h"

namespace depthgrid {

// Runs that must give what an earlier one gives, as the settings in which they differ have no
// effect there: one line, nothing when all differ. Of very many runs the first ones are looked at.
std::optional<std::string> DoubtOfRepeats(const SweepPlan& plan);

// Axes of seeds with one number, by which so many seeds were most likely meant: a line each.
std::vector<std::string> DoubtsOfLoneSeeds(const std::vector<SweepAxis>& axes);

// A `stop`, which stands at `place`, for which the points have too few seeds.
std::optional<std::string> DoubtOfStop(const SweepPlan& plan, const std::string& place);

// What the sweep's file (`fixed`) or --set gives of the keys of an axis, whose values take its
// place in every run: a line each.
std::vector<std::string> DoubtsOfAxisKeys(const SweepPlan& plan, const Config& fixed,
                                          const std::vector<std::string>& set);

// Cameras of runs that are likely not meant: the first, and how many there are.
std::optional<std::string> DoubtOfCameras(const SweepPlan& plan);

// Where a sweep's settings come from, the later before the earlier.
struct SweepLayers {
  const Config& experiment;  // the file
  const Config& fixed;       // what the sweep's file sets
  const std::vector<std::string>& set;
  // The experiment with what is fixed and some of `set`.
  std::function<Config(const std::vector<std::string>& set)> base_with;
};

// Settings that have no effect in any run, a line each; of the experiment's file only where it is
// the user's (`is_shipped`: it is not).
std::vector<std::string> DoubtsOfLayers(const SweepPlan& plan, const SweepLayers& layers,
                                        bool is_shipped);

// What runs showed to be likely not meant, once however many do: a true map without a free cell or
// in which most of the path lies in others, and maps without a free cell.
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

// Settings that the experiment's file holds for its own slam.profile, and that stay when `fixed` or
// an axis chooses another: one line.
std::optional<std::string> DoubtOfProfiles(const std::string& name, const Config& experiment,
                                           const Config& fixed, const std::vector<SweepAxis>& axes);

}  // namespace depthgrid
