// Where is the camera, when SLAM was lost for seconds and comes back elsewhere? What was seen since
// is laid over all that was seen before (docs/math.md, "Wide search after a loss").
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/options.h"
#include "mapper/core/reference_map.h"
#include "mapper/graph/place_matcher.h"

namespace depthgrid {

struct RelocationOptions {
  bool use = true;
  // Odometry slips and SLAM errs by a few degrees within a frame. When the map suddenly explains
  // little of a scan, headings are tried up to this far from the prediction; 0: none.
  double slip_deg = 12.0;
  // Without a pose for less than this, the last motion or SLAM's own relocalisation is near enough
  // for matching.
  double min_lost_s = 2.0;
  // The same where SLAM's poses go on, in a new epoch or far beyond their usual motion, farther
  // away than anybody went meanwhile, as SLAM that begins anew has its origin where it likes: so
  // long the last motion is known.
  double min_lost_epoch_s = 0.5;
  // A guess is right when the map explains at least this share of what it usually did before the
  // loss.
  double min_share = 0.6;
  // The search reaches so far around the last pose, and farther by what may have been walked since;
  // every heading is tried.
  double window_m = 2.0;
  double speed_mps = 1.0;
  double max_window_m = 12.0;
  // A search every so often: the way or the turn brings something new into view.
  double every_m = 0.5;
  double every_deg = 30.0;
  int most_searches = 12;
  // What was seen since, as far back as this, is searched for together.
  PlaceOptions place = {.reach_m = 3.0, .turn_deg = 360.0, .max_scans = 24};
  double min_score = 0.8;          // of the search, 0..1
  double max_second_score = 0.85;  // share of it that a pose elsewhere may reach
  // Of what was seen before and since, the share that must agree: right places to 0.997 and
  // better, offices that are alike to 0.966, two rectangular rooms to 0.992 (docs/results.md, "Lost
  // and found").
  double min_agreement = 0.995;
  // So many searches in a row must find the same, to this.
  int consenting = 2;
  double consent_m = 0.2;
  double consent_deg = 2.0;

  void Visit(OptionsVisitor& v);
};

class Relocation {
 public:
  // `gates` are those of loops: how well two places must fit.
  Relocation(const RelocationOptions& options, const LoopSearchOptions& gates,
             const OverlapOptions& overlap)
      : options_(options), matcher_(gates, overlap) {}

  // A matched frame in ordinary times: what the map explains of it.
  void Explained(double share);
  // So long there was no pose before this frame's; where that may be of a SLAM that began anew, its
  // poses differ by this.
  void Lost(double duration_s, const std::optional<Pose2>& step);
  // Whether the guess since the last loss is to be doubted: the first scan after it, of which the
  // map explains this share, tells. Begins the search then; the next mapped frame is the first of
  // its part.
  bool Begins(double share, int next_frame);
  // Whether a match explains what a right place does.
  bool IsUsual(double share) const { return share >= options_.min_share * usual_share_; }
  double usual_share() const { return usual_share_; }
  bool active() const { return active_; }
  // Whether where the last loss led to is a guess still, sought or given up.
  bool unsettled() const { return active_ || gave_up_; }
  int first_frame() const { return first_frame_; }

  // After an adjustment with these loops: one that joins frames before and after the loss says
  // where the latter are (of two losses in a row, for all since the first).
  void Joined(const std::vector<PlanarLoop>& loops);

  // All since first_frame() was moved to another guess.
  void GuessMoved();

  // To be asked after each frame that was mapped while active: the motion (new map from map) of all
  // frames from first_frame() on, once that is known. Ends the search when it is, when the guess
  // turns out right, or when there is no hope left.
  std::optional<Pose2> Find(const std::vector<MappedFrame>& frames,
                            const std::shared_ptr<const Scan>& newest, ReferenceMap& reference);

 private:
  bool IsJoinedAt(int frame) const;
  bool IsElsewhere(double duration_s, const Pose2& step) const;
  bool GuessIsRight(const std::vector<MappedFrame>& frames,
                    const std::shared_ptr<const Scan>& newest, ReferenceMap& reference);
  bool IsSame(const Pose2& a, const Pose2& b, const Pose2& map_from_base) const;
  std::optional<Pose2> Search(const std::vector<MappedFrame>& frames) const;

  RelocationOptions options_;
  PlaceMatcher matcher_;
  double usual_share_ = 0.0;
  int explained_frames_ = 0;  // of which it is the mean, at most kUsualFrames
  double unjudged_s_ = 0.0;   // the longest loss since the last scan
  bool unjudged_ = false;     // such that a guess is to be doubted
  bool active_ = false;
  bool gave_up_ = false;
  int first_frame_ = 0;
  std::vector<PlanarLoop> held_;  // of the last adjustment with loops
  double lost_s_ = 0.0;
  double way_m_ = 0.0;   // since first_frame_
  double next_m_ = 0.0;  // when to search again: way, or turn
  double turn_rad_ = 0.0;
  double next_rad_ = 0.0;
  int searches_ = 0;
  double recent_share_ = 0.0;     // of the newest frames on what was seen before the loss
  std::optional<Pose2> waiting_;  // what the last search found
  int agreed_ = 0;                // searches in a row that found it
};

}  // namespace depthgrid
