// Loops that the mapper finds itself: has this place been seen before, and where does the map have
// it? (docs/math.md, "Loops found by the mapper")
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

  // To be asked after each frame that was mapped: loops that came to be believed. `known` are those
  // between frames of `frames` that the poses were adjusted by.
  std::vector<PlanarLoop> Find(const std::vector<MappedFrame>& frames,
                               const std::shared_ptr<const Scan>& newest,
                               const std::vector<PlanarLoop>& known, ReferenceMap& reference);
  // The frames were moved.
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
  // Of the likeliest candidate that passes every test of a single place.
  struct Answer {
    std::optional<PlanarLoop> loop;
    double way_m = 0.0;  // over which the two drifted apart
  };
  // Which frame's place is asked for, when there were none from `end` on.
  struct Query {
    int frame = 0;
    int end = 0;
  };
  Answer AnswerTo(const std::vector<MappedFrame>& frames, const std::vector<PlanarLoop>& known,
                  const Query& query);
  bool Take(const std::vector<MappedFrame>& frames, const Answer& answer);
  void Unanswered();
  bool Suffices(double correction_m, double way_m) const;

  LoopSearchOptions options_;
  OverlapOptions overlap_;
  PlaceMatcher matcher_;
  KnownPlaces places_;
  std::vector<double> way_m_;   // to each mapped frame
  std::vector<int> keyframes_;  // kept frames `every_m` apart
  double next_search_m_ = 0.0;
  std::vector<Query> put_off_;       // that were not searched for while none waits
  std::vector<PlanarLoop> waiting_;  // for more that consent
  int unanswered_ = 0;               // searches since the first of them that found nothing
};

}  // namespace depthgrid
