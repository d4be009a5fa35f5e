// Settings of the mapper's own loop detection. Places are matched with the default SurfelOptions,
// whatever the run's are, so that these limits keep their meaning.
#pragma once

#include "mapper/core/options.h"
#include "mapper/graph/loop_overlap.h"
#include "mapper/graph/place.h"

namespace depthgrid {

enum class LoopSearchUse { kAuto, kOn, kOff };

struct LoopSearchOptions {
  LoopSearchUse use = LoopSearchUse::kAuto;
  double every_m = 1.0;  // path length between two searches
  // Least path length between the places of a loop: over less, matching and the adjustment can
  // handle the drift.
  double min_way_m = 20.0;
  // Search window: the largest drift expected, by path length.
  double drift_share = 0.03;
  double turn_deg_per_m = 0.2;
  double min_window_m = 0.5;
  double max_window_m = 3.0;
  double min_window_deg = 5.0;
  double max_window_deg = 20.0;
  int candidates = 3;  // most places searched
  PlaceOptions place;
  double min_score = 0.55;        // of the search, 0..1
  double max_second_score = 0.9;  // greatest share of the score of any pose elsewhere
  // Limits on the match of the two places: explained share, and standard deviation in its worst
  // direction, which excludes corridors.
  double min_explained = 0.5;
  double max_sigma_m = 0.03;
  double max_sigma_deg = 0.6;
  // Least agreement of what both places saw (see loops.overlap). Right places reach 0.98 and more,
  // but so do a third of the rooms that look alike (docs/tried.md, "Which chains of places to
  // believe").
  double min_agreement = 0.99;
  // Smaller corrections are left to the adjustment.
  double min_correction_m = 0.1;
  double min_correction_deg = 1.5;
  // Number of consecutive loops that must agree on the correction, to consent_m and consent_deg.
  int consenting = 4;
  // They must extend over a path of this many times the sum of the correction and the likely drift
  // (the sum limited to the window): rooms that look alike differ somewhere along several of them
  // (docs/tried.md, "Which chains of places to believe").
  double consent_ways = 7.0;
  double likely_drift_share = 0.005;  // of the path
  // While no loop is waiting, only one of this many searches is done. Once it finds a place the
  // skipped ones are done too, so nothing is lost unless that search fails.
  int idle_searches = 3;
  // Number of searches that may fail near old places while loops are waiting.
  int most_unanswered = 1;
  double consent_m = 0.2;
  double consent_deg = 2.0;

  void Visit(OptionsVisitor& v);
};

}  // namespace depthgrid
