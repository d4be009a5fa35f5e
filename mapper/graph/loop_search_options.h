// Settings of loops that the mapper finds itself. Places are cut into surfels and matched with the
// default SurfelOptions whatever the run's are, so that these limits keep their meaning.
#pragma once

#include "mapper/core/options.h"
#include "mapper/graph/loop_overlap.h"
#include "mapper/graph/place.h"

namespace depthgrid {

enum class LoopSearchUse { kAuto, kOn, kOff };

struct LoopSearchOptions {
  LoopSearchUse use = LoopSearchUse::kAuto;
  double every_m = 1.0;  // way between two searches
  // Back along the way, so far at least, lies what is a loop: over less, drift stays within the
  // reach of matching and of the adjustment.
  double min_way_m = 20.0;
  // What the estimate may be off by after a way: where loops are looked for.
  double drift_share = 0.03;
  double turn_deg_per_m = 0.2;
  double min_window_m = 0.5;
  double max_window_m = 3.0;
  double min_window_deg = 5.0;
  double max_window_deg = 20.0;
  int candidates = 3;  // places that are searched, at most
  PlaceOptions place;
  double min_score = 0.55;        // of the search, 0..1
  double max_second_score = 0.9;  // share of the score that another pose may reach
  // The match of the two places: explained share, and the standard deviation that is left in its
  // worst direction. Sliding along a corridor is refused by it.
  double min_explained = 0.5;
  double max_sigma_m = 0.03;
  double max_sigma_deg = 0.6;
  // Of what both places saw, see loops.overlap. Right places agree by 0.98 and more, a third of the
  // rooms that look alike as well (docs/tried.md, "Which chains of places to believe").
  double min_agreement = 0.99;
  // Nearer to where they are anyway than this, places are left to the adjustment.
  double min_correction_m = 0.1;
  double min_correction_deg = 1.5;
  // So many loops in a row must want the same correction, to consent_m and consent_deg.
  int consenting = 4;
  // And over a way of so many times what they correct and what the estimate is likely off by (both
  // together no more than the window): rooms that look alike differ somewhere along several of them
  // (docs/tried.md, "Which chains of places to believe").
  double consent_ways = 7.0;
  double likely_drift_share = 0.005;  // of the way
  // While none waits for others to consent only one of so many searches is made. Once it finds a
  // place the others are made up for, so that only rows of places in which a search finds nothing
  // begin later.
  int idle_searches = 3;
  // Meanwhile so many searches may find nothing where old places are near.
  int most_unanswered = 1;
  double consent_m = 0.2;
  double consent_deg = 2.0;

  void Visit(OptionsVisitor& v);
};

}  // namespace depthgrid
