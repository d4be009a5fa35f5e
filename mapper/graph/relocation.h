// Finds the camera after SLAM was lost for seconds and came back elsewhere: matches what was seen
// since with all that was seen before (docs/math.md, "Wide search after a loss").
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/core/reference_map.h"
#include "mapper/graph/guessed_part.h"
#include "mapper/graph/place_matcher.h"

namespace depthgrid {

struct RelocationOptions {
  bool use = true;
  // Slips of odometry or SLAM by a few degrees within a frame: when the map suddenly explains
  // little of a scan, headings up to this far from the prediction are tried; 0: none.
  double slip_deg = 12.0;
  // Least time without pose for a search. After less, the last motion or SLAM's own relocalisation
  // is near enough for matching.
  double min_lost_s = 2.0;
  // The same where SLAM's poses continue too far away to have been reached, in a new epoch or far
  // beyond their usual motion, as SLAM that restarts may choose any origin. Up to this time the
  // last motion can be extrapolated.
  double min_lost_epoch_s = 0.5;
  // A guess is accepted when the map explains at least this share of what it usually did before the
  // loss.
  double min_share = 0.6;
  // Radius of the search around the last pose, plus what may have been walked since at speed_mps;
  // all headings are tried.
  double window_m = 2.0;
  double speed_mps = 1.0;
  double max_window_m = 12.0;
  // Path length or turn between searches, after which something new is in view.
  double every_m = 0.5;
  double every_deg = 30.0;
  // After so many searches they become rarer, and consent is asked for over place.reach_m of path.
  int most_searches = 12;
  // The scans since the loss, as far back as this, are matched together.
  PlaceOptions place = {.reach_m = 3.0, .turn_deg = 360.0, .max_scans = 24};
  double min_score = 0.8;          // least score of the search, 0..1
  double max_second_score = 0.85;  // greatest share of the score of any pose elsewhere
  // Least agreement of what was seen before and since, of the place and of all that was seen since.
  // Right places reach 0.997 and more, similar offices 0.966, two rectangular rooms 0.992
  // (docs/results.md, "Lost and found").
  double min_agreement = 0.995;
  // Number of consecutive searches that must agree, to consent_m and consent_deg.
  int consenting = 2;
  double consent_m = 0.2;
  double consent_deg = 2.0;

  void Visit(OptionsVisitor& v);
};

class Relocation {
 public:
  // `gates`: the limits for loops, by which two places are tested.
  Relocation(const RelocationOptions& options, const LoopSearchOptions& gates,
             const OverlapOptions& overlap)
      : options_(options),
        overlap_(overlap),
        matcher_(gates, overlap),
        guess_matcher_(ForGuess(gates), overlap) {}

  // Adds the explained share of a matched frame in normal operation.
  void Explained(double share);
  // Reports a loss: time without pose before this frame and, if SLAM may have restarted, the
  // difference between its poses.
  void Lost(double duration_s, const std::optional<Pose2>& step);
  // Reports that SLAM began an epoch after frames without a pose, however few: unless the map
  // explains the first scan the place is searched for, but SLAM's word is believed meanwhile.
  void Restarted(double duration_s);
  // Reports that the camera was carried elsewhere, nobody knows how far: the whole largest window
  // is searched.
  void Carried();
  // Reports a pause of the recording. SLAM's step over it is believed unless no robot makes it in
  // that time (speed_mps).
  void Paused(double duration_s, const Pose2& step);
  // Call with a loss in a finished map, whose last frame does not tell where the camera was: its
  // last known pose in the map.
  void LastKnownAt(const Pose2& map_from_base) { last_known_ = map_from_base; }
  // Decides, from the map's explained share of the first scan after a loss, whether the guess is
  // doubtful. If so, begins the search; `next_frame` is the first mapped frame of the new part.
  bool BeginIfDoubtful(double share, int next_frame);
  // Whether a match's explained share is that of a right place.
  bool IsUsual(double share) const { return share >= options_.min_share * usual_share_; }
  double usual_share() const { return usual_share_; }
  // Whether the place is searched for often.
  bool active() const { return active_; }
  // Whether, besides, SLAM's word about it is not believed.
  bool doubts() const { return active_ && !believes_; }
  // Whether the newest part lies where nobody believes it to be, so that what was seen before tells
  // nothing about it.
  bool IsApart() const { return unsettled() && !believes_; }
  // Whether the place after the last loss is still a guess, searched for often or rarely.
  bool unsettled() const { return active_ || rare_; }
  // Whether the next scan decides about a loss during the rare searches, or the camera was carried
  // during any: a part of its own begins.
  bool BeginsAgain() const {
    return (rare_ && (unjudged_ || unjudged_restart_)) || (unsettled() && unjudged_carried_);
  }
  int first_frame() const { return first_frame_; }
  // The parts of so many mapped frames that no search and no loop placed: the one after the last
  // loss, and earlier ones that were searched for until the next loss.
  std::vector<GuessedPart> GuessedParts(int mapped_frames) const;

  // Call after an adjustment with these loops: one that joins frames before and after the loss ends
  // the search (after two losses in a row, for all frames since the first).
  void Joined(const std::vector<PlanarLoop>& loops);

  // Call when all frames since first_frame() were moved to another guess.
  void GuessMoved();

  // Call after each frame mapped while unsettled: returns the correction (new map from map) of all
  // frames from first_frame() on, once found. The search ends then, or when the guess proves right
  // during the first searches.
  std::optional<Pose2> Find(const std::vector<MappedFrame>& frames,
                            const std::shared_ptr<const Scan>& newest, ReferenceMap& reference);
  // Whether this correction leaves the newest frame about where it is: the guess was right.
  bool IsGuess(const Pose2& correction, const std::vector<MappedFrame>& frames) const {
    return IsSame(correction, {}, frames.back().map_from_base);
  }
  // Call at the end while unsettled: searches once more, also with the scans of the last metre
  // alone. The correction as above, and the search ends then.
  std::optional<Pose2> FindAtLast(const std::vector<MappedFrame>& frames);

 private:
  bool IsJoinedAt(int frame) const;
  bool IsElsewhere(double duration_s, const Pose2& step) const;
  bool GuessIsRight(const std::vector<MappedFrame>& frames,
                    const std::shared_ptr<const Scan>& newest, ReferenceMap& reference);
  bool IsSame(const Pose2& a, const Pose2& b, const Pose2& map_from_base) const;
  bool IsDue(const std::vector<MappedFrame>& frames);
  void SetNext();
  bool IsAgreed() const;
  // With the scans within reach_m before frame `last`.
  std::optional<Pose2> Search(const std::vector<MappedFrame>& frames, int last,
                              double reach_m) const;
  static LoopSearchOptions ForGuess(LoopSearchOptions gates);
  std::optional<Pose2> ConfirmedAt(const PlaceMatcher& matcher,
                                   const std::vector<MappedFrame>& frames,
                                   const std::vector<int>& old, const std::vector<int>& members,
                                   int middle, const Pose2& map_from_middle) const;
  // The last frame after which `last` would be due for another search.
  std::optional<int> OneBefore(const std::vector<MappedFrame>& frames, int last) const;
  bool WholePartAgrees(const std::vector<MappedFrame>& frames, const Pose2& shift,
                       double least) const;

  RelocationOptions options_;
  OverlapOptions overlap_;
  PlaceMatcher matcher_;
  PlaceMatcher guess_matcher_;
  double usual_share_ = 0.0;
  int explained_frames_ = 0;       // frames in that mean, at most kUsualFrames
  double unjudged_s_ = 0.0;        // the longest loss since the last scan
  bool unjudged_ = false;          // whether that loss makes the guess doubtful
  bool unjudged_carried_ = false;  // whether the camera was carried, whatever the scan shows
  bool unjudged_restart_ = false;  // whether one since the last scan was followed by an epoch
  bool believes_ = false;          // whether SLAM's word after the loss is believed
  bool active_ = false;
  bool rare_ = false;
  int first_frame_ = 0;
  std::optional<Pose2> last_known_;  // in a finished map: the camera's pose before the loss
  std::vector<GuessedPart> left_;    // earlier parts whose place was not found
  std::vector<PlanarLoop> held_;     // loops of the last adjustment with loops
  double lost_s_ = 0.0;
  double way_m_ = 0.0;         // since first_frame_
  double way_before_m_ = 0.0;  // since last_known_ to there
  double next_m_ = 0.0;        // path length and turn of the next search
  double turn_rad_ = 0.0;
  double next_rad_ = 0.0;
  int searches_ = 0;
  double rarity_ = 1.0;        // interval of searches as a multiple of the first
  double recent_share_ = 0.0;  // running mean share of new scans on surfaces seen before the loss
  std::optional<Pose2> waiting_;  // result of the last search
  int agreed_ = 0;                // consecutive searches that found it
  double agreed_from_m_ = 0.0;    // path length at the first of them
};

}  // namespace depthgrid
