// Loop detection by the mapper itself: finds whether the current place was seen before, and where
// (docs/math.md, "Loops found by the mapper")
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/graph/loop_search_options.h"
#include "mapper/graph/place_matcher.h"

namespace depthgrid {

class LoopSearch {
 public:
  LoopSearch(const LoopSearchOptions& options, const OverlapOptions& overlap)
      : options_(options), overlap_(overlap), matcher_(options, overlap) {}

  // Call after each mapped frame; returns newly accepted loops. `known`: loops between `frames`
  // that the poses were adjusted with.
  std::vector<PlanarLoop> Find(const std::vector<MappedFrame>& frames,
                               const std::shared_ptr<const Scan>& newest,
                               const std::vector<PlanarLoop>& known, ReferenceMap& reference);
  // Call after the frames' poses were changed.
  void Forget();

 private:
  void Walk(const std::vector<MappedFrame>& frames);
  std::vector<int> Candidates(const std::vector<MappedFrame>& frames,
                              const std::vector<PlanarLoop>& known, int query) const;
  double DriftingM(const std::vector<PlanarLoop>& known, int first, int second) const;
  double WindowM(double way_m) const;
  double WindowRad(double way_m) const;
  bool Consents(const std::vector<MappedFrame>& frames, const PlanarLoop& a,
                const PlanarLoop& b) const;
  // The likeliest candidate that passes all tests of a single place.
  struct Answer {
    std::optional<PlanarLoop> loop;
    double way_m = 0.0;  // path between the two places, over which drift accumulated
  };
  // A search for the place of `frame`, using frames before `end` only.
  struct Query {
    int frame = 0;
    int end = 0;
  };
  Answer AnswerTo(const std::vector<MappedFrame>& frames, const std::vector<PlanarLoop>& known,
                  const Query& query);
  bool AddAnswer(const std::vector<MappedFrame>& frames, const Answer& answer);
  void Unanswered();
  bool Suffices(double correction_m, double way_m) const;

  LoopSearchOptions options_;
  OverlapOptions overlap_;
  PlaceMatcher matcher_;
  KnownPlaces places_;
  std::vector<double> way_m_;   // path length to each mapped frame
  std::vector<int> keyframes_;  // kept frames `every_m` apart
  double next_search_m_ = 0.0;
  std::vector<Query> put_off_;       // postponed while no loop is waiting
  std::vector<PlanarLoop> waiting_;  // loops waiting for more consenting ones
  int unanswered_ = 0;               // unsuccessful searches since the first waiting loop
};

}  // namespace depthgrid
